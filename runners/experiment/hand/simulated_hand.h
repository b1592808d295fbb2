// The hand that moves the device of a run: a script alone, or a simulated operator who follows it and feels
// the device's motors.
#pragma once

#include <optional>

#include "analysis/trace/hand_state.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/device_motors.h"
#include "runners/experiment/hand/operator_model.h"

namespace remote_touch {

class SimulatedHand {
 public:
  // If there is no operator, the device follows the script exactly. If there are no motor settings, it exerts
  // the whole command.
  SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                const std::optional<MotorSettings>& motors, double tick_s);

  // True if there is no operator: the device is then always where the script intends it to be.
  bool follows_script() const { return !operator_model_; }
  DeviceState move(const DeviceState& intended, double time_s);
  // Computes the wrench that the device exerts for the renderer's output. It moves the hand in the next tick.
  void apply(const DeviceState& device, const RenderOutput& out);
  // Returns the state after the last tick; none if there are neither operator nor motor settings.
  std::optional<HandState> state() const;

 private:
  std::optional<OperatorModel> operator_model_;
  const bool has_motors_;
  const MotorSettings motors_;
  ToolPose intended_;
  Wrench device_wrench_;
};

}  // namespace remote_touch
