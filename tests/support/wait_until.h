// For tests that wait for something in real time.
#pragma once

#include <functional>

#include "runners/live/timing/steady_clock.h"

namespace remote_touch {

// What happens at once on a machine with nothing else to do may take seconds on a busy one.
constexpr double kPatience_s = 60;

// Whether it came true in that time.
inline bool wait_until(const std::function<bool()>& is_so, double patience_s = kPatience_s) {
  const double until_s = steady_clock().now_s() + patience_s;
  while (!is_so() && steady_clock().now_s() < until_s) steady_clock().sleep_s(1e-3);
  return is_so();
}

}  // namespace remote_touch
