#include "runners/live/devices/haptic_device.h"

#include <cmath>

namespace remote_touch {

// The start of the run fixes the times of all ticks, so that lateness does not add up. Times that pass during
// a long tick are skipped.
void HapticDevice::run(DeviceCycle& cycle) {
  const std::int64_t period_ns = std::llround(1e9 / traits().tick_rate_hz);
  std::int64_t due_ns = clock_.now_ns();
  while (cycle.tick()) {
    due_ns += period_ns;
    const std::int64_t late_ns = clock_.now_ns() - due_ns;
    if (late_ns > 0) due_ns += (late_ns + period_ns - 1) / period_ns * period_ns;
    clock_.sleep_until_ns(due_ns);
  }
}

}  // namespace remote_touch
