// Closed forms of the force and torque between a hand and a rigid tool that rests without friction on exact
// surfaces. Rendered wrenches are compared with these models, after R. Weller, D. Mainzer, G. Zachmann, M.
// Sagardia, T. Hulin and C. Preusche, "A benchmarking suite for 6-DOF real time collision response
// algorithms", VRST 2010. The coupling is (6.9) with one stiffness k along all axes and k r^2 about them; the
// tool is where the coupling has the least energy. All are problems in a plane: x, y in metres, angles from x
// to y.
#pragma once

#include <Eigen/Core>

namespace remote_touch {

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
// is at least asin(w / sqrt(a^2 + b^2)) - atan(b / a). pre: b < w < a.
double stop_angle_rad(double a_m, double b_m, double w_m);
RestingWrench bar_in_slot(double a_m, double b_m, double w_m, const EvenSpring& spring, double angle_rad);

}  // namespace remote_touch
