// Devices without hardware: a simulated hand, and a hand that someone moves in a page.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>

#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// A device that a script moves, or a simulated operator who follows the script and feels its force. Follows
// its clock: the hand also moves during ticks that were missed, in steps of its own rate. Its time starts at
// start_at(), or else with run().
class SimulatedDevice final : public HapticDevice {
 public:
  // placement: that of the loop. It is used here in the inverse direction.
  SimulatedDevice(std::shared_ptr<const Trajectory> script, const SimulatedHand& hand,
                  const DevicePlacement& placement, double rate_hz, Clock& clock);

  void start_at(std::int64_t start_ns) override { start_s_ = 1e-9 * static_cast<double>(start_ns); }
  // Rethrows the exception of the script after the loop has ended, such as an InputError for an unusable
  // frame.
  void run(const DeviceTick& tick) override;
  // Returns a fault, from then on in every call, if the script throws.
  DeviceFault read(DeviceReading& reading) noexcept override;
  DeviceFault write(const Wrench& wrench) noexcept override;
  void release() noexcept override { armed_.store(false, std::memory_order_relaxed); }
  bool rearm() noexcept override {
    armed_.store(true, std::memory_order_relaxed);
    return true;
  }

 private:
  void move_to_now();

  // The largest number of steps of one tick that the hand makes in one read(). The earlier part of a longer
  // pause is covered by one longer step before them.
  static constexpr int kMaxTicksAtOnce = 200;

  const std::shared_ptr<const Trajectory> script_;
  SimulatedHand hand_;
  const DevicePlacement placement_;
  std::optional<double> start_s_;  // time of the clock at the start
  long long ticks_ = 0;
  DeviceState state_;
  DeviceReading last_;
  std::exception_ptr failure_;  // exception that the script threw
  DeviceFault fault_;           // its text is in failure_
  std::atomic<bool> armed_ = true;
};

// A hand without a haptic device: someone moves it with the mouse in a page of the viewer. Input only, six
// axes, no motors.
//
// A page sends about sixty poses a second, and the loop needs one in each tick. The position therefore
// follows the newest pose as a critically damped spring would, and the orientation approaches it
// exponentially. Both lag by about 30 ms, and neither is faster than kMaxSpeed_m_per_s and
// kMaxTurning_rad_per_s.
inline constexpr double kMaxHandDistance_m = 10;  // limit from the origin, along each axis

// The motion that a page requests: by `to` relative to `from`, from where the hand was stopped. The buttons
// are those of `to`. When `stops` has changed, the tick that reads it stops the hand where it is then,
// because only the loop knows the present place.
struct HandMotion {
  DeviceState from, to;
  std::uint32_t stops = 0;
};

// Passes the newest motion from the thread of the page to the haptic loop.
using HandPoses = TripleBuffer<HandMotion>;

class BrowserDevice final : public HapticDevice {
 public:
  static constexpr double kNaturalFrequency_rad_per_s = 60;  // natural frequency of the spring
  static constexpr double kMaxSpeed_m_per_s = 1;  // a third of what the safety gate allows by default
  static constexpr double kMaxTurning_rad_per_s = 6;

  // start: the state of the hand until the page moves it. placement: must describe the same pose and motion
  // scale of the device as the placement of the loop.
  BrowserDevice(std::shared_ptr<HandPoses> poses, const DeviceState& start, const DevicePlacement& placement,
                double rate_hz, Clock& clock);

  void run(const DeviceTick& tick) override;
  DeviceFault read(DeviceReading& reading) noexcept override;
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
  bool rearm() noexcept override { return true; }

 private:
  void request(const HandMotion& motion);
  void follow(double interval_s);
  void turn(double interval_s);

  // The largest number of steps in one read(). The hand does not move in the earlier part of a longer pause.
  static constexpr int kMaxTicksAtOnce = 200;

  const std::shared_ptr<HandPoses> poses_;
  const DevicePlacement placement_;
  DeviceState stopped_, wanted_;
  std::uint32_t stops_ = 0;
  DeviceState now_;
  Vec3 velocity_m_per_s_ = Vec3::Zero();
  double start_s_ = 0;
  long long ticks_ = 0;
  DeviceReading last_;
};

}  // namespace remote_touch
