// When a lifted cloud passes the proxy: the bounds of 4.4.
//
// Definitions: v_hat is the velocity estimate, taken to be right, v_hat_j = v_{j-1} (4.19); n_hat the
// estimated and n the true normal; h the thickness of the cloud, h = (P - plane).n - r_1; e_n = 1 - n.n_hat
// (4.22).
#pragma once

#include <vector>

namespace remote_touch {

// A lift as in 4.3.2: velocity v_0, then `updates` updates with acceleration a.
struct Lift {
  double r1_m = 0;
  double frame_rate_hz = 0;
  double start_velocity_m_per_s = 0;
  int updates = 10;
};

// (4.14), noise-free: no pop-through below this acceleration, r_1 f_c^2.
double critical_acceleration(const Lift& lift);
// (4.20): the velocity estimate at the last update, v_0 + (updates - 1) a / f_c.
double highest_velocity(const Lift& lift, double acceleration);
// (4.21), (4.25) solved for a: the acceleration at which r_1 + h = a / f_c^2 + v_hat e_n / f_c, with (4.20).
double bound_acceleration(const Lift& lift, double thickness_m, double normal_error);

// The printed fits for sigma from 0 to 2 r_c, and how far they may be off because their coefficients are
// printed with two digits: half a unit of the last digit of each, added up.
struct PrintedFit {
  std::vector<int> powers;
  std::vector<double> coefficients, half_digits;
  double at(double sigma_m) const;
  double digits_band(double sigma_m) const;
};
const PrintedFit& printed_thickness();     // (4.23)
const PrintedFit& printed_normal_error();  // (4.24)

// What noise of one strength does to the quantities of (4.18): means and standard deviations over lifts
// without acceleration.
struct NoiseEffect {
  double thickness_m = 0, thickness_sd_m = 0;
  double normal_error = 0, normal_error_sd = 0;
  double velocity_bias_m_per_s = 0, velocity_sd_m_per_s = 0;  // of v_hat_j - v_{j-1}
  double gain = 1;  // the share of a velocity error that one update corrects: 1 - autocorrelation of v_hat
};

// The bound that accounts for scatter. (4.18) asks at every update for a margin above 0. Written with its
// random parts, the margin at update j is
//   G_j = r_1 + h + v_hat_j (1 - e_n) / f_c - v_j / f_c,
// where h, e_n and v_hat_j scatter. As in (4.19) v_hat is taken to be unbiased, but it follows the true
// velocity with the measured gain g: E v_hat_{j+1} = E v_hat_j + g (v_j - E v_hat_j). Whether the proxy stays
// above is decided by the points of the frame that comes, whose height scatters as h does. With independent
// parts
//   Var G_j = 2 Var h + (1 - e_n)^2 Var v_hat / f_c^2 + (E v_hat_j)^2 Var e_n / f_c^2,
// and with G_j taken as normal and the updates as independent, the lift survives with probability
//   prod_j Phi(E G_j / sqrt(Var G_j)).
double survival_probability(const Lift& lift, const NoiseEffect& noise, double acceleration);
// The acceleration at which that is one half.
double scatter_bound(const Lift& lift, const NoiseEffect& noise);

}  // namespace remote_touch
