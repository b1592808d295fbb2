// Measures the lateness of the ticks of a haptic loop on this machine, if a tick has nothing to do.
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

// Measures the loop of devices that have none of their own. stop: ends it early.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock);

// Rows of "from to count bar", each twice as wide as the one before.
std::string histogram(const std::vector<double>& late_s);

}  // namespace remote_touch
