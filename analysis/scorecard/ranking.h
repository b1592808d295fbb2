// Methods in the order of a measure, and which of the best and worst are significantly different from all
// others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/paired_test.h"

namespace remote_touch {

enum class Better { larger, smaller, near_zero, reported };  // reported: neither end is better

// One method's values of a measure. values[i][k]: of noise level i and replicate k, which met the same
// noise with every method; NaN where there is none.
using PairedValues = std::vector<std::vector<double>>;

// Of the levels of one method: are its replicates one run, done again and again, as without noise? Then
// they count once. Empty: at no level.
using Repeats = std::vector<bool>;
PairedValues distinct(const PairedValues& values, const Repeats& repeats);

// With fewer there is no verdict about a measure that is no event: of so many pairs without a difference all
// differ to the same side, which no draw from them undoes, once in 32 times. Shares have their intervals'
// width.
inline constexpr std::int64_t kMinPairs = 6;

struct Ranking {
  std::vector<std::size_t> order;    // methods, the best first by their own means; without a place last
  std::size_t ranked = 0;            // so many of them have kMinPairs values; of an event, any
  std::vector<MeanDifference> mean;  // of each method, with its interval
  // The intervals of the paired differences to all others that are placed lie on the side that the order
  // claims: of the first, and of the last that is placed.
  bool has_best = false, has_worst = false;
  // The first, and those that the pairs do not show it to be better than.
  std::vector<std::size_t> top_group;
};

// event: values are 0 and 1, and the difference of two shares has Agresti and Min's interval, for a bootstrap
// of few equal pairs has none. Other measures are compared over the pairs in which both have a number, and
// not with fewer than kMinPairs: give no number where a run did not do what the measure is about. A level
// that is one run of both methods is one pair. near_zero compares magnitudes. repeats: of each method;
// empty: of none.
Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event, std::uint64_t key,
                const std::vector<Repeats>& repeats = {});

}  // namespace remote_touch
