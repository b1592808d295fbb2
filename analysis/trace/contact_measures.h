// Events of a run: on which side of the true surface the proxy is, pop-through, and when something happens
// first. Measures of a run with contact, with a tool, with guidance or with a slave.
#pragma once

#include <type_traits>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// The first tick of a run in which an event happens, and its time.

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

// The side of the true surface on which a proxy is, tick after tick, and how it got there: the definition of
// pop-through.
//
// The proxy is behind the surface if its signed distance d is less than -held_depth_m, and else in front of
// it. The held depth (see held_depth_m() in frames_and_outputs.h) is 0 for a ball, whose centre stays in
// front. A proxy that rests on the surface itself is slightly behind it as often as in front of it.
//
// A proxy pops through if it moves from the front to the back while d is known in every tick.
// A proxy that begins behind the surface has not passed through it. If d was unknown in between, the proxy
// may have gone round a border of the surface, through a hole in the measurement, or through the surface:
// then it is not known how it came to the back.
class SurfaceSide {
 public:
  explicit SurfaceSide(double held_depth_m) : held_depth_m_(held_depth_m) {}

  // Adds the next tick; NaN: the distance is unknown. Returns true if the proxy pops through in this tick.
  bool add(double signed_distance_m);
  // The result after the last tick: 1 if the proxy is behind the surface and popped through it, 0 if it is in
  // front or has been behind since the first tick. NaN if its distance is unknown, if it is unknown how it
  // got to the back, or if there were no ticks.
  double popped_through() const;

 private:
  enum class Side { unseen, front, back };

  double held_depth_m_;
  Side side_ = Side::unseen;     // side in the last tick with a known distance
  bool is_known_ = false;        // true if the distance in the last tick is known
  bool was_unknown_ = false;     // true: it was unknown since the proxy was last in front, or since the start
  double result_if_behind_ = 0;  // 1, 0 or NaN as above
};

// The outcome of a run: popped_through() after its last tick, and the first tick in which the proxy pops
// through (NaN: none). Ticks before the first frame do not count, because no renderer can hold a surface that
// it has not received: the proxy begins where it is when the first frame comes.
struct SideOfRun {
  double popped_through = 0, first_pop_through_tick = 0;
};
// distance_m: distance of the proxy from a surface in each tick of the trace.
SideOfRun side_of_run(const Trace& trace, const std::vector<double>& distance_m);

// The distances by which a run is judged: from the true surface or, in a run that has one beside it, from the
// surface that the camera measured. What lies between the two is the error of the camera, which no renderer
// can know.
const std::vector<double>& judged_distance_m(const Trace& trace);

// Time, s, and tick of events in a run; NaN if the event did not happen.

// The first tick in which the proxy or tool touches a point or a region (contact_count).
double first_contact_tick(const Trace& trace);
double first_contact_time_s(const Trace& trace);
// The first tick in which the proxy's centre (with a tool its centre of mass) passes to the back of the
// surface by which the run is judged, see SurfaceSide. It may come back later; popped_through() considers
// only the last tick.
double first_pop_through_tick(const Trace& trace);
double first_pop_through_time_s(const Trace& trace);
// The time of max_force_jump_tick(), see force_measures.h.
double max_force_jump_time_s(const Trace& trace);

// The force of contact on the hand in a tick, and whether there is one.

// Returns the force on the hand without the part of guidance, which may pull in any direction, N, world
// frame.
inline Vec3 contact_force_N(const Trace& trace, std::size_t i) {
  return trace.has_guidance() ? Vec3(trace.force_N[i] - trace.guidance_force_N[i]) : trace.force_N[i];
}

inline Vec3 contact_torque_Nm(const Trace& trace, std::size_t i) {
  return trace.has_guidance() ? Vec3(trace.torque_Nm[i] - trace.guidance_torque_Nm[i]) : trace.torque_Nm[i];
}

// True if the vector is a force: neither zero nor unknown. An unknown force (NaN) is no force, so that it
// never counts as contact; non_finite_fraction() counts it.
inline bool is_force(const Vec3& force_N) {
  return force_N.allFinite() && !force_N.isZero(0);
}
inline bool has_contact_force(const Trace& trace, std::size_t i) {
  return is_force(contact_force_N(trace, i));
}

// The contact point of a ball: the point on the sphere of radius r_c around the proxy that faces the surface,
// according to the renderer's normal. frames_and_outputs.h defines the contact point of every renderer, by
// the true normal.

