// How far one frame may move a surface of points against a level, square plate that lies on it, in the
// direction of its thickness. The points that the frame puts into the plate push it out; without a contact
// force along a point that is beyond, it is carried until none is left in it. Of a surface that falls away
// from where it is touched some are left when the first are through: the plate is carried over its thickness
// and that drop. Heights are measured from the highest place under the plate before the frame, metres; angles
// in radians.
#pragma once

#include <vector>

namespace remote_touch {

// Lowest and highest place of a surface under a plate after the frame, less how far the frame moves it.
struct UnderPlate {
  double drop_m = 0;  // how far the lowest place is below
  double rise_m = 0;  // how far the highest place is above, if the surface turns
};

// An edge along the plate's middle, with flanks that slope, and that turns about itself in the frame; slope
// 0: a plane. half_m: from the middle of the plate to its side. pre: slope and turn are not negative, and
// below 90 degrees together.
UnderPlate under_edge(double slope_rad, double half_m, double turn_rad = 0);

// The top of a pyramid with three faces of this slope, one of them facing a side of the plate.
UnderPlate under_corner(double slope_rad, double half_m);

// The upper half of a ball, seen from above up to a horizontal distance from its top.
UnderPlate under_ball(double radius_m, double seen_m);

// A point of a noisy surface: its height without noise, and the probability that noise along the plate leaves
// it under the plate, or brings it there.
struct NoisyPoint {
  double height_m = 0, under_plate = 1;
};

// The jump after which the plate is as likely lost as not, of points with noise of sigma along its thickness,
// drawn anew in each frame: no point is left in it. Of the place of the plate, on the highest point of the
// frame before, the median is taken. pre: sigma_m > 0; some points are under the plate.
double noisy_jump_m(double thickness_m, const std::vector<NoisyPoint>& points, double sigma_m);

}  // namespace remote_touch
