// The slave of a live session: what it touches, why it may touch nothing, and which frames it sends.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/teleoperation/teleoperation.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// The slave is simulated, also behind a real hand. It touches the true surface of a simulated scene
// (Experiment::build_simulated_scene()). It has a scene of its own, because the haptic loop must not wait for
// the thread of the camera. With any other camera it moves but touches nothing.
//
// The mass of the hand is not known, whatever the section operator says, because a replay of the session has
// no operator. Passivity control then uses the published rule.
//
// The dead-band of frames needs memory and time, so the thread of the camera decides which frames are sent.
// The haptic loop passes it the positions of the slave. A recording stores which frames the renderer
// received, so a replay needs no decision.
class LiveSlave {
 public:
  // depth: the address of the sensor; kSimulatedDepth: the scenario is the camera.
  LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels);
  LiveSlave(const LiveSlave&) = delete;
  LiveSlave& operator=(const LiveSlave&) = delete;

  // Returns null if there is no slave. Only the haptic loop may use the result while the run lasts.
  Teleoperation* remote() { return remote_ ? &*remote_ : nullptr; }

  // Returns a line that says why the slave cannot touch anything; empty if it can, or if there is no slave.
  const std::string& why_untouching() const { return why_; }

  // The queue for the position of the slave at every tick. Only the haptic loop may write to it. Null if
  // every frame is sent.
  Ring<SlavePlace>* places() { return places_ ? &*places_ : nullptr; }
  // Returns true if a frame that was captured has to be sent to the renderer. Only the thread of the camera
  // may call it. If no frame came for kMostPlaces ticks, the next one is sent.
  bool sends(const Frame& frame);
  static constexpr std::size_t kMostPlaces = 1 << 12;  // 4 s at 1 kHz

 private:
  const std::unique_ptr<const Scenario> touched_;
  std::optional<Teleoperation> remote_;
  FrameSender sender_;
  std::optional<Ring<SlavePlace>> places_;
  std::string why_;
};

}  // namespace remote_touch
