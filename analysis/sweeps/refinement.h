// Adaptive refinement of a sweep: more runs where the probability of an event is uncertain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

struct RefinementRule {
  std::string measure = "popped_through";
  double threshold = 0.5;            // the event happens when the measure is above this
  std::uint64_t budget = 0;          // total number of runs, including the first round
  int first_replicates = 1;          // replicates of a newly sampled cell; also the number that a round adds
  std::vector<std::size_t> strides;  // strides of the first round's cells along each axis, powers of two
};

// Returns the runs that the next round adds. They depend on the finished runs alone, so every continuation
// adds the same ones. A cell is uncertain while a score test does not tell its probability from 0.5, with the
// less favourable assignment of unknown outcomes: |events - n / 2| < 1.96 sqrt(n) / 2 (Wilson's interval). An
// uncertain cell is given more replicates, up to the maximum. If one of two neighbouring cells is uncertain,
// or if they lie on different sides of 0.5, the cell half way between them is sampled. Cells with the fewest
// runs come first. Empty if no cell is uncertain, or if the budget is spent. Because runs are added depending
// on earlier results, the intervals cover a little less than their nominal level. pre: no run is pending.
std::vector<std::size_t> next_round(const SweepResult& result, const RefinementRule& rule);

}  // namespace remote_touch
