// Measures: numbers that summarise a run, computed from its trace.
#pragma once

#include <span>
#include <string>

#include "analysis/trace/trace.h"

namespace remote_touch {

// 1 when the proxy's centre ended below the true surface, else 0.
double popped_through(const Trace& trace);
// How far the centre was at most behind the true surface, m; 0 when never. Ticks without a known truth do not
// count; NaN without any other.
double max_penetration_m(const Trace& trace);
// The minimum distance of the slave command to the true surface, m, over the ticks with a known truth; NaN
// without any. With a uniform radius a fixture is violated by r_f + r_c less this.
double min_slave_distance_m(const Trace& trace);
// Share of the ticks with a known truth whose proxy centre lies behind the surface; NaN without any.
double wrong_side_fraction(const Trace& trace);
// How far the rendered surface is from the true one: rms difference of the centre's distance to the true
// surface and to the nearest point, over the ticks that end in contact and have a known truth, m; NaN without
// any.
double rms_surface_error_m(const Trace& trace);
// Largest change of the force between two ticks where a new frame came in while force was rendered on both
// sides, N.
double max_force_jump_N(const Trace& trace);
// Share of the ticks with the HIP held back by the surface that had no force: dropouts.
double no_force_fraction(const Trace& trace, double contact_radius_m);
// Proxy steps per tick.
double mean_steps(const Trace& trace);
double max_steps(const Trace& trace);
// Share of the ticks that ended without convergence (4.8).
double unconverged_fraction(const Trace& trace);
// Share of ticks with a number that is not finite in position, force or normal; and, where there is one, of a
// tool in torque or orientation, of a simulated hand in what the device exerts.
double non_finite_fraction(const Trace& trace);
double max_force_N(const Trace& trace);

// The measures that need nothing but a trace, by name: for summaries and for sweeps.
struct Measure {
  const char* name;
  const char* unit;
  const char* meaning;
  double (*of)(const Trace&);
};
std::span<const Measure> measures();

}  // namespace remote_touch
