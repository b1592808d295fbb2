#include "runners/live/loop/live_slave.h"

#include <algorithm>
#include <cmath>

#include "runners/experiment/sessions/session_file.h"

namespace remote_touch {

namespace {

// Returns true if the true surface is known at a point that the camera sees in its first frame, or if it sees
// none there. Tries about a hundred points.
bool knows_surface(const Scenario& scenario) {
  const PointCloud cloud = scenario.cloud(0);
  const std::size_t every = std::max<std::size_t>(1, cloud.size() / 100);
  bool sees_a_point = false;
  for (std::size_t i = 0; i < cloud.size(); i += every) {
    if (!cloud.is_measured(i)) continue;
    sees_a_point = true;
    if (!std::isnan(scenario.signed_distance(cloud.point(i), scenario.captured_s(0)))) return true;
  }
  return !sees_a_point;
}

}  // namespace

LiveSlave::LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels)
    : touched_(depth == kSimulatedDepth ? experiment.build_simulated_scene(kernels) : nullptr),
      remote_(experiment.build_teleoperation(touched_.get(), Experiment::Hand::real)),
      sender_(experiment.frame_dead_band(), kernels) {
  if (remote_ && experiment.frame_dead_band().least_motion_m > 0) places_.emplace(kMostPlaces);
  if (!remote_ || (touched_ && knows_surface(*touched_))) return;
  const std::string source =
      depth == kSimulatedDepth ? "this scenario, played in real time," : "the camera " + depth;
  why_ = "slave without surface: " + source +
         " has no true surface, so the slave moves but cannot touch anything";
}

// A full queue has lost the positions after those in it.
bool LiveSlave::sends(const Frame& frame) {
  if (!places_) return true;
  std::size_t count = 0;
  for (; const SlavePlace* const place = places_->oldest(); places_->pop(), ++count)
    sender_.observe_slave(place->position_W, place->time_s);
  if (count >= kMostPlaces) sender_.lose_slave();
  return sender_.sends(frame);
}

}  // namespace remote_touch
