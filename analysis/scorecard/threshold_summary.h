// Measures of a scorecard's methods, compared with the published thresholds of perception.
#pragma once

#include <string>
#include <vector>

#include "analysis/measures/force_measures.h"
#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// Number of runs of one method whose measure is below its threshold, over all scenes that report the measure.
// Only successful runs in which the measure is a number count: a run that lost the surface has no force to
// compare. Runs that are one and the same count once, as in Proportion.
struct ThresholdCounts {
  int scenes = 0;           // scenes with at least one such run with noise
  int below = 0, runs = 0;  // runs with noise, a scene's own included
  int noise_free_below = 0, noise_free_runs = 0;
};

struct ThresholdSummary {
  PerceptionThreshold threshold;
  std::vector<ThresholdCounts> methods;  // one for each method of the card
};

// Returns the thresholds that any scene of the card has, in the order of perception_thresholds().
std::vector<ThresholdSummary> threshold_summary(const Scorecard& card);

// Table "thresholds" of a result, with a row for each threshold and method.
Table thresholds_table(const Scorecard& card);

}  // namespace remote_touch
