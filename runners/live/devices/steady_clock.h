// The clock of a live run.
#pragma once

#include <time.h>

#include <cerrno>

#include "runners/live/devices/clock.h"

namespace remote_touch {

// CLOCK_MONOTONIC.
class SteadyClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return kNsPerS * now.tv_sec + now.tv_nsec;
  }
  void sleep_until_ns(std::int64_t moment_ns) noexcept override {
    const timespec moment{moment_ns / kNsPerS, moment_ns % kNsPerS};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &moment, nullptr) == EINTR) continue;
  }

 private:
  static constexpr std::int64_t kNsPerS = 1'000'000'000;
};

inline Clock& steady_clock() {
  static SteadyClock clock;
  return clock;
}

}  // namespace remote_touch
