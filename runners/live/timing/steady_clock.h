// The clock of everything live: sensors, devices and the loop between them stamp with it.
#pragma once

#include <time.h>

namespace remote_touch {

// Seconds since some moment, never set back.
inline double steady_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace remote_touch
