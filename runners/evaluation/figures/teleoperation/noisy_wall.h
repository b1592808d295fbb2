// The largest stiffness at which a hand that rests on a plane with noise stays calm.
#pragma once

#include <vector>

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

// A hand without damping rests 2.4 mm deep on a plane that a proxy renders at 30 Hz from noisy points, on a
// device with the damping b. The noise moves the rendered plane in every frame, so the hand always moves, and
// no oscillation grows for ever below the limit K* = b / (T / 2) of a linear wall. The limit here is the
// largest stiffness at which the motion of the hand is calm: not more than kCalm_m in root mean square, which
// is a sixth of the depth, so that the contact hardly ever opens.
//
// Theory: the height of the rendered plane has the standard deviation s and a new value in every frame
// interval D, and the spring of the hand has a quarter of the stiffness K. So the hand of mass m has the
// natural frequency w = sqrt(1.25 K / m) and the damping b (1 - K / K*), because the hold feeds it. A weakly
// damped oscillator that is driven by K times these steps has the variance
//   s^2 K D q^2 / (2.5 b (1 - K / K*)), q = sin(w D / 2) / (w D / 2).
struct NoisyWall {
  static constexpr double kCalm_m = 4e-4;
  double noise_m;                                      // standard deviation of the points along their rays
  double plane_noise_m = 0;                            // s, measured
  double expected_N_per_m = 0, stiffness_N_per_m = 0;  // the limit: theory, and found by bisection
};

// Makes the runs for each noise, with four seeds each. They share the steps of the bisection, after which the
// limits are known to 1.4 %, but for the chance of the noise.
std::vector<NoisyWall> noisy_walls(FigureContext& context, const std::vector<double>& noise_m);

}  // namespace remote_touch
