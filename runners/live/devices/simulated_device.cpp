#include "runners/live/devices/simulated_device.h"

#include <algorithm>
#include <utility>

namespace remote_touch {

SimulatedDevice::SimulatedDevice(std::shared_ptr<const Trajectory> script, const SimulatedHand& hand,
                                 const DevicePlacement& placement, double rate_hz, Clock& clock)
    : HapticDevice(
          clock, {.name = "simulated device", .sensed_axes = 6, .actuated_axes = 6, .tick_rate_hz = rate_hz}),
      script_(std::move(script)),
      hand_(hand),
      placement_(placement) {}

void SimulatedDevice::run(const DeviceTick& tick) {
  if (!start_s_) start_s_ = clock().now_s();
  HapticDevice::run(tick);
  if (failure_) std::rethrow_exception(failure_);
}

void SimulatedDevice::move_to_now() {
  const auto now = static_cast<long long>((clock().now_s() - start_s_.value_or(0)) * traits_.tick_rate_hz);
  const long long first = ticks_;
  ticks_ = std::max(ticks_ + 1, now);
  for (long long tick = std::max(first + 1, ticks_ - kMaxTicksAtOnce); tick <= ticks_; ++tick) {
    const double time_s = static_cast<double>(tick) / traits_.tick_rate_hz;
    state_ = hand_.move(script_->at(time_s), time_s);
  }
}

DeviceFault SimulatedDevice::read(DeviceReading& reading) noexcept try {
  if (fault_) return fault_;
  const long long first = ticks_;
  move_to_now();
  reading = placement_.of_device(state_);
  if (first > 0)
    reading.velocity_m_per_s =
        (reading.position_m - last_.position_m) * traits_.tick_rate_hz / static_cast<double>(ticks_ - first);
  last_ = reading;
  return {};
} catch (const std::exception& error) {
  failure_ = std::current_exception();
  return fault_ = {error.what()};
} catch (...) {
  failure_ = std::current_exception();
  return fault_ = {"the script of the simulated hand failed"};
}

DeviceFault SimulatedDevice::write(const Wrench& wrench) noexcept {
  const Wrench device_wrench =
      armed_.load(std::memory_order_relaxed) ? placement_.in_world(wrench) : Wrench{};
  hand_.apply(device_wrench);
  return {};
}

}  // namespace remote_touch
