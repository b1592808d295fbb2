// Measures of a run with a slave: what the remote scene feels of it, how late it is, and what was sent.
#pragma once

namespace remote_touch {

struct Trace;

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
