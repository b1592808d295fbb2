// The largest stiffness of a renderer at which no oscillation of a hand on a plane grows, by bisection.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "analysis/theory/haptic_loops.h"
#include "runners/evaluation/figures/parts/figure_context.h"

namespace remote_touch {

// A stiffness along the normal of the plane, N/m, or of the rotation of a tool that lies on it, N m/rad.
class WallLimit {
 public:
  // experiment: a run in which the hand rests on a plane from 1.6 s on, until 3.6 s, rendered with the given
  // stiffness. wall: the linear wall of theory; the search is from 0.4 to 2.5 times the limit of its law.
  WallLimit(std::function<Experiment(double stiffness)> experiment, const SampledWall& wall)
      : expected_(wall_law_N_per_m(wall)),
        exact_(exact_wall_limit_N_per_m(wall)),
        experiment_(std::move(experiment)),
        stable_(0.4 * expected_),
        unstable_(2.5 * expected_) {}

  double expected() const { return expected_; }  // limit of the law
  double exact() const { return exact_; }
  double middle() const { return std::sqrt(stable_ * unstable_); }
  double ratio() const { return middle() / expected_; }
  double exact_ratio() const { return middle() / exact_; }

 private:
  friend void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);
  double expected_, exact_;
  std::function<Experiment(double)> experiment_;
  double stable_, unstable_;
};

// Makes seven steps for all limits together; they are then known to 1.4 %.
void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);

// The largest stiffness at which a hand that rests on a plane with noise stays calm.

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
