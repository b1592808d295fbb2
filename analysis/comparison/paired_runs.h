// One measure in the same runs of two sweeps, and what the paired tests say of it.
#pragma once

#include <vector>

#include "analysis/comparison/sweep_comparison.h"

namespace remote_touch {

using Runs = std::vector<std::size_t>;  // rising

struct Pairs {
  const std::vector<double>&baseline, &candidate;
  Tolerance tolerance;
  Better better = Better::neither;
  bool event = false;                   // then a candidate's value that is neither 0 nor 1 has no partner
  std::vector<bool> same_outcome = {};  // runs of equal outcome; only these get better or worse. Empty: all

  bool finite(std::size_t run) const;
  bool equal(std::size_t run) const { return within(tolerance, baseline[run], candidate[run]); }
  // equal, better, worse or changed
  Judgement judged(std::size_t run) const;
};

// All of MeasureComparison but the names and, where runs went both ways, the judgement.
MeasureComparison compare_values(const Pairs& pairs, const Runs& runs);

// The tests of a region, not yet adjusted and without a judgement.
RegionComparison tested(const Pairs& pairs, const Runs& runs);

// pre: adjusted_p is set.
Judgement judgement_by_pairs(const RegionComparison& region, const MeasureComparison& measure,
                             const PairedRule& rule);

}  // namespace remote_touch
