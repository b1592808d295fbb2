#include "runners/evaluation/figures/studies/sensor_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "core/points/number_columns.h"
#include "runners/experiment/hand/image_surface.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOtherSurface_m = 0.05;
constexpr int kSilhouette_px = 3;

std::size_t index_of(const DepthImage& image, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
}

// Returns the cosine of the angle between the ray of a pixel and the normal of the plane of a window. The
// plane 1 / z = a u + b v + c has the normal (a fx, b fy, a cx + b cy + c), whose product with the ray
// ((u - cx) / fx, (v - cy) / fy, 1) is 1 / z.
double cosine_at(const FittedWindow& window, const CameraIntrinsics& camera, int u, int v) {
  const double middle = 0.5 * (window.width_px - 1);
  const double at_centre = window.inverse_per_m + window.across_per_m * (camera.cx - window.u - middle) +
                           window.down_per_m * (camera.cy - window.v - middle);
  const Vec3 normal(window.across_per_m * camera.fx, window.down_per_m * camera.fy, at_centre);
  const Vec3 ray = unproject(camera, u, v, 1);
  return std::abs(normal.dot(ray)) / std::sqrt(normal.squaredNorm() * ray.squaredNorm());
}

// The true depths, and the objects of the pixels; nothing measured.
ObjectImage true_objects(const RecordedTruth& truth, std::size_t frame, const CameraIntrinsics& camera) {
  std::vector<RasterMesh> meshes;
  std::vector<int> objects;
  for (std::size_t i = 0; i < truth.objects().size(); ++i) {
    const MeshObject& object = truth.objects()[i];
    const auto& X_CO = truth.poses(frame)[i];
    if (!X_CO) continue;
    meshes.push_back({object.shape->vertices(), object.shape->triangles(), *X_CO, object.is_closed});
    objects.push_back(static_cast<int>(i));
  }
  RasterImage raster = depth_raster(camera, meshes);
  for (int& shown : raster.mesh)
    if (shown >= 0) shown = objects[static_cast<std::size_t>(shown)];
  return {std::move(raster.depth), {}, std::move(raster.mesh)};
}

}  // namespace

DepthScene filled_scene(const DepthImage& recorded) {
  DepthScene scene{recorded};
  for (int v = 0; v < recorded.height; ++v) {
    double* z_m = &scene.depth.z_m[index_of(recorded, 0, v)];
    int last = -1;  // column of the last measured pixel
    for (int u = 0; u < recorded.width; ++u) {
      if (std::isnan(z_m[u])) continue;
      if (last >= 0) std::fill(z_m + last + 1, z_m + u, std::max(z_m[last], z_m[u]));
      last = u;
    }
  }
  return scene;
}

DepthScene planar_scene(std::span<const FittedWindow> windows, const CameraIntrinsics& camera) {
  DepthScene scene{{camera.width, camera.height, std::vector<double>(camera.pixels(), kNaN)},
                   std::vector<double>(camera.pixels(), 1)};
  for (const FittedWindow& window : windows)
    for (int v = window.v; v < window.v + window.width_px; ++v)
      for (int u = window.u; u < window.u + window.width_px; ++u) {
        scene.depth.z_m[index_of(scene.depth, u, v)] = window.depth_at(u, v);
        scene.cosine[index_of(scene.depth, u, v)] = cosine_at(window, camera, u, v);
      }
  return scene;
}

DepthSensorSettings sensor_settings(DepthSensorKind kind, const CameraIntrinsics& camera) {
  DepthSensorSettings settings;
  settings.camera.width = camera.width, settings.camera.height = camera.height;
  settings.camera.focal_px = camera.fx;
  settings.sensor = kind;
  return settings;
}

DepthSensorSettings with_own_focal_length(DepthSensorSettings settings, double own_focal_px) {
  const double factor = settings.camera.focal_px / own_focal_px;
  settings.disparity_focal_px = own_focal_px;
  settings.window_px =
      static_cast<int>(std::max(1.0, std::floor(triangulation(settings).window_px * factor + 0.5)));
  return settings;
}

std::vector<DepthImage> simulated_frames(const DepthSensorSettings& settings, const DepthScene& scene,
                                         int count, const Kernels& kernels) {
  const DepthSensor sensor(settings, NoiseKey{}, kernels);
  const auto view = sensor.view(scene.depth, scene.cosine, {});
  std::vector<DepthImage> frames;
  for (int frame = 0; frame < count; ++frame) frames.push_back(sensor.measured_depth(view, frame));
  return frames;
}

