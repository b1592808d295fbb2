// Agreement of the bounds of 4.4 with the simulated lifts.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runners/evaluation/figures/lift_measurements.h"

namespace remote_touch {

// Number of updates by whether (4.17) holds and by their outcome: the proxy stays above the plane, or pops
// through. (4.18) is the same criterion, rewritten for a cloud that moves along its normal.
struct Criterion {
  double holds_stays = 0, holds_pops = 0, fails_stays = 0, fails_pops = 0;
  double agreement() const {
    return (holds_stays + fails_pops) / (holds_stays + holds_pops + fails_stays + fails_pops);
  }
};
// Counts the updates during the acceleration, until the proxy is below the plane, in lifts with noise in
// [low, high), r_c.
Criterion criterion_of(const LiftMap& lifts, double low, double high);
// The criterion for several ranges of noise.
Table criterion_table(const LiftMap& lifts);

// A bound as a function of the noise, m/s^2. It keeps a reference to the MeasuredNoise it was made from.
struct AccelerationBound {
  std::string name, meaning;
  std::function<double(double noise_m)> at;
  double max_noise_m = 1;  // the curve ends here: fits are not valid beyond it
};
std::vector<AccelerationBound> bounds(const MeasuredNoise& noise);

// Agreement over the cells with noise up to a limit (r_c).
struct Agreement {
  int cells = 0, agree = 0;
  double safe_popped = 0, unsafe_survived = 0;  // fractions of the bound's safe and unsafe cells
  double fraction() const { return static_cast<double>(agree) / cells; }
};
Agreement agreement_of(const AccelerationBound& bound, const Table& map, double max_noise = 4);
Table agreement_table(const std::vector<AccelerationBound>& bounds, const Table& map);

// Predicted and observed survival, by ranges of both noise and prediction. Columns have the suffix of the
// range of noise.
Table calibration_table(const MeasuredNoise& noise, const Table& map);

// The ranges of noise: suffix of the columns, words for readers.
inline constexpr std::pair<const char*, const char*> kNoiseRanges[] = {
    {"to_1_rc", "noise to r_c"}, {"to_2_rc", "r_c to 2 r_c"}, {"to_3_rc", "2 r_c to 3 r_c"}};

}  // namespace remote_touch
