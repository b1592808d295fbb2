// Measures of the direction of the force on the hand: how large its part along the true surface is. There is
// no friction, so without noise the force acts along the normal. Noise tilts the normals that a renderer
// estimates, so the hand feels a force along the surface.
//
// The measures use the ticks in contact (touching or entrenched, with a force) in which n =
// Trace::true_normal is known. An unknown force is none. F is the force without the part of guidance. A
// measure is NaN if there is no such tick.
#pragma once

namespace remote_touch {

struct Trace;

// |F - (F.n) n| / (F.n), the tangent of the angle between F and n: its mean, and its 95th percentile (95 % of
// the ticks are below it). Only ticks whose force points out of the surface (F.n > 0) count. A force into the
// surface has no such ratio; mean_force_angle_rad() includes it.
double mean_lateral_force(const Trace& trace);
double lateral_force_95(const Trace& trace);
// Mean angle between F and n, rad, 0 to pi. The force of a tick with an angle above pi / 2 pulls into the
// surface.
double mean_force_angle_rad(const Trace& trace);

}  // namespace remote_touch