ObjectImage recorded_objects(const RecordedTruth& truth, std::size_t frame, const DepthImage& recorded,
                             const CameraIntrinsics& camera) {
  ObjectImage image = true_objects(truth, frame, camera);
  image.measured = recorded;
  return image;
}

ObjectImage simulated_objects(const RecordedTruth& truth, std::size_t frame,
                              const DepthSensorSettings& settings, const Kernels& kernels) {
  std::vector<SceneMesh> meshes;
  for (std::size_t i = 0; i < truth.objects().size(); ++i)
    if (const auto& X_CO = truth.poses(frame)[i]) meshes.push_back({truth.objects()[i], PosePath(*X_CO)});
  const NoiseKey key;
  const MeshCamera camera(settings, PosePath(RigidTransform::Identity()), key, kernels);
  const PointCloud cloud = camera.cloud(camera.view(meshes, 0), static_cast<int>(frame), 0);
  ObjectImage image = true_objects(truth, frame, cloud.image->camera);
  image.measured = {image.true_depth.width, image.true_depth.height, cloud.z};
  return image;
}

std::vector<double> depth_errors_of(const ObjectImage& image, int object) {
  const auto shows = [&](int u, int v) { return image.object[index_of(image.true_depth, u, v)] == object; };
  std::vector<double> errors_m;
  for (int v = kSilhouette_px; v < image.true_depth.height - kSilhouette_px; ++v)
    for (int u = kSilhouette_px; u < image.true_depth.width - kSilhouette_px; ++u) {
      bool is_inside = true;
      for (int d = -kSilhouette_px; d <= kSilhouette_px && is_inside; ++d)
        is_inside = shows(u + d, v) && shows(u, v + d);
      const std::size_t i = index_of(image.true_depth, u, v);
      const double error_m = image.measured.z_m[i] - image.true_depth.z_m[i];
      if (is_inside && std::abs(error_m) < kOtherSurface_m) errors_m.push_back(error_m);
    }
  return errors_m;
}

namespace {

constexpr double kMinJump_per_m = 0.1;
constexpr int kWindow_px = 20;

// frames_with_planes: the frames in which planes are fitted.
SourceStatistics source_statistics(std::vector<DepthImage> frames, bool is_at_rest,
                                   const std::vector<DepthImage>& frames_with_planes) {
  SourceStatistics statistics;
  if (is_at_rest) statistics.over_time = temporal_noise(frames);
  for (const DepthImage& frame : frames_with_planes)
    for (const FittedWindow& window : fitted_windows(frame, kWindow_px))
      statistics.about_planes.push_back(window.noise);
  for (const DepthImage& frame : frames)
    for (const DepthEdge& edge : depth_edges(frame, kMinJump_per_m)) statistics.edges.push_back(edge);
  statistics.frames = std::move(frames);
  return statistics;
}

SourceStatistics simulated_statistics(const ComparedSensor& sensor, const DepthSensorSettings& settings,
                                      const std::vector<DepthImage>& recorded, const CameraIntrinsics& camera,
                                      const Kernels& kernels) {
  // Lateral noise moves edges, and the edges between the planes are none of the recorded scene.
  DepthSensorSettings of_planes = settings;
  of_planes.lateral_noise_px = 0;
  std::vector<DepthImage> frames, frames_with_planes;
  for (const DepthImage& frame : recorded) {
    const DepthScene planes = planar_scene(fitted_windows(frame, kWindow_px), camera);
    frames_with_planes.push_back(simulated_frames(of_planes, planes, 1, kernels)[0]);
    if (!sensor.is_at_rest) frames.push_back(simulated_frames(settings, filled_scene(frame), 1, kernels)[0]);
  }
  if (sensor.is_at_rest)
    frames =
        simulated_frames(settings, filled_scene(recorded[0]), static_cast<int>(recorded.size()), kernels);
  return source_statistics(std::move(frames), sensor.is_at_rest, frames_with_planes);
}

std::vector<ObjectErrors> object_errors(const ObjectImage& image, std::size_t objects) {
  std::vector<ObjectErrors> errors(objects);
  for (std::size_t k = 0; k < objects; ++k) {
    const int object = static_cast<int>(k);
    std::vector<double> errors_m = depth_errors_of(image, object);
    if (errors_m.empty()) continue;
    errors[k].spread_m = std::sqrt(moments_of(errors_m).variance);
    errors[k].median_m = median_in_place(errors_m);
    errors[k].measured = mean_where(
        image.object.size(), [&](std::size_t i) { return image.object[i] == object; },
        [&](std::size_t i) { return std::isnan(image.measured.z_m[i]) ? 0.0 : 1.0; });
  }
  return errors;
}

}  // namespace

