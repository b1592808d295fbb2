#include "runners/operator/simulated_hand.h"

namespace remote_touch {

SimulatedHand::SimulatedHand(const std::optional<OperatorSettings>& person,
                             const std::optional<MotorSettings>& motors, double tick_s)
    : has_motors_(motors.has_value()), motors_(motors.value_or(MotorSettings{})) {
  if (person) person_.emplace(*person, tick_s);
}

DeviceState SimulatedHand::move(const DeviceState& intended, double time_s) {
  intended_ = {intended.position_W, intended.orientation_W};
  return person_ ? person_->move(intended, time_s, felt_) : intended;
}

void SimulatedHand::feel(const DeviceState& device, const RenderOutput& out) {
  felt_ = exerted(motors_, device.orientation_W,
                  {out.force_N, out.tool ? out.tool->torque_Nm : Vec3(Vec3::Zero())});
}

std::optional<HandState> SimulatedHand::state() const {
  if (!person_ && !has_motors_) return {};
  return HandState{intended_.p_W, intended_.q_WT, felt_.force_N, felt_.torque_Nm};
}

}  // namespace remote_touch
