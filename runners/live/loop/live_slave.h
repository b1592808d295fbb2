// The slave of a live session: what it touches, and why it may touch nothing.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/teleoperation/teleoperation.h"

namespace remote_touch {

// The slave is simulated, also behind a real hand. It touches the true surface of a simulated scene
// (Experiment::build_simulated_scene()). It has a scene of its own, because the haptic loop must not wait for
// the thread of the camera. With any other camera it moves but touches nothing.
//
// The mass of the hand is not known, whatever the section operator says, because a replay of the session has
// no operator. Passivity control then uses the published rule.
class LiveSlave {
 public:
  // depth: the address of the sensor; kSimulatedDepth: the scenario is the camera. Throws InputError if the
  // experiment has a dead-band of frames, because the loop uses every frame.
  LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels);
  LiveSlave(const LiveSlave&) = delete;
  LiveSlave& operator=(const LiveSlave&) = delete;

  // Returns null if there is no slave. Only the haptic loop may use the result while the run lasts.
  Teleoperation* remote() { return remote_ ? &*remote_ : nullptr; }

  // Returns a line that says why the slave cannot touch anything; empty if it can, or if there is no slave.
  const std::string& why_untouching() const { return why_; }

 private:
  const std::unique_ptr<const Scenario> touched_;
  std::optional<Teleoperation> remote_;
  std::string why_;
};

}  // namespace remote_touch
