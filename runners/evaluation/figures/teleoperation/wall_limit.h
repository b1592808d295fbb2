// The largest stiffness of a renderer at which no oscillation of a hand on a plane grows, by bisection.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "analysis/theory/haptic_loops.h"
#include "runners/evaluation/figures/context/figure_context.h"

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

}  // namespace remote_touch