SensorComparison compare_sensor(const Scenario& scene, const ComparedSensor& sensor, const Kernels& kernels) {
  const FrameImage first = first_image(scene, sensor.recording);
  const CameraIntrinsics& camera = first.layout.camera;
  std::vector<DepthImage> recorded{first.depth};
  for (int frame = 1; frame < sensor.frames; ++frame)
    recorded.push_back(image_of(scene, frame, first.layout, sensor.recording).depth);

  const DepthSensorSettings settings = sensor_settings(sensor.kind, camera);
  const Triangulation published = triangulation(settings);
  const double step_per_m = depth_step_per_m(recorded, sensor.step_near_m, sensor.step_far_m);
  SensorComparison comparison;
  comparison.focal_px = camera.fx, comparison.baseline_m = published.baseline_m;
  comparison.own_focal_px = published.step_px / (step_per_m * published.baseline_m);
  comparison.recorded = source_statistics(recorded, sensor.is_at_rest, recorded);
  comparison.simulated = simulated_statistics(sensor, settings, recorded, camera, kernels);
  comparison.own_focal = simulated_statistics(
      sensor, with_own_focal_length(settings, comparison.own_focal_px), recorded, camera, kernels);
  return comparison;
}

TrueObjectErrors true_object_errors(const Scenario& scene, const ComparedSensor& sensor, int frame_step,
                                    const Kernels& kernels) {
  const auto* recorded = dynamic_cast<const RecordedScene*>(&scene);
  if (recorded == nullptr || recorded->truth() == nullptr)
    throw InputError(sensor.recording, "has no true objects: expected the folder truth/");
  const RecordedTruth& truth = *recorded->truth();
  const FrameImage first = first_image(scene, sensor.recording);
  const CameraIntrinsics& camera = first.layout.camera;
  const DepthSensorSettings settings = sensor_settings(sensor.kind, camera);
  TrueObjectErrors errors;
  for (const MeshObject& object : truth.objects()) errors.objects.push_back(object.name);
  for (int frame = 0; frame < scene.frame_count(); frame += frame_step) {
    const std::size_t source = recorded->source_at(scene.captured_s(frame));
    const DepthImage depth = image_of(scene, frame, first.layout, sensor.recording).depth;
    errors.frames.push_back(
        {frame, object_errors(recorded_objects(truth, source, depth, camera), errors.objects.size()),
         object_errors(simulated_objects(truth, source, settings, kernels), errors.objects.size())});
  }
  return errors;
}

namespace {

constexpr double kFlatShare = 0.25;
constexpr double kFirstJump_per_m = 0.2, kJumpBin_per_m = 0.1;
constexpr int kShown_px = 40;
constexpr std::size_t kFewestWidths = 4;

}  // namespace

double MeasuredSensor::over_time_m(const SensorSource& source, std::size_t range, double share) const {
  return noise_quantile((comparison.*source.statistics).over_time, shown.bounds_m[range],
                        shown.bounds_m[range + 1], share)
      .in_m();
}

DepthNoise MeasuredSensor::about_planes(const SensorSource& source, std::size_t range) const {
  return noise_quantile((comparison.*source.statistics).about_planes, shown.bounds_m[range],
                        shown.bounds_m[range + 1], kFlatShare);
}

std::vector<DepthEdge> MeasuredSensor::shown_edges(const SensorSource& source, bool is_left_of_near) const {
  return edges_between((comparison.*source.statistics).edges, is_left_of_near, shown.edge_low_per_m,
                       shown.edge_high_per_m);
}

std::string side_name(bool is_left_of_near) {
  return is_left_of_near ? "left" : "right";
}

Table noise_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("noise"), sensor.shown.title + ": noise and steps over distance"};
  const auto add = [&](const std::string& name, const std::string& units, const std::string& long_name,
                       auto&& value) {
    std::vector<double> values;
    for (std::size_t range = 0; range < sensor.ranges(); ++range) values.push_back(value(range));
    table.add(name, units, long_name, std::move(values));
  };
  const std::vector<double>& bounds_m = sensor.shown.bounds_m;
  add("depth", "m", "middle of the range of depth",
      [&](std::size_t range) { return 0.5 * (bounds_m[range] + bounds_m[range + 1]); });
  const double px_m = sensor.comparison.focal_px * sensor.comparison.baseline_m;
  for (const SensorSource* source : kSensorSources) {
    const std::string column = source->column, of = std::string(", ") + source->label;
    const bool is_at_rest = sensor.shown.compared.is_at_rest;
    if (is_at_rest)
      add("time_" + column, "m", "median standard deviation of a pixel's depth over time" + of,
          [&](std::size_t range) { return sensor.over_time_m(*source, range); });
    if (is_at_rest)
      add("loud_" + column, "m", "standard deviation that 90 % of the pixels do not exceed" + of,
          [&](std::size_t range) { return sensor.over_time_m(*source, range, kLoudShare); });
    add("planes_" + column, "m", "rms of depth about the plane of a window, lower quartile" + of,
        [&](std::size_t range) { return sensor.about_planes_m(*source, range); });
    add("planes_px_" + column, "px", "rms of disparity about the plane of a window, lower quartile" + of,
        [&](std::size_t range) { return sensor.about_planes(*source, range).per_m * px_m; });
    add("step_" + column, "m", "step of depth" + of, [&](std::size_t range) {
      const double middle_m = 0.5 * (bounds_m[range] + bounds_m[range + 1]);
      return depth_step_per_m((sensor.comparison.*source->statistics).frames, bounds_m[range],
                              bounds_m[range + 1]) *
             middle_m * middle_m;
    });
  }
  return table;
}

