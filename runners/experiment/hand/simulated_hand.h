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

  DeviceState move(const DeviceState& intended, double time_s);
  // Takes the renderer's output; the wrench that the device exerts for it moves the hand in the next tick.
  void apply(const DeviceState& device, const RenderOutput& out);
  // State after the last tick; none without operator and motor settings.
  std::optional<HandState> state() const;

 private:
  std::optional<OperatorModel> operator_model_;
  const bool has_motors_;
  const MotorSettings motors_;
  ToolPose intended_;
  Wrench device_wrench_;
};

}  // namespace remote_touch
