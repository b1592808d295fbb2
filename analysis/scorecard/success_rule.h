// What counts as a success of a run: bounds that all its measures keep.
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

// For each run: did it keep all bounds? Runs that failed did not. Throws std::out_of_range for a measure that
// the sweep has not. pre: no run is pending.
std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds);

// The run in the middle of those of a cell that were no success, by the measure of the first bound that they
// break, runs that ended with an error last: a typical failure. -1: there is none.
long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell);

}  // namespace remote_touch
