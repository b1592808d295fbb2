// A watchdog: a loop that hangs cannot release its device, so a separate thread does.
#pragma once

#include <atomic>
#include <cstdint>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

class Heartbeat {
 public:
  Heartbeat(HapticDevice& device, double max_s);

  // The loop calls it at the start of every tick. The first call starts the watch. Returns false if the
  // device was released since the last beat.
  bool beat(std::int64_t now_ns) noexcept;
  // Ends the watch: no more beats are expected.
  void rest() noexcept { last_ns_.store(kNone, std::memory_order_release); }

  // Releases the device if there was no beat for longer than max_s. A thread that does not depend on the loop
  // must call it about every period_s().
  void check(std::int64_t now_ns) noexcept;
  double period_s() const { return 1e-9 * static_cast<double>(max_ns_) / 5; }
  // True if the device was released and no beat has come since.
  bool is_released() const { return released_.load(std::memory_order_acquire); }
  int stalls() const { return stalls_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kNone = -1;

  HapticDevice& device_;
  const std::int64_t max_ns_;
  std::atomic<std::int64_t> last_ns_ = kNone;
  std::int64_t stalled_at_ns_ = kNone;  // last beat before the newest stall; used by check() alone
  std::atomic<bool> released_ = false;
  std::atomic<int> stalls_ = 0;
};

}  // namespace remote_touch
