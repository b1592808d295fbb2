#include "runners/live/sensors/scenario_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

void write_depth(const PointCloud& cloud, const RigidTransform& X_CW, SensorFrame& frame) {
  frame.depth.assign(cloud.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const double units = std::round((X_CW * cloud.point(i)).z() / ScenarioCamera::kUnit_m);
    if (units >= 1 && units <= std::numeric_limits<std::uint16_t>::max())
      frame.depth[i] = static_cast<std::uint16_t>(units);
  }
}

}  // namespace

ScenarioCamera::ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock)
    : scenario_(std::move(scenario)), clock_(clock) {
  const PointCloud first = scenario_->cloud(0);
  if (!first.image)
    throw InputError("--depth sim:",
                     "this scenario's frames are no depth images: expected one of a camera, "
                     "such as valve-tank or recorded");
  view_ = {first.image->camera, kUnit_m, scenario_->frame_rate_hz(), !first.colour.empty(),
           first.image->X_WC};
}

SensorState ScenarioCamera::next(SensorFrame& frame, double timeout_s) {
  const double moment_s = clock_.now_s();
  if (start_s_ < 0) start_s_ = moment_s;
  const double rate_hz = scenario_->frame_rate_hz();
  const double now_s = moment_s - start_s_;
  const int last = scenario_->frame_count() - 1;
  // Beyond the last frame the scene stays as it is.
  const auto due_s = [&](int i) {
    return scenario_->captured_s(std::min(i, last)) + std::max(0, i - last) / rate_hz;
  };
  while (due_s(next_ + 1) <= now_s) ++next_;  // of several that are due the newest
  const double captured_s = due_s(next_);
  const double wait_s = captured_s - now_s;
  if (wait_s > 0) clock_.sleep_s(std::min(wait_s, timeout_s));
  if (wait_s > timeout_s) return SensorState::waiting;
  const PointCloud cloud = scenario_->cloud(std::min(next_, last));
  write_depth(cloud, cloud.image->X_WC.inverse(), frame);
  frame.colour = cloud.colour;
  frame.number = next_++;
  frame.captured_s = start_s_ + captured_s;
  return SensorState::frame;
}

}  // namespace remote_touch
