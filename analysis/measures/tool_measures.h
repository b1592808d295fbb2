// Measures of runs with a tool (chapters 6 and 7) and with guidance. A measure is NaN if the run has no tool,
// or no guidance.
#pragma once

#include <type_traits>

#include "analysis/measures/no_value.h"
#include "analysis/statistics/extremes.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// Lag of the tool behind the device in a tick: distance of the tool's centre of mass from the HIP, m, and
// angle between their orientations, rad.
double tool_lag_m(const Trace& trace, std::size_t i);
double tool_lag_rad(const Trace& trace, std::size_t i);
// Magnitude of the torque about the HIP in a tick, N m.
double torque_magnitude_Nm(const Trace& trace, std::size_t i);

// The value of tick i. of: a column of the trace, or a function like those above.
template <auto of>
double value_of_tick(const Trace& trace, std::size_t i) {
  if constexpr (std::is_member_object_pointer_v<decltype(of)>)
    return (trace.*of)[i];
  else
    return of(trace, i);
}
// Mean and maximum of the value over the ticks of a run with a tool; NaN without a tool or without ticks.
template <auto of>
double tool_mean(const Trace& trace) {
  if (!trace.has_tool() || trace.length() == 0) return kNoValue;
  double sum = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) sum += value_of_tick<of>(trace, i);
  return sum / static_cast<double>(trace.length());
}
template <auto of>
double tool_max(const Trace& trace) {
  if (!trace.has_tool() || trace.length() == 0) return kNoValue;
  double found = value_of_tick<of>(trace, 0);
  for (std::size_t i = 1; i < trace.length(); ++i) found = max_or_nan(found, value_of_tick<of>(trace, i));
  return found;
}

// Gap between the tool and the nearest point or region, m, negative inside the tool: minimum over the ticks
// that have a nearest point or region; NaN if there is no such tick, or if a gap is unknown.
double min_clearance_m(const Trace& trace);

// Fraction of the ticks with an active guidance fixture whose target is visible.
double guidance_fraction(const Trace& trace);
// Distance of the tool, or of the proxy, from the goal of guidance at the last tick with active guidance, m,
// and angle between tool and goal, rad. NaN if no tick has active guidance; the angle is NaN also without a
// tool.
double guidance_error_m(const Trace& trace);
double guidance_error_rad(const Trace& trace);

}  // namespace remote_touch
