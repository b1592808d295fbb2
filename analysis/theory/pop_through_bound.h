// The bounds of 4.4 on the acceleration with which a cloud can be lifted before it passes the proxy.
//
// Definitions: v_hat is the velocity estimate, assumed correct, v_hat_j = v_{j-1} (4.19); n_hat the estimated
// and n the true normal; h the thickness of the cloud, h = (P - plane).n - r_1; e_n = 1 - n.n_hat (4.22).
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

}  // namespace remote_touch
