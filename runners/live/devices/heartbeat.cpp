#include "runners/live/devices/heartbeat.h"

#include <cmath>

namespace remote_touch {

Heartbeat::Heartbeat(HapticDevice& device, double max_s)
    : device_(device), max_ns_(std::llround(1e9 * max_s)) {}

bool Heartbeat::beat(std::int64_t now_ns) noexcept {
  last_ns_.store(now_ns, std::memory_order_release);
  return !released_.exchange(false, std::memory_order_acq_rel);
}

// A beat may come between the check of the time and the release: the device is released then too, and the
// next beat reports it.
void Heartbeat::check(std::int64_t now_ns) noexcept {
  const std::int64_t last_ns = last_ns_.load(std::memory_order_acquire);
  const bool is_known = last_ns == kNone || last_ns == stalled_at_ns_;  // one release per stall
  if (is_known || now_ns - last_ns <= max_ns_) return;
  device_.release();
  released_.store(true, std::memory_order_release);
  stalls_.fetch_add(1, std::memory_order_relaxed);
  stalled_at_ns_ = last_ns;
}

}  // namespace remote_touch
