// Methods ranked by a measure, and whether the first and the last differ significantly from all others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/paired_test.h"

namespace remote_touch {

enum class Better { larger, smaller, near_zero, reported };  // reported: neither end is better

// One method's values of a measure. values[i][k]: of noise level i and replicate k, which has the same noise
// for every method; NaN if there is none.
using PairedValues = std::vector<std::vector<double>>;

// For each noise level of one method: whether all its replicates are one and the same run, as without noise.
// They then count once. Empty: at no level.
using Repeats = std::vector<bool>;
PairedValues distinct(const PairedValues& values, const Repeats& repeats);

// With fewer pairs there is no verdict on a measure that is not an event: even without a true difference, six
// pairs all differ in the same direction once in 32 times, and no bootstrap draw shows that. The intervals of
// fractions widen by themselves.
inline constexpr std::int64_t kMinPairs = 6;

struct Ranking {
  std::vector<std::size_t> order;    // methods, the best first by their own means; unranked ones last
  std::size_t ranked = 0;            // number of ranked methods: with kMinPairs values; of an event, any
  std::vector<MeanDifference> mean;  // of each method, with its interval
  // Whether the intervals of the paired differences to all other ranked methods exclude 0 in the order's
  // direction: for the first, and for the last ranked method.
  bool has_best = false, has_worst = false;
  // The first, and those that it is not significantly better than.
  std::vector<std::size_t> top_group;
};

// event: values are 0 and 1, and the difference of two fractions has Agresti and Min's interval, because the
// bootstrap of a few equal pairs gives none. Other measures are compared over the pairs in which both have a
// number, and only with kMinPairs or more: use NaN if a run did not do what is measured. A level at which
// both methods repeat one run is one pair. near_zero compares magnitudes. repeats: of each method; empty: of
// none.
Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event, std::uint64_t key,
                const std::vector<Repeats>& repeats = {});

}  // namespace remote_touch
