#include "runners/live/loop/live_slave.h"

#include <algorithm>
#include <cmath>

#include "core/parameters/input_error.h"
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
      remote_(experiment.build_teleoperation(touched_.get(), Experiment::Hand::real)) {
  if (const double least_m = experiment.frame_dead_band().least_motion_m; least_m > 0)
    throw InputError("frame_link.least_motion_m = " + std::to_string(least_m),
                     "expected 0 in a live session, which uses every frame");
  if (!remote_ || (touched_ && knows_surface(*touched_))) return;
  const std::string source =
      depth == kSimulatedDepth ? "this scenario, played in real time," : "the camera " + depth;
  why_ = "slave without surface: " + source +
         " has no true surface, so the slave moves but cannot touch anything";
}

}  // namespace remote_touch
