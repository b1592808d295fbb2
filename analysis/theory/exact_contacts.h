// Contacts with exact surfaces in closed form: what a ball can touch, and how a rigid tool rests and jumps.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace remote_touch {

// The surface that a ball can touch: the morphological closing of a profile with a ball, the oracle of Fig
// 4.14.

// heights[i] is the profile at position i * spacing. The closing at a position is the lowest point that a
// ball of that radius, rolled over the profile from above, can reach there; never below the profile. The
// ball's centre is tried at the samples only, for which the result is exact. Within a radius of the ends the
// ball rests on the samples that exist. All lengths in one unit.
std::vector<double> ball_closing(const std::vector<double>& heights, double spacing, double radius);

// Closed forms of the force and torque between a hand and a rigid tool that rests without friction on exact
// surfaces. Rendered wrenches are compared with these models, after R. Weller, D. Mainzer, G. Zachmann, M.
// Sagardia, T. Hulin and C. Preusche, "A benchmarking suite for 6-DOF real time collision response
// algorithms", VRST 2010. The coupling is (6.9) with one stiffness k along all axes and k r^2 about them; the
// tool is where the coupling has the least energy. All are problems in a plane: x, y in metres, angles from x
// to y.

struct EvenSpring {
  double stiffness_N_per_m = 600, gyration_radius_m = 0.03;
};

// Wrench on the hand.
struct RestingWrench {
  Eigen::Vector2d force_N = Eigen::Vector2d::Zero();
  double torque_Nm = 0;
};

// A block of 2 a x 2 b on the line y = 0. The hand holds its middle at a height, turned by an angle of less
// than atan(a / b). The block turned by phi touches with a corner at the height h(phi) = a sin(phi) + b
// cos(phi) of its middle, and lies flat if a k (b - height) >= k r^2 angle.
RestingWrench block_on_line(double a_m, double b_m, const EvenSpring& spring, double height_m,
                            double angle_rad);

// A ball between two lines that rise from the origin to both sides by the slope. The hand holds its middle at
// a position.
RestingWrench ball_in_groove(double radius_m, double slope_rad, const EvenSpring& spring,
                             const Eigen::Vector2d& place_m);

// A bar of 2 a x 2 b that is turned in the middle between two lines 2 w apart. Two corners touch if the angle
// is at least asin(w / sqrt(a^2 + b^2)) - atan(b / a).
double stop_angle_rad(double a_m, double b_m, double w_m);
RestingWrench bar_in_slot(double a_m, double b_m, double w_m, const EvenSpring& spring, double angle_rad);

// Largest jump by which one frame may move a surface of points against a level, square plate that lies on it,
// in the direction of the plate's thickness. The points that the frame puts into the plate push it out.
// Points beyond the plate exert no contact force, so the plate is carried until no point is left in it. If
// the surface falls away from the touched position, some points are still in the plate when the first have
// passed it. The plate is then carried over its thickness plus that drop. Heights are measured from the
// highest position under the plate before the frame, in metres; angles are in radians.

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
// point of the frame before, at the median of its position. pre: some points are under the plate.
double noisy_jump_m(double thickness_m, const std::vector<NoisyPoint>& points, double sigma_m);

}  // namespace remote_touch
