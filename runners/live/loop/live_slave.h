// The slave of a live session: what it touches, and why it may touch nothing.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/teleoperation/teleoperation.h"

namespace remote_touch {

// The slave is simulated, also behind a real hand. It touches the true surface of a simulated scene
// (Experiment::build_simulated_scene()), which it has for itself, because the haptic loop may not wait for
// the thread of the camera. With any other camera it moves but touches nothing.
//
// The mass of the hand is not known, whatever the section operator says, because a replay of the session has
// no operator. Passivity control then uses the published rule.
class LiveSlave {
 public:
  // depth: the address of the sensor. Throws InputError for a dead-band of frames: the loop uses each frame.
  LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels);
  LiveSlave(const LiveSlave&) = delete;
  LiveSlave& operator=(const LiveSlave&) = delete;

  // Returns null without a slave. Only the haptic loop may use it while the run lasts.
  Teleoperation* remote() { return remote_ ? &*remote_ : nullptr; }

  // Returns a line which says why the slave cannot touch anything; empty if it can, or if there is no slave.
  const std::string& why_untouching() const { return why_; }

 private:
  const std::unique_ptr<const Scenario> touched_;
  std::optional<Teleoperation> remote_;
  std::string why_;
};

}  // namespace remote_touch
