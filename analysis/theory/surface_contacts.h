// Contacts with a surface in theory: what a ball can touch, how a rigid tool rests and jumps, and the limits
// of the motion of a surface beyond which it passes the proxy, with the quantities of 4.4 that they depend
// on.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/points/vector.h"

namespace remote_touch {

// Returns the surface that a ball can touch: the morphological closing of a profile with a ball, the oracle
// of Fig 4.14. heights[i] is the profile at position i * spacing. The closing at a position is the lowest
// point that a ball of that radius, rolled over the profile from above, can reach there; never below the
// profile. The ball's centre is tried at the samples only, for which the result is exact. Within a radius of
// the ends the ball rests on the samples that exist. All lengths in one unit.
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

struct Trace;

// The bounds of 4.4 on the acceleration with which a cloud can be lifted before it passes the proxy.
//
// Definitions: v_hat is the velocity estimate, assumed correct, v_hat_j = v_{j-1} (4.19); n_hat the estimated
// and n the true normal; h the thickness of the cloud, h = (P - plane).n - r_1; e_n = 1 - n.n_hat (4.22).

// A lift as in 4.3.2: velocity v_0, then `updates` updates with acceleration a.
struct Lift {
  double r1_m = 0;
  double frame_rate_hz = 0;
  double start_velocity_m_per_s = 0;
  int updates = 10;
};

// (4.14), noise-free: no pop-through below this acceleration, r_1 f_c^2.
double critical_acceleration(const Lift& lift);
// (4.21), (4.25) solved for a: the acceleration at which r_1 + h = a / f_c^2 + v_hat e_n / f_c, with the
// estimate at the last update, v_hat = v_0 + (updates - 1) a / f_c (4.20).
double bound_acceleration(const Lift& lift, double thickness_m, double normal_error);

// The printed fits for sigma from 0 to 2 r_c, and the error that rounding their coefficients to two digits
// may cause: half a unit of the last digit of each, added up.
struct PrintedFit {
  std::vector<int> powers;
  std::vector<double> coefficients, half_digits;
  double at(double sigma_m) const;
  double digits_band(double sigma_m) const;
};
const PrintedFit& printed_thickness();     // (4.23)
const PrintedFit& printed_normal_error();  // (4.24)

// The effect of noise of one strength on the quantities of (4.18): means and standard deviations over lifts
// without acceleration.
struct NoiseEffect {
  double thickness_m = 0, thickness_sd_m = 0;
  double normal_error = 0, normal_error_sd = 0;
  double velocity_bias_m_per_s = 0, velocity_sd_m_per_s = 0;  // mean and scatter of v_hat_j - v_{j-1}
  double margin_sd_m = 0;  // scatter of the margin of (4.17), whose terms above are correlated
  double gain = 1;         // fraction of a velocity error that one update corrects, see below
};

// A bound that accounts for scatter. (4.18) requires a margin above 0 at every update:
//   G_j = r_1 + h + v_hat_j (1 - e_n) / f_c - v_j / f_c,
// and h, e_n and v_hat_j scatter. With the mean and variance of G_j at every update, a lift survives with
// probability prod_j Phi(E G_j / sqrt(Var G_j)). The inputs, all from lifts without acceleration:
//
// - E v_hat_j follows the velocity with a gain g: E v_hat_{j+1} = E v_hat_j + g (v_j - E v_hat_j). g is 1
//   minus the correlation of the error of v_hat between updates, which is right if that error is
//   autoregressive of first order.
// - As in (4.19), v_hat is assumed correct in the mean at constant velocity. In fact noise makes it too high
//   by velocity_bias, which is about as large as its scatter. The bound does not use that.
// - Var G_j = Var G at rest + Var h + ((E v_hat_j)^2 - v_0^2) Var e_n / f_c^2. The second term is the
//   scatter of the new frame: its points, not the true plane, decide whether the proxy stays above. The
//   third is the scatter of the normal at higher velocity.
// - e_n is assumed the same at every velocity, G_j normal, and updates independent. In accelerating lifts
//   with much noise e_n is larger, and updates share the error of v_hat.
//
// Not using the bias makes the bound too low at little noise; at much noise, where e_n grows, it is about
// right. The figure "bounds" shows predicted and observed survival.
//
// NaN if a part of the noise that it needs is NaN.
double survival_probability(const Lift& lift, const NoiseEffect& noise, double acceleration);
// The acceleration at which the survival probability is one half; 0 if it is less at rest. NaN if it is NaN,
// or if more lifts survive at any acceleration.
double scatter_bound(const Lift& lift, const NoiseEffect& noise);

// The quantities of 4.4 at each update of a cloud that moves along a known normal.

// Update j, when frame j replaces frame j - 1. Metres, seconds; heights are along the true normal n.
struct LiftUpdate {
  int frame = 0;                  // j
  double velocity_m_per_s = 0;    // v_j: how far the plane moved, times f_c
  double estimate_m_per_s = 0;    // v_hat_j, with which (4.3) moves the proxy
  double thickness_m = 0;         // h_{j-1} = (P - plane).n - r_1 at the end of frame j - 1
  double normal_error = 0;        // e_n = 1 - n.n_hat_{k-1}, (4.22)
  double frame_correction_m = 0;  // v_hat_j n.n_hat_{k-1} / f_c: how far (4.3) moved the proxy along n
  bool above_before = false;      // the proxy's centre was above the plane at the end of frame j - 1
  bool above_after = false;       // and at the end of frame j

  // r_1 + h_{j-1} + frame_correction - v_j / f_c, the margin of (4.17) and (4.18): below 0 the criterion
  // predicts a pop-through. It is the height of the corrected proxy over the new plane.
  double margin_m(double r1_m, double frame_rate_hz) const {
    return r1_m + thickness_m + frame_correction_m - velocity_m_per_s / frame_rate_hz;
  }
};

// Returns every update in the trace after the first frame. pre: signed_distance is that to the newest frame's
// plane.
std::vector<LiftUpdate> lift_updates(const Trace& trace, const Vec3& normal, double r1_m,
                                     double frame_rate_hz);

// The effect of noise on the quantities of 4.4, measured over lifts without acceleration.

// Updates up to this frame are not used, because the velocity estimate starts at 0 when the cloud meets the
// proxy.
struct SettledFrom {
  int frame = 0;
};

// Computes means and scatter over the updates of all lifts of one noise strength before which the proxy was
// still above the plane. The means are NaN without such an update, the scatter and the gain with fewer than
// two.
NoiseEffect noise_effect(const std::vector<std::vector<LiftUpdate>>& lifts, SettledFrom settled, double r1_m,
                         double frame_rate_hz);

// Means of one lift: one observation, independent of other lifts. NaN if no update counts.
struct LiftMeans {
  double thickness_m, normal_error;
};
LiftMeans lift_means(const std::vector<LiftUpdate>& lift, SettledFrom settled);

}  // namespace remote_touch
