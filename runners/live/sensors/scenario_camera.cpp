#include "runners/live/sensors/scenario_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Rounded to floats: a replay reads the same.
void write_points(const PointCloud& cloud, SensorFrame& frame) {
  frame.points.clear();
  const auto add = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) frame.points.push_back(static_cast<float>(v[k]));
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    add(cloud.point(i));
    if (cloud.has_normals()) add(cloud.normal(i));
  }
}

}  // namespace

ScenarioCamera::ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock)
    : scenario_(std::move(scenario)), clock_(clock) {
  const PointCloud first = scenario_->cloud(0);
  view_.metres_per_unit = kUnit_m;
  view_.frame_rate_hz = scenario_->frame_rate_hz();
  view_.has_colour = !first.colour.empty();
  if (first.image)
    view_.camera = first.image->camera, view_.X_WC = first.image->X_WC;
  else
    view_.cloud = {first.has_normals(), first.grid_columns, first.size()};
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
  if (view_.cloud)
    write_points(cloud, frame);
  else
    write_depth(cloud, cloud.image->X_WC.inverse(), frame);
  frame.colour = cloud.colour;
  frame.number = next_++;
  frame.captured_s = start_s_ + captured_s;
  return SensorState::frame;
}

}  // namespace remote_touch
