// The tally of one measure in the runs of a cell.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "analysis/tally/quantile_sketch.h"
#include "analysis/tally/unrounded_sum.h"

namespace remote_touch {

// Equal values in any order, and in any parts that are added to each other, give equal bits.
struct MeasureTally {
  std::int64_t values = 0;    // number of finite values; least, greatest, sums and sketch are of these only
  std::int64_t unknown = 0;   // NaN
  std::int64_t infinite = 0;  // infinity of either sign
  double least = std::numeric_limits<double>::infinity();  // infinity and -infinity without values
  double greatest = -std::numeric_limits<double>::infinity();
  UnroundedSum sum,
      squares;  // sums of the values and of their squares; add_square() states the range of the latter
  QuantileSketch sketch;

  void add(double value);  // any double; -0 counts as 0
  void add(const MeasureTally& other);

  // Returns the rounded sum divided by the number of values; NaN without values.
  double mean() const;
  // Returns (n sum of squares - (sum)^2) / (n (n - 1)). The numerator is rounded once, so nothing cancels.
  // NaN with fewer than two values, or if the sum or the sum of squares is above the largest double (values
  // of 1e154). Deviations below 1e-146 are lost.
  double variance() const;
  double standard_deviation() const;
  // Returns the quantile of QuantileSketch, clipped to least .. greatest. It differs by at most 1.6 % from
  // the value that it approximates, x_k of the sorted values. p = 0 gives least and p = 1 greatest. NaN
  // without values.
  double quantile(double p) const;

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the extremes are outside the
  // sketch"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const MeasureTally&) const = default;
};

}  // namespace remote_touch
