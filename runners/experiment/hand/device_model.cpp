#include "runners/experiment/hand/device_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// Returns the nearest multiples of the step; the vector itself without a step.
Vec3 rounded(const Vec3& v, double step) {
  if (!(step > 0)) return v;
  return v.unaryExpr([step](double x) { return std::round(x / step) * step; });
}

}  // namespace

DeviceModel::DeviceModel(const DeviceSettings& settings, double tick_s)
    : s_(settings),
      tick_s_(tick_s),
      positions_(static_cast<std::size_t>(settings.velocity_ticks) + 1, Vec3::Zero()),
      commands_(static_cast<std::size_t>(settings.delay_ticks) + 1) {}

DeviceState DeviceModel::measured(const DeviceState& hand) {
  DeviceState state = hand;
  state.position_W = rounded(hand.position_W, s_.position_resolution_m);
  if (s_.angle_resolution_deg > 0)
    state.orientation_W = rotation(
        rounded(rotation_vector(hand.orientation_W), s_.angle_resolution_deg * std::numbers::pi / 180));
  handle_W_ = state.orientation_W;
  positions_[position_count_++ % positions_.size()] = state.position_W;
  return state;
}

// Returns the mean velocity over velocity_ticks, or over all ticks if there were fewer.
Vec3 DeviceModel::measured_velocity() const {
  const std::size_t ticks = std::min(position_count_, positions_.size()) - 1;
  if (ticks == 0) return Vec3::Zero();
  const std::size_t newest = position_count_ - 1;
  const Vec3 way = positions_[newest % positions_.size()] - positions_[(newest - ticks) % positions_.size()];
  return way / (static_cast<double>(ticks) * tick_s_);
}

Wrench DeviceModel::exerted_for(const Wrench& command) {
  Wrench sum = command;
  if (s_.contact_damping_Ns_per_m != 0 && !command.force_N.isZero(0))
    sum.force_N -= s_.contact_damping_Ns_per_m * measured_velocity();
  const std::size_t newest = command_count_++;
  commands_[newest % commands_.size()] = sum;
  // The entry after the newest one is the oldest. Before the ring is full it is a zero wrench.
  return exerted(s_.motors, handle_W_, commands_[command_count_ % commands_.size()]);
}

}  // namespace remote_touch