// Returns the medians of the widths of holes, over jumps.
Table width_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("widths"), sensor.shown.title + ": width of the holes at depth edges"};
  std::vector<double> lows, jumps;
  for (double low = kFirstJump_per_m; low < sensor.shown.last_jump_per_m - 1e-9; low += kJumpBin_per_m)
    lows.push_back(low), jumps.push_back(low + 0.5 * kJumpBin_per_m);
  table.add("jump", "1/m", "jump of inverse depth at the edge", jumps);
  for (const bool is_left : kEdgeSides)
    for (const SensorSource* source : kSensorSources) {
      std::vector<double> widths;
      for (const double low : lows)
        widths.push_back(median_hole_px(edges_between((sensor.comparison.*source->statistics).edges, is_left,
                                                      low, low + kJumpBin_per_m)));
      table.add(side_name(is_left) + "_" + source->column, "px",
                "median width of holes, " + side_name(is_left) + " of near surfaces, " + source->label,
                widths);
    }
  return table;
}

// Returns how much the holes widen with the jump, as the length of a baseline. NaN if too few widths are
// known.
double shadow_baseline_m(const Table& widths, const std::string& column, double focal_px) {
  std::vector<double> x, y;
  const std::vector<double>&jumps = numbers(widths, "jump"), &widths_px = numbers(widths, column);
  for (std::size_t i = 0; i < jumps.size(); ++i)
    if (!std::isnan(widths_px[i])) x.push_back(jumps[i]), y.push_back(widths_px[i]);
  return x.size() < kFewestWidths ? kNoValue : fit_polynomial(x, y, {0, 1}).coefficients[1] / focal_px;
}

Table hole_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("holes"),
              sensor.shown.title + ": holes beside edges with a jump of 0.4 to 0.7 per m"};
  std::vector<double> distances;
  for (int distance = 1; distance <= kShown_px; ++distance) distances.push_back(distance);
  table.add("distance", "px", "distance from the last pixel of the nearer surface", distances);
  for (const bool is_left : kEdgeSides)
    for (const SensorSource* source : kSensorSources) {
      const std::vector<DepthEdge> edges = sensor.shown_edges(*source, is_left);
      std::vector<double> fractions;
      for (int distance = 1; distance <= kShown_px; ++distance)
        fractions.push_back(hole_fraction(edges, distance));
      table.add(side_name(is_left) + "_" + source->column, "1",
                "fraction of holes, " + side_name(is_left) + " of near surfaces, " + source->label,
                fractions);
    }
  return table;
}

Table truth_table(const TrueObjectErrors& errors) {
  Table table{"truth", "Active stereo: depth minus the depth of true objects"};
  const auto add = [&](const std::string& name, const std::string& units, const std::string& long_name,
                       auto&& value) {
    std::vector<double> values;
    for (const FrameErrors& frame : errors.frames) values.push_back(value(frame));
    table.add(name, units, long_name, std::move(values));
  };
  add("frame", "1", "frame of the recording", [](const FrameErrors& frame) { return frame.frame; });
  for (std::size_t k = 0; k < errors.objects.size(); ++k)
    for (const auto& side :
         {std::pair("recorded", &FrameErrors::recorded), std::pair("simulated", &FrameErrors::simulated)}) {
      const std::string source = side.first;
      const auto of = side.second;
      const std::string column = errors.objects[k] + "_" + source, words = errors.objects[k] + ", " + source;
      add("median_" + column, "m", "median error of depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].median_m; });
      add("spread_" + column, "m", "standard deviation of the error of depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].spread_m; });
      add("measured_" + column, "1", "share of the pixels with a depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].measured; });
    }
  return table;
}

}  // namespace remote_touch
