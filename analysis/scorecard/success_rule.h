// Success of a run: bounds on its measures, all of which must hold.
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

// Returns for each run whether all bounds hold; false for runs that failed. Throws std::out_of_range for a
// measure that the sweep does not have. pre: no run is pending.
std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds);

// Returns the run that is a typical failure of a cell: the median of its unsuccessful runs, ordered by the
// first bound that they break and then by the value of its measure, with runs that ended in an error last. -1
// if no run is unsuccessful.
long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell);

}  // namespace remote_touch
