#include "runners/live/devices/haptic_device.h"

#include <time.h>

#include <cerrno>
#include <cmath>

namespace remote_touch {

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

std::int64_t steady_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNsPerS + now.tv_nsec;
}

void sleep_until(std::int64_t due_ns) {
  const timespec due{due_ns / kNsPerS, due_ns % kNsPerS};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) continue;
}

}  // namespace

// The moments of the ticks are fixed by the first, so that lateness does not add up; those that pass during a
// long tick are left out.
void HapticDevice::run(DeviceCycle& cycle) {
  const std::int64_t period_ns = std::llround(kNsPerS / traits().tick_rate_hz);
  std::int64_t due_ns = steady_ns();
  while (cycle.tick()) {
    due_ns += period_ns;
    const std::int64_t late_ns = steady_ns() - due_ns;
    if (late_ns > 0) due_ns += (late_ns + period_ns - 1) / period_ns * period_ns;
    sleep_until(due_ns);
  }
}

}  // namespace remote_touch
