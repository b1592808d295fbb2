// What moves the device of a run: a script alone, or an operator who follows it and feels the device's
// motors.
#pragma once

#include <optional>

#include "analysis/trace/trace.h"
#include "core/rendering/renderer.h"
#include "runners/operator/device_motors.h"
#include "runners/operator/operator_model.h"

namespace remote_touch {

class SimulatedHand {
 public:
  // Without an operator the device follows the script exactly; without motors it exerts all that it is told.
  SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                const std::optional<MotorSettings>& motors, double tick_s);

  DeviceState move(const DeviceState& intended, double time_s);
  // The answer to that; what the device exerts of it moves the hand in the next tick.
  void apply(const DeviceState& device, const RenderOutput& out);
  // Of the last tick; none where there is neither operator nor device.
  std::optional<HandState> state() const;

 private:
  std::optional<OperatorModel> operator_model_;
  const bool has_motors_;
  const MotorSettings motors_;
  ToolPose intended_;
  Wrench device_wrench_;
};

}  // namespace remote_touch
