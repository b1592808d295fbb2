#include "runners/live/devices/built_in_devices.h"

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

BrowserDevice::BrowserDevice(std::shared_ptr<HandPoses> poses, const DeviceState& start,
                             const DevicePlacement& placement, double rate_hz, Clock& clock)
    : HapticDevice(
          clock,
          {.name = "mouse in a browser", .sensed_axes = 6, .actuated_axes = 0, .tick_rate_hz = rate_hz}),
      poses_(std::move(poses)),
      placement_(placement),
      stopped_{start.position_W, start.orientation_W, 0},
      wanted_(stopped_),
      now_(start) {}

void BrowserDevice::run(const DeviceTick& tick) {
  start_s_ = clock().now_s();
  HapticDevice::run(tick);
}

void BrowserDevice::request(const HandMotion& motion) {
  if (motion.stops != stops_) {
    stopped_ = {now_.position_W, now_.orientation_W, 0};
    velocity_m_per_s_.setZero();
  }
  stops_ = motion.stops;
  const DeviceState &from = motion.from, &to = motion.to;
  wanted_.position_W = (stopped_.position_W + to.position_W - from.position_W)
                           .cwiseMax(-kMaxHandDistance_m)
                           .cwiseMin(kMaxHandDistance_m);
  wanted_.orientation_W =
      (to.orientation_W * from.orientation_W.conjugate() * stopped_.orientation_W).normalized();
  wanted_.buttons = to.buttons;
}

// x'' = w^2 (wanted - x) - 2 w x', the velocity first: stable for steps far below 1 / w.
void BrowserDevice::follow(double interval_s) {
  constexpr double w = kNaturalFrequency_rad_per_s;
  velocity_m_per_s_ +=
      interval_s * (w * w * (wanted_.position_W - now_.position_W) - 2 * w * velocity_m_per_s_);
  const double speed = velocity_m_per_s_.norm();
  if (speed > kMaxSpeed_m_per_s) velocity_m_per_s_ *= kMaxSpeed_m_per_s / speed;
  now_.position_W += interval_s * velocity_m_per_s_;
}

void BrowserDevice::turn(double interval_s) {
  const double left = now_.orientation_W.angularDistance(wanted_.orientation_W);
  if (left < 1e-9) return;
  const double angle = std::min(
      {left, 0.5 * kNaturalFrequency_rad_per_s * interval_s * left, kMaxTurning_rad_per_s * interval_s});
  now_.orientation_W = now_.orientation_W.slerp(angle / left, wanted_.orientation_W).normalized();
}

DeviceFault BrowserDevice::read(DeviceReading& reading) noexcept {
  if (poses_->take()) request(poses_->front());
  const long long first = ticks_;
  ticks_ = std::max(ticks_ + 1, static_cast<long long>((clock().now_s() - start_s_) * traits_.tick_rate_hz));
  const double interval_s = 1 / traits_.tick_rate_hz;
  for (long long tick = std::max(first, ticks_ - kMaxTicksAtOnce); tick < ticks_; ++tick)
    follow(interval_s), turn(interval_s);
  now_.buttons = wanted_.buttons;
  reading = placement_.of_device(now_);
  if (first > 0)
    reading.velocity_m_per_s =
        (reading.position_m - last_.position_m) * traits_.tick_rate_hz / static_cast<double>(ticks_ - first);
  last_ = reading;
  return {};
}

}  // namespace remote_touch
