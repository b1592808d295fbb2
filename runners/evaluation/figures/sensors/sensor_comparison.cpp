#include "runners/evaluation/figures/sensors/sensor_comparison.h"

#include <cmath>
#include <utility>

#include "analysis/statistics/means_and_extremes.h"
#include "core/numeric/order_statistic.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/hand/image_frames.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

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

}  // namespace remote_touch
