#include "runners/evaluation/figures/parts/ball_gaps.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/trace/contact_measures.h"
#include "scenarios/simulated/depth_sensor.h"

namespace remote_touch {

std::vector<BallGap> ball_gaps(const Trace& trace, const Scenario& scenario, double contact_radius_m) {
  std::vector<BallGap> gaps(trace.length());
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.frame_index[i] < 0 || !pressing(trace, i, contact_radius_m)) continue;
    const double captured_s = scenario.captured_s(trace.frame_index[i]);
    gaps[i] = {trace.signed_distance_m[i] - contact_radius_m,
               scenario.signed_distance(trace.proxy_position_m[i], captured_s) - contact_radius_m};
  }
  return gaps;
}

double rms_gap_m(const std::vector<BallGap>& gaps, GapValue value) {
  double squares = 0, count = 0;
  for (const BallGap& gap : gaps)
    if (!std::isnan(gap.*value)) squares += gap.*value * (gap.*value), ++count;
  return count == 0 ? kNoValue : std::sqrt(squares / count);
}

double max_gap_m(const std::vector<BallGap>& gaps, GapValue value) {
  double max = kNoValue;
  for (const BallGap& gap : gaps) max = std::fmax(max, std::abs(gap.*value));  // ignores NaN
  return max;
}

MeshRun mesh_run(Experiment experiment, Trace trace, double contact_radius_m, const Kernels& kernels) {
  auto scenario = experiment.build_scenario(kernels);
  PointCloud cloud = scenario->cloud(0);
  std::vector<BallGap> gaps = ball_gaps(trace, *scenario, contact_radius_m);
  return {std::move(experiment), std::move(trace), std::move(scenario), std::move(cloud), std::move(gaps)};
}

std::vector<std::string> exact_sensor() {
  return {"scenario.noise_px=0", "scenario.disparity_step_px=0", "scenario.lateral_noise_px=0"};
}

DepthError depth_error(const Experiment& experiment, double z_m) {
  const auto number = [&](const char* name) {
    return experiment.value_at_start(std::string("scenario.") + name).get<double>();
  };
  DepthSensorSettings settings;
  settings.sensor = DepthSensorKind::structured_light;
  settings.camera.focal_px = number("focal_px");
  settings.baseline_m = number("baseline_m");
  settings.disparity_focal_px = number("disparity_focal_px");
  settings.noise_px = number("noise_px");
  settings.disparity_step_px = number("disparity_step_px");
  const Triangulation sensor = triangulation(settings);
  const double per_px = z_m * z_m / (sensor.focal_px * sensor.baseline_m);
  return {per_px * sensor.noise_px, 0.5 * per_px * sensor.step_px};
}

DepthError error_at_proxy(const MeshRun& run) {
  const RigidTransform X_CW = run.cloud.image->X_WC.inverse();
  double z_m = 0;
  for (std::size_t i = 0; i < run.trace.length(); ++i)
    if (!std::isnan(run.gaps[i].now_m)) z_m = std::max(z_m, (X_CW * run.trace.proxy_position_m[i]).z());
  return depth_error(run.experiment, z_m);
}

}  // namespace remote_touch
