// Measures the lateness of the ticks of a haptic loop on this machine; the ticks themselves do nothing.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "runners/live/devices/clock.h"

namespace remote_touch {

struct Jitter {
  std::vector<double> late_s;  // delay of every tick
  long long missed = 0;        // ticks that never began
  std::string real_time;       // rights that the system granted, see become_real_time()
};

// Measures the loop that is used for devices without a loop of their own. stop: may end it early; may be
// null.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock);

// Returns rows of "from to count bar". Each row ends at twice the time of the row before; empty rows are
// omitted.
std::string histogram(const std::vector<double>& late_s);

}  // namespace remote_touch
