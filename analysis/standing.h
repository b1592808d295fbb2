// Contenders in order of a measure, and who at the ends of that order is told apart from the next one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/paired_test.h"

namespace remote_touch {

enum class Better { larger, smaller, near_zero, reported };  // reported: neither end is better

// One contender's values of a measure. values[i][k]: of noise level i and replicate k, which met the same
// noise with every contender; NaN where there is none.
using PairedValues = std::vector<std::vector<double>>;

struct Standing {
  std::vector<std::size_t> order;    // contenders, the best first; those without any value at the end
  std::size_t placed = 0;            // so many of them have a value
  std::vector<MeanDifference> mean;  // of each contender, with its interval
  // The interval of the paired difference to the next one in the order excludes zero: of the first, and of
  // the last that is placed.
  bool has_best = false, has_worst = false;
  // Those at the top, the first among them, that the first is not told apart from.
  std::vector<std::size_t> at_the_top;
};

// event: values are 0 and 1, and the difference of two shares has Agresti and Min's interval, for a bootstrap
// of few equal pairs has none. Other measures are compared over the pairs in which both have a number, which
// favours who has none in hard runs: read them beside the share of successes. near_zero compares magnitudes.
Standing standing(const std::vector<PairedValues>& contenders, Better better, bool event, std::uint64_t key);

}  // namespace remote_touch
