// The direction of the force on the hand: how much of it acts along the true surface. There is no friction,
// so without noise a force acts along the normal; noise turns the normals that a renderer estimates, and the
// hand feels a force along the surface.
//
// Judged are the ticks in contact (touching or entrenched, with a force) in which the normal n of the true
// surface is known, Trace::true_normal. F is the force without the part of guidance. NaN without such a tick.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// |F - (F.n) n| / (F.n): the tangent of the angle between F and n, as mean and as 95th percentile (the value
// that 95 % of the ticks lie below). Only ticks whose force pushes out of the surface (F.n > 0): a force into
// the surface has no such ratio, and shows in mean_force_angle_rad().
double mean_lateral_force(const Trace& trace);
double lateral_force_95(const Trace& trace);
// Mean angle between F and n, rad, 0 to pi; above pi / 2 the force pulls into the surface.
double mean_force_angle_rad(const Trace& trace);

}  // namespace remote_touch
