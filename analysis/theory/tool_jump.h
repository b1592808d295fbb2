// Largest jump by which one frame may move a surface of points against a level, square plate that lies on it,
// in the direction of the plate's thickness. The points that the frame puts into the plate push it out.
// Points beyond the plate exert no contact force, so the plate is carried until no point is left in it. If
// the surface falls away from the touched position, some points are still in the plate when the first have
// passed it. The plate is then carried over its thickness plus that drop. Heights are measured from the
// highest position under the plate before the frame, in metres; angles are in radians.
#pragma once

#include <vector>

namespace remote_touch {

// Lowest and highest position of a surface under a plate after the frame, without the distance that the frame
// moves it.
struct UnderPlate {
  double drop_m = 0;  // depth of the lowest position below
  double rise_m = 0;  // height of the highest position above, if the surface turns
};

// A surface with an edge along the plate's middle and sloping flanks, which turns about that edge in the
// frame. slope 0: a plane. half_m: from the middle of the plate to its side. pre: slope and turn are not
// negative, and below 90 degrees together.
UnderPlate under_edge(double slope_rad, double half_m, double turn_rad = 0);

// The top of a pyramid with three faces of this slope, one of them facing a side of the plate.
UnderPlate under_corner(double slope_rad, double half_m);

// The upper half of a ball, seen from above up to a horizontal distance from its top.
UnderPlate under_ball(double radius_m, double seen_m);

// A point of a noisy surface: its height without noise, and the probability that it is under the plate, with
// noise along the plate.
struct NoisyPoint {
  double height_m = 0, under_plate_probability = 1;
};

// Returns the jump after which the plate is lost, with no point left in it, with probability 1/2. The points
// have noise of sigma along the plate's thickness, drawn anew in each frame. The plate rests on the highest
// point of the frame before, at the median of its position. pre: sigma_m > 0; some points are under the
// plate.
double noisy_jump_m(double thickness_m, const std::vector<NoisyPoint>& points, double sigma_m);

}  // namespace remote_touch
