// The largest stiffness of a renderer at which no oscillation of a hand on a plane grows, by bisection.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

// The limit of a linear wall without damping of its own: K T / 2 + K d = b, with the tick T of 1 ms, the
// delay d and the damping b of device and hand. N/m for a damping in N s/m; N m/rad for one in N m s/rad.
double linear_wall(double damping, int delay_ticks);

// A stiffness along the normal of the plane, N/m, or of the rotation of a tool that lies on it, N m/rad.
class WallLimit {
 public:
  // experiment: a run in which the hand rests on a plane from 1.6 s on, until 3.6 s, rendered with the given
  // stiffness. expected: the limit of theory; the search is from 0.4 to 2.5 times this.
  WallLimit(std::function<Experiment(double stiffness)> experiment, double expected)
      : expected_(expected),
        experiment_(std::move(experiment)),
        stable_(0.4 * expected),
        unstable_(2.5 * expected) {}

  double expected() const { return expected_; }
  double middle() const { return std::sqrt(stable_ * unstable_); }
  double ratio() const { return middle() / expected_; }

 private:
  friend void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);
  double expected_;
  std::function<Experiment(double)> experiment_;
  double stable_, unstable_;
};

// Makes seven steps for all limits together; they are then known to 1.4 %.
void bisect(FigureContext& context, const std::vector<WallLimit*>& limits);

}  // namespace remote_touch
