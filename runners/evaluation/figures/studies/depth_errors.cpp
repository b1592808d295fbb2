#include "runners/evaluation/figures/studies/depth_errors.h"

#include <algorithm>
#include <cmath>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/points/number_columns.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/studies/true_contacts.h"
#include "runners/experiment/hand/image_surface.h"

namespace remote_touch {

namespace {

constexpr const char* kSubject = "the truth of a recording";
constexpr double kFarthestDepth_m = 0.03;

// A point of a setting, with its distances to both surfaces.
struct ComparedPoint {
  double measured_m = kNoValue, true_m = kNoValue, normal_deg = kNoValue;
  bool is_known() const { return !std::isnan(measured_m) && !std::isnan(true_m); }
};

// The pixels of one object with one setting.
struct SettingSamples {
  std::vector<double> measured_m, true_m, normal_deg;
  void add(const ComparedPoint& point) {
    measured_m.push_back(point.measured_m), true_m.push_back(point.true_m);
    if (!std::isnan(point.normal_deg)) normal_deg.push_back(point.normal_deg);
  }
};

// A frame as the camera has measured it, and as it should have.
struct JudgedFrame {
  double time_s;
  std::size_t source;
  FrameImage measured;
  RasterImage exact;
};

// A pixel that shows a listed object.
struct ShownPixel {
  int row = 0, column = 0;
  std::size_t object = 0;  // its index in the list
  Vec3 normal_C;           // the true one
};

// cloud: the result of a setting; pixel: its index in the cloud.
ComparedPoint compared(const RecordedScene& scene, const JudgedFrame& frame, const PointCloud& cloud,
                       std::size_t pixel, const Vec3& true_normal_C) {
  const RigidTransform X_CW = frame.measured.layout.X_WC.inverse();
  const Vec3 p_W = cloud.point(pixel);
  if (!p_W.allFinite()) return {};
  ComparedPoint point{*scene.measured_distance(p_W, frame.time_s),
                      scene.truth()->at(frame.source, X_CW * p_W).distance_m, kNoValue};
  const Vec3 normal_C = X_CW.linear() * cloud.normal(pixel);
  if (normal_C.allFinite()) point.normal_deg = angle_between(normal_C, true_normal_C) / kRadiansPerDegree;
  return point;
}

DepthErrors errors_of(SettingSamples& samples) {
  DepthErrors errors;
  errors.pixels = static_cast<double>(samples.true_m.size());
  if (!samples.normal_deg.empty()) errors.normal_deg = median_in_place(samples.normal_deg);
  if (samples.true_m.empty()) return errors;
  const auto rms = [&](const std::vector<double>& values) {
    double squares = 0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / errors.pixels);
  };
  errors.to_measured_m = rms(samples.measured_m), errors.to_true_m = rms(samples.true_m);
  double sum = 0;
  for (double& distance_m : samples.true_m) sum += distance_m, distance_m = std::abs(distance_m);
  errors.true_mean_m = sum / errors.pixels;
  errors.to_true_90_m = quantile_in_place(samples.true_m, 0.9);
  return errors;
}

std::vector<ShownPixel> shown_pixels(const RecordedTruth& truth, const JudgedFrame& frame,
                                     const std::vector<std::size_t>& objects, int step) {
  const DepthImage& depth = frame.measured.depth;
  std::vector<ShownPixel> shown;
  for (int row = 0; row < depth.height; row += step)
    for (int column = 0; column < depth.width; column += step) {
      const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(depth.width) +
                         static_cast<std::size_t>(column);
      const int object = frame.exact.mesh[pixel];
      if (object < 0 || !(std::abs(depth.z_m[pixel] - frame.exact.depth.z_m[pixel]) <= kFarthestDepth_m))
        continue;
      const auto found = std::find(objects.begin(), objects.end(), static_cast<std::size_t>(object));
      if (found != objects.end())
        shown.push_back({row, column, static_cast<std::size_t>(found - objects.begin()),
                         true_normal_C(truth, frame.source, frame.exact, pixel)});
    }
  return shown;
}

PixelRectangle rectangle_of(const std::vector<ShownPixel>& shown) {
  int left = shown[0].column, right = left, top = shown[0].row, bottom = top;
  for (const ShownPixel& at : shown) {
    left = std::min(left, at.column), right = std::max(right, at.column);
    top = std::min(top, at.row), bottom = std::max(bottom, at.row);
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

// Adds the samples of a frame. Only the rectangle around the pixels is processed.
void add_frame(const RecordedScene& scene, const JudgedFrame& frame, const std::vector<ShownPixel>& shown,
               std::vector<DepthPipeline>& pipelines, std::vector<std::vector<SettingSamples>>& samples) {
  if (shown.empty()) return;
  const PixelRectangle rectangle = rectangle_of(shown);
  const FrameImage& image = frame.measured;
  std::vector<std::vector<ComparedPoint>> points(pipelines.size());
  PointCloud cloud;
  for (std::size_t setting = 0; setting < pipelines.size(); ++setting) {
    pipelines[setting].process(image.depth, image.layout.camera, image.layout.X_WC, rectangle, cloud);
    for (const ShownPixel& at : shown) {
      const int pixel = (at.row - rectangle.top) * rectangle.width + at.column - rectangle.left;
      points[setting].push_back(compared(scene, frame, cloud, static_cast<std::size_t>(pixel), at.normal_C));
    }
  }
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto is_known = [i](const std::vector<ComparedPoint>& of) { return of[i].is_known(); };
    if (!std::all_of(points.begin(), points.end(), is_known)) continue;
    for (std::size_t setting = 0; setting < points.size(); ++setting)
      samples[shown[i].object][setting].add(points[setting][i]);
  }
}

}  // namespace

std::vector<std::vector<DepthErrors>> depth_errors(const RecordedScene& scene,
                                                   const std::vector<std::size_t>& objects,
                                                   const std::vector<DepthPipelineSettings>& settings,
                                                   const DepthSample& sample, const Kernels& kernels) {
  std::vector<std::vector<SettingSamples>> samples(objects.size(),
                                                   std::vector<SettingSamples>(settings.size()));
  std::vector<DepthPipeline> pipelines;
  pipelines.reserve(settings.size());
  for (const DepthPipelineSettings& setting : settings) pipelines.emplace_back(setting, kernels);
  const ImageLayout first = first_image(scene, kSubject).layout;
  for (int frame = 0; frame < sample.frames; frame += sample.frame_step) {
    const double time_s = scene.captured_s(frame);
    const std::size_t source = scene.source_at(time_s);
    const JudgedFrame judged{time_s, source, image_of(scene, frame, first, kSubject),
                             true_image(*scene.truth(), source, first.camera)};
    add_frame(scene, judged, shown_pixels(*scene.truth(), judged, objects, sample.pixel_step), pipelines,
              samples);
  }
  std::vector<std::vector<DepthErrors>> errors(objects.size());
  for (std::size_t object = 0; object < objects.size(); ++object)
    for (SettingSamples& of_setting : samples[object]) errors[object].push_back(errors_of(of_setting));
  return errors;
}

}  // namespace remote_touch
