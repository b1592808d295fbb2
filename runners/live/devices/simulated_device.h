// A device without hardware: a script moves it, or a simulated operator who follows the script and feels its
// force.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>

#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// Follows its clock: the hand also moves during ticks that were missed, in steps of its own rate. Its time
// starts at start_at(), or else with run().
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

}  // namespace remote_touch
