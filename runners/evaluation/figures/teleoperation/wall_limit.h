// The largest stiffness of a renderer at which no oscillation of a hand on a plane grows, by bisection.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

// The limit of a linear wall without damping of its own, N/m: K T / 2 + K d = b, with the tick T of 1 ms, the
// delay d and the damping b of device and hand.
double linear_wall_N_per_m(double damping_Ns_per_m, int delay_ticks);

class WallLimit {
 public:
  // experiment: a run in which the hand rests on a plane from 1.6 s on, until 3.6 s, rendered with the given
  // stiffness, N/m. expected_N_per_m: the limit of theory; the search is from 0.4 to 2.5 times this.
  WallLimit(std::function<Experiment(double stiffness_N_per_m)> experiment, double expected)
      : expected_N_per_m(expected),
        experiment_(std::move(experiment)),
        stable_N_per_m_(0.4 * expected),
        unstable_N_per_m_(2.5 * expected) {}

  const double expected_N_per_m;
  double middle_N_per_m() const { return std::sqrt(stable_N_per_m_ * unstable_N_per_m_); }
  double ratio() const { return middle_N_per_m() / expected_N_per_m; }

 private:
  friend void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);
  std::function<Experiment(double)> experiment_;
  double stable_N_per_m_, unstable_N_per_m_;
};

// Makes seven steps for all limits together; they are then known to 1.4 %.
void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);

}  // namespace remote_touch
