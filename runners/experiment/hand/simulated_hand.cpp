#include "runners/experiment/hand/simulated_hand.h"

namespace remote_touch {

SimulatedHand::SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                             const std::optional<DeviceSettings>& device, double tick_s)
    : has_device_(device.has_value()),
      rounds_(device && (device->position_resolution_m > 0 || device->angle_resolution_deg > 0)),
      device_(device.value_or(DeviceSettings{}), tick_s) {
  if (operator_settings)
    operator_model_.emplace(*operator_settings, tick_s, device ? device->resistance : DeviceResistance{});
}

DeviceState SimulatedHand::move(const DeviceState& intended, double time_s) {
  intended_ = {intended.position_W, intended.orientation_W};
  const DeviceState hand =
      operator_model_ ? operator_model_->move(intended, time_s, device_wrench_) : intended;
  hand_ = {hand.position_W, hand.orientation_W};
  return device_.measured(hand);
}

void SimulatedHand::apply(const Wrench& command) {
  device_wrench_ = device_.exerted_for(command);
}

std::optional<HandState> SimulatedHand::state() const {
  if (!operator_model_ && !has_device_) return {};
  HandState state{intended_.p_W, intended_.q_WT, device_wrench_.force_N, device_wrench_.torque_Nm};
  if (rounds_) state.true_pose = HandState::Pose{hand_.p_W, hand_.q_WT};
  return state;
}

}  // namespace remote_touch
