#include "runners/experiment/hand/simulated_hand.h"

namespace remote_touch {

SimulatedHand::SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                             const std::optional<MotorSettings>& motors, double tick_s)
    : has_motors_(motors.has_value()), motors_(motors.value_or(MotorSettings{})) {
  if (operator_settings) operator_model_.emplace(*operator_settings, tick_s);
}

DeviceState SimulatedHand::move(const DeviceState& intended, double time_s) {
  intended_ = {intended.position_W, intended.orientation_W};
  return operator_model_ ? operator_model_->move(intended, time_s, device_wrench_) : intended;
}

void SimulatedHand::apply(const DeviceState& device, const RenderOutput& out) {
  device_wrench_ = exerted(motors_, device.orientation_W,
                           {out.force_N, out.tool ? out.tool->torque_Nm : Vec3(Vec3::Zero())});
}

std::optional<HandState> SimulatedHand::state() const {
  if (!operator_model_ && !has_motors_) return {};
  return HandState{intended_.p_W, intended_.q_WT, device_wrench_.force_N, device_wrench_.torque_Nm};
}

}  // namespace remote_touch
