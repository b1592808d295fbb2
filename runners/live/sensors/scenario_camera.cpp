#include "runners/live/sensors/scenario_camera.h"

#include <algorithm>
#include <utility>

namespace remote_touch {

namespace {

// Returns the first frame with points, because an empty frame does not show the layout of the later ones. If
// none of the first 100 has points, returns the first frame.
PointCloud first_with_points(const Scenario& scenario) {
  constexpr int kFrames = 100;
  const PointCloud first = scenario.cloud(0);
  if (first.size() > 0) return first;
  for (int i = 1; i < std::min(scenario.frame_count(), kFrames); ++i)
    if (PointCloud cloud = scenario.cloud(i); cloud.size() > 0) return cloud;
  return first;
}

}  // namespace

ScenarioCamera::ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock,
                               const FrameEncoder::Settings& settings)
    : scenario_(std::move(scenario)), encoder_(settings, first_with_points(*scenario_)), clock_(clock) {
  encoder_.view().frame_rate_hz = scenario_->frame_rate_hz();
}

SensorState ScenarioCamera::next(SensorFrame& frame, double timeout_s) {
  const double moment_s = clock_.now_s();
  if (start_s_ < 0) start_s_ = moment_s;
  const double rate_hz = scenario_->frame_rate_hz();
  const double now_s = moment_s - start_s_;
  const int last = scenario_->frame_count() - 1;
  // The last frame is repeated after the end of the scene.
  const auto due_s = [&](int i) {
    return scenario_->captured_s(std::min(i, last)) + std::max(0, i - last) / rate_hz;
  };
  while (due_s(next_ + 1) <= now_s) ++next_;  // if several are due, delivers the newest
  const double captured_s = due_s(next_);
  const double wait_s = captured_s - now_s;
  if (wait_s > 0) clock_.sleep_s(std::min(wait_s, timeout_s));
  if (wait_s > timeout_s) return SensorState::waiting;
  const int shown = std::min(next_, last);
  encoder_.encode(scenario_->cloud(shown), shown, frame);
  frame.number = next_++;
  frame.captured_s = start_s_ + captured_s;
  return SensorState::frame;
}

}  // namespace remote_touch
