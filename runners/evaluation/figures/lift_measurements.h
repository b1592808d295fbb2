// Measurements over lifts for the figure "bounds".
#pragma once

#include <vector>

#include "analysis/statistics/curve_fits.h"
#include "analysis/theory/pop_through_limits.h"
#include "runners/evaluation/figures/figures.h"

namespace remote_touch {

using LiftUpdates = std::vector<LiftUpdate>;

// (4.14): critical accelerations without noise, over 8 x 8 positions of the grid under the proxy, by
// bisection between kSurvives and kPops; and the fractions of lifts that survived at these two.
struct Phases {
  static constexpr double kSurvives = 4.3, kPops = 4.6;  // m/s^2
  Table table{"phases", "critical acceleration without noise, by position of the grid"};
  double survived_low = 0, survived_high = 0;
};
Phases critical_over_phases(FigureContext& context);

// (4.19) to (4.24): the effect of noise, from lifts without acceleration, and fits up to kFitted_m.
inline constexpr double kFitted_m = 0.01;
struct MeasuredNoise {
  std::vector<double> sigma_m;
  std::vector<NoiseEffect> effect;  // one for each of sigma_m
  PolynomialFit thickness, normal_error;

  NoiseEffect at(double noise_m) const;  // linear between the measured strengths
};
MeasuredNoise measured_noise(FigureContext& context);
Table effect_table(const MeasuredNoise& noise);

// The map of Fig 4.13 with the noise of another seed: every update of every lift, and which lifts survived.
struct LiftMap {
  Table map;  // noise, acceleration, survived
  std::vector<LiftUpdates> updates;
};
LiftMap lift_map(FigureContext& context, int seed);

}  // namespace remote_touch
