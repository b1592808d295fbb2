// One measure in the same runs of two sweeps, and the results of its paired tests.
#pragma once

#include <vector>

#include "analysis/comparison/sweep_comparison.h"
#include "analysis/sweeps/cell_streams.h"

namespace remote_touch {

using Runs = std::vector<std::size_t>;  // increasing

struct Pairs {
  const std::vector<double>&baseline, &candidate;
  Tolerance tolerance;
  Better better = Better::neither;
  bool event = false;                // true: a candidate's value other than 0 and 1 has no partner
  std::vector<bool> is_judged = {};  // runs that may get better or worse. Empty: all

  bool finite(std::size_t run) const;
  bool equal(std::size_t run) const { return within(tolerance, baseline[run], candidate[run]); }
  // equal, better, worse or changed
  Judgement judge_run(std::size_t run) const;
};

// Sets all of MeasureComparison except the name and the units. If runs went both ways, run_by_run is
// undecided until the paired tests are known.
MeasureComparison compare_values(const Pairs& pairs, const Runs& runs);

// Computes the tests of a region. Their p values are not yet adjusted, and there is no judgement yet.
// Clusters that draw no random numbers are counted, but not tested.
RegionComparison paired_tests(const Pairs& pairs, const std::vector<RunCluster>& clusters);

// pre: adjusted_p is set.
Judgement judgement_by_pairs(const RegionComparison& region, const MeasureComparison& measure,
                             const PairedRule& rule);

}  // namespace remote_touch