// P - r_c n, world frame.
inline Vec3 contact_point(const Trace& trace, std::size_t i, double contact_radius_m) {
  return trace.proxy_position_m[i] - contact_radius_m * trace.normal[i];
}

// True if the surface holds the proxy back: the HIP is more than 1.01 r_c away from the proxy.
inline bool pressing(const Trace& trace, std::size_t i, double contact_radius_m) {
  return (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm() > 1.01 * contact_radius_m;
}

// The height of the rendered surface above the true one, and when the force ends. An unknown force is none.

// Height of the rendered surface above the true one, m: the distance from the centre of the proxy to the true
// surface minus the distance to the nearest point. Mean and standard deviation over the ticks that end in
// contact and have a known truth. NaN if there is no such tick.
double mean_height_m(const Trace& trace);
double height_sd_m(const Trace& trace);
// Error of the rendered surface: the root mean square of that height over the same ticks, m.
double rms_surface_error_m(const Trace& trace);
// Distance of the centre from the true surface, m: mean and standard deviation over the ticks with a force
// and a known truth; NaN if there is no such tick. Unlike the height it does not depend on the points, so it
// can compare renderers whose proxy lies on the surface with those whose proxy stays r_c above it.
double mean_distance_m(const Trace& trace);
double distance_sd_m(const Trace& trace);
// Distance of the centre to the true surface in the last tick, m, negative behind it; NaN if it is not known.
double end_distance_m(const Trace& trace);
// Fraction of the ticks with a force; 0 for a trace without ticks.
double force_fraction(const Trace& trace);
// Time of the last tick with a force, s. NaN if no tick has a force.
double last_force_time_s(const Trace& trace);

// Distance of the rendered surface from the true one, by one rule for every renderer: the height of the
// contact point above the true surface, Trace::contact (frames_and_outputs.h defines the contact point). Both
// sides count, and so does every tick, not only the last.
//
// Only settled ticks are judged: those in which the renderer has had a frame and the HIP has been below the
// true surface for kSettling_s without a break, so that every renderer must hold it back. If the hand follows
// a prescribed path, they are the same for every renderer. The measures of a distance skip settled ticks in
// which the truth at the contact point is not known.
//
// Every measure is NaN if no tick is settled or if Trace::contact is empty. A measure of a distance is also
// NaN if no settled tick has a known truth.

inline constexpr double kSettling_s = 0.1;

// Maximum distance of the contact point from the true surface, m, on either side of it (max_contact_error_m),
// below it (max_sink_m, 0 if it never was below) and above it (max_float_m, 0 if it never was above).
double max_contact_error_m(const Trace& trace);
double max_sink_m(const Trace& trace);
double max_float_m(const Trace& trace);
// Root mean square of the height of the contact point, m.
double rms_contact_error_m(const Trace& trace);
// The two parts of that height if the run has a measured surface beside the true one. The error of the
// renderer is the height of the contact point above the measured surface. The error of the camera is the
// height of the measured surface above the true one, at the contact point. Root mean squares, and the mean of
// the camera's error, m, over the settled ticks in which both surfaces are known.
double rms_renderer_error_m(const Trace& trace);
double rms_camera_error_m(const Trace& trace);
double mean_camera_error_m(const Trace& trace);
// Fraction of the settled ticks with a force of contact, which excludes guidance; NaN if no tick settled.
double contact_force_fraction(const Trace& trace);
// Fraction of the settled ticks in which the truth is known; NaN if no tick settled.
double contact_known_fraction(const Trace& trace);

// Measures of the direction of the force on the hand: how large its part along the true surface is. There is
// no friction, so without noise the force acts along the normal. Noise tilts the normals that a renderer
// estimates, so the hand feels a force along the surface.
//
// The measures use the ticks in contact (touching or entrenched, with a force) in which n =
// Trace::true_normal is known. An unknown force is none. F is the force without the part of guidance. A
// measure is NaN if there is no such tick.

// |F - (F.n) n| / (F.n), the tangent of the angle between F and n: its mean, and its 95th percentile (95 % of
// the ticks are below it). Only ticks whose force points out of the surface (F.n > 0) count. A force into the
// surface has no such ratio; mean_force_angle_rad() includes it.
double mean_lateral_force(const Trace& trace);
double lateral_force_95(const Trace& trace);
// Mean angle between F and n, rad, 0 to pi. The force of a tick with an angle above pi / 2 pulls into the
// surface.
double mean_force_angle_rad(const Trace& trace);

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
