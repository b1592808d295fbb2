// Measures of a run with contact, as scalars of a trace: the height of the rendered surface over the true
// one, and when the force ends. An unknown force is none.
#pragma once

namespace remote_touch {

struct Trace;

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

}  // namespace remote_touch
