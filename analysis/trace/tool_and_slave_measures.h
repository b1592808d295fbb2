// Measures of a run with a tool, with guidance or with a slave.
#pragma once

#include <type_traits>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// Measures of runs with a tool (chapters 6 and 7) and with guidance. A measure is NaN if the run has no tool,
// or no guidance.

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

// Measures of a run with a slave: what the remote scene feels of it, how late it is, and what was sent.

// Forces on the slave are not known in a tick in which it is behind the surface and the normal of the surface
// is not known; the force columns are then NaN. Ticks before the first command have no force.

// Maximum of Trace::slave_peak_force_N, N: forces between the ticks count. NaN if it is not known in some
// tick, or if the slave never got a command.
double max_slave_force_N(const Trace& trace);
// 1 when the scene exerted a force on the slave in any tick, else 0. NaN if the slave never got a command, if
// the true surface was not known wherever it was, and if the force is not known in some tick and 0 in all
// others.
double slave_touched(const Trace& trace);
// Fraction of the ticks with a force on the slave. NaN if it is not known in some tick.
double slave_contact_fraction(const Trace& trace);
// Minimum of Trace::slave_clearance_m, m, over the ticks in which it is known; NaN if there is no such tick.
double min_slave_clearance_m(const Trace& trace);
// Root mean square of the distance of the slave from Trace::slave_command_m of the same tick, m: delay,
// limited bandwidth and contact together. Ticks without a command that is finite do not count; NaN if there
// are no others.
double rms_slave_lag_m(const Trace& trace);
// Root mean square of the angle between the orientation of the slave's tool and that which was commanded in
// the same tick, rad. The commanded orientation is that of the renderer's tool if Trace::slave_command_m is
// the position of that tool, else that of the device. Ticks without a command that is finite do not count;
// NaN if there are no others, or if the slave is a ball.
double rms_slave_lag_angle_rad(const Trace& trace);
// Maximum magnitude of the force of the device on the hand, N.
double max_device_force_N(const Trace& trace);
// Time of the first tick with a force on the slave, s; NaN if there is none, or if the force is not known in
// an earlier tick.
double first_slave_contact_time_s(const Trace& trace);
// Time of first contact of the slave less that of the first tick in which the device exerts a force on the
// hand, s. An unknown force of the device is none. Positive: the hand is warned. NaN if one of them never
// happens.
double slave_anticipation_s(const Trace& trace);
// Packets after the first tick, divided by the time from the first tick to the last. NaN for a run of one
// tick. The frames are those that arrived.
double command_packet_rate_per_s(const Trace& trace);
double force_packet_rate_per_s(const Trace& trace);
double frame_packet_rate_per_s(const Trace& trace);

}  // namespace remote_touch
