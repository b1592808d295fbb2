// What counts as success of a run: bounds on its measures, all of which must hold.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

struct Bound {
  std::string measure;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= min && value <= max; }  // never for NaN
};

// For each run whether all bounds hold; false for runs that failed. Throws std::out_of_range for a measure
// that the sweep does not have. pre: no run is pending.
std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds);

// A typical failure of a cell: the median of its unsuccessful runs, ordered by the first bound that they
// break and its measure, runs that ended with an error last. -1: there is none.
long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell);

}  // namespace remote_touch
