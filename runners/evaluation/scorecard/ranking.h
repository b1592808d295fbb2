// Methods ranked by a measure, and whether the first and the last differ significantly from all others.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"

namespace remote_touch {

// One method's values of a measure. values[i][k] belongs to noise level i and replicate k, which has the same
// noise for every method; NaN if there is none.
using PairedValues = std::vector<std::vector<double>>;

// The runs of one method that are not independent of each other.
struct SharedRuns {
  // True for each noise level whose replicates are all one and the same run, as without noise. They then
  // count once. An empty list means that no level repeats.
  std::vector<bool> repeats = {};
  // True if a random number is drawn for each replicate, as the error of the registration is, and not for
  // each level and replicate: the runs of a replicate are then one cluster.
  bool by_replicate = false;
};
PairedValues distinct(const PairedValues& values, const SharedRuns& shared);
// Returns the values that are not NaN as independent clusters. A cluster has one value, or all values of a
// replicate if shared.by_replicate.
std::vector<std::vector<double>> clusters_of(const PairedValues& values, const SharedRuns& shared);
// Fraction of the values that are 1.
Estimate fraction_of(const std::vector<std::vector<double>>& clusters);
// Mean of the values, see estimated_mean(); of the clusters' means if runs are shared by replicate.
Estimate mean_of(const PairedValues& values, const SharedRuns& shared);

// Minimum number of pairs for a verdict, and of values of a measure for a rank by it.
inline constexpr std::int64_t kMinPairs = 12;
// A difference is more than chance if the p value, corrected for all comparisons of the card, is at most
// this.
inline constexpr double kSignificance = 0.05;

// Comparison of one method with another, over the pairs in which both have a number.
struct MethodComparison {
  double p = std::numeric_limits<double>::quiet_NaN();  // two-sided; NaN: fewer than kMinPairs
  bool has_better_mean = false;                         // true: the first is better in the mean of the pairs
  bool is_skewed = false;                               // few large differences decide: no verdict

  bool shows_better() const { return has_better_mean && !is_skewed && p <= kSignificance; }
};

struct Ranking {
  std::vector<std::size_t> order;  // methods, the best first by their own means; unranked ones last
  std::size_t ranked = 0;          // number of methods with kMinPairs values, or any value of an event
  std::vector<Estimate> mean;      // mean of each method
  // [a][b]: of method a with b. Empty for a measure that is only reported.
  std::vector<std::vector<MethodComparison>> against = {};
  // has_best: the first is better than all other ranked methods. has_worst: all of them are better than the
  // last. Each difference must be more than chance.
  bool has_best = false, has_worst = false;
  // The first, and the methods that it is not shown to be better than.
  std::vector<std::size_t> top_group = {};
};

// event: true if all values are 0 or 1. Two methods are then compared by estimated_event_difference(), else
// by estimated_difference(). A pair counts if both methods have a number: use NaN if a run did not do what is
// measured. A level at which both methods repeat one run is one pair. near_zero compares magnitudes. shared:
// one entry for each method; empty if no method shares runs.
Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event,
                const std::vector<SharedRuns>& shared = {});

// Corrects the p values of all these rankings together by Holm's method, and decides anew. The probability
// that any "better" among them is due to chance is then at most kSignificance. Returns the number of tests.
std::int64_t correct_together(const std::vector<Ranking*>& rankings);

}  // namespace remote_touch
