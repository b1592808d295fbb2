// Helper of tests that wait for an event in real time.
#pragma once

#include <functional>

#include "runners/live/devices/clock.h"

namespace remote_touch {

// This limit only ends a test that hangs. No result depends on it, however busy the machine is. ctest waits
// longer.
constexpr double kPatience_s = 600;

// Returns true if the condition held within that time.
inline bool wait_until(const std::function<bool()>& condition, double patience_s = kPatience_s) {
  const double until_s = steady_clock().now_s() + patience_s;
  while (!condition() && steady_clock().now_s() < until_s) steady_clock().sleep_s(1e-3);
  return condition();
}

}  // namespace remote_touch
