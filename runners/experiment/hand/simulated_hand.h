// The hand that moves the device of a run: a script alone, or a simulated operator who follows it and feels
// the device's motors.
#pragma once

#include <optional>

#include "analysis/trace/hand_and_slave_state.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/device_model.h"
#include "runners/experiment/hand/operator_model.h"

namespace remote_touch {

class SimulatedHand {
 public:
  // If there is no operator, the hand follows the script exactly. If there are no device settings, the device
  // measures the hand's pose exactly and exerts the whole command at once.
  SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                const std::optional<DeviceSettings>& device, double tick_s);

  // True if there is no operator and the device measures exactly: the measured pose is then always the
  // intended one.
  bool follows_script() const { return !operator_model_ && !rounds_; }
  // Moves the hand to the time of the next tick. Returns the pose that the device measures.
  DeviceState move(const DeviceState& intended, double time_s);
  // Computes the wrench that the device exerts for a command. It moves the hand in the next tick.
  void apply(const Wrench& command);
  // Returns the state after the last tick; none if there are neither operator nor device settings.
  std::optional<HandState> state() const;

 private:
  std::optional<OperatorModel> operator_model_;
  const bool has_device_, rounds_;
  DeviceModel device_;
  ToolPose intended_, hand_;
  Wrench device_wrench_;
};

}  // namespace remote_touch
