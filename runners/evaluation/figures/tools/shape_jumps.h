// Distances by which one frame may move an edge, a corner, a ball or a plane against the plate of figure
// tool-shapes, by each contact rule: the closed forms of analysis/theory/exact_contacts.h for what counts as
// inside by that rule.
#pragma once

#include "runners/evaluation/figures/tools/carried_limits.h"
#include "scenarios/synthetic/shape.h"

namespace remote_touch {

// Settings of the sweeps tool-shape-*, tool-walls and tool-wall-sides.
inline constexpr double kJumpFrames_hz = 30, kHalfPlate_m = 0.02, kPlate_m = 0.01;
inline constexpr double kSlope_deg = 30, kRadius_m = 0.04;  // used where they are not an axis

// Jump along the thickness of the plate. least_m and most_m enclose bound_m because there is a point only
// every 1.5 mm, and because look-ahead holds the disks of points.
struct Jump {
  double least_m = 0, bound_m = 0, most_m = 0;
};

// An edge that turns in the same frame, or is tilted; slope 0: a plane.
Jump on_edge(Carrier rule, double thickness_m, double slope_deg, double turn_deg = 0);
Jump on_corner(Carrier rule, double thickness_m, double slope_deg);
Jump on_ball(Carrier rule, double thickness_m, double radius_m);
// A plane against the tool's extent along its normal.
Jump on_plane(Carrier rule, double extent_m);
// Jump after which half of the runs are lost, with noise on x, y and z; the plate is kPlate_m thick.
Jump on_noise(Carrier rule, Shape::Kind kind, double sigma_m);
// Returns bound_m of on_noise() alone, in a third of its time.
double noise_bound_m(Carrier rule, Shape::Kind kind, double sigma_m);

}  // namespace remote_touch
