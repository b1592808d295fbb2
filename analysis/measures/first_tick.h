// The first tick of a run in which an event happens, and its time.
#pragma once

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// Returns the first tick i for which happens(i) is true; NaN if there is none. happens() is called for each
// tick up to it.
template <class Happens>
double first_tick(const Trace& trace, Happens&& happens) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (happens(i)) return static_cast<double>(i);
  return kNoValue;
}

// Returns the time of a tick, s; NaN for NaN.
inline double time_of(const Trace& trace, double tick) {
  return tick >= 0 ? trace.time_s[static_cast<std::size_t>(tick)] : kNoValue;
}

}  // namespace remote_touch
