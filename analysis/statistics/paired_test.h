// Tests and intervals for pairs: two versions of a run with the same noise.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/statistics/proportion.h"

namespace remote_touch {

// Root mean square, without overflow or underflow of the squares; 0 for an empty list. pre: no NaN.
double root_mean_square(const std::vector<double>& values);

// Exact two-sided sign test: the probability of a split at least as uneven as plus against minus if every
// differing pair goes either way with probability 1/2. On the discordant pairs of an event it is the exact
// form of McNemar's test (Q. McNemar, Psychometrika 12 (1947), 153-157). Returns 1 if no pair differs. The
// relative error is below 1e-10 for counts up to 1e7 each; a result below about 1e-300 is returned as 0. It
// uses only +, -, * and /, so every machine computes the same bits. pre: plus, minus >= 0.
double sign_test(std::int64_t plus, std::int64_t minus);

// A test of the same null hypothesis, that a difference is as likely as its opposite, by the sum of the
// differences: it detects a few large differences one way among many small ones both ways, which the sign
// test does not detect. Returns Hoeffding's upper bound of p, min(1, 2 exp(-(sum d)^2 / (2 sum d^2))), not
// the exact p. The bound holds for any number of pairs and any distribution (W. Hoeffding, J. Am. Stat.
// Assoc. 58 (1963), theorem 2). Returns 1 if all differences are 0. pre: all finite.
double symmetry_test(const std::vector<double>& differences);

// Interval of a difference of two proportions counted on the same pairs, (plus - minus) / pairs: Wald's
// interval after adding 1/2 to each of the four cells, clamped to [-1, 1] (A. Agresti, Y. Min, Statistics in
// Medicine 24 (2005), 729-740, "Wald+2"). [-1, 1] if there are no pairs. z: two-sided quantile of the
// confidence.
// pre: plus, minus >= 0, plus + minus <= pairs.
std::pair<double, double> paired_difference_interval(std::int64_t plus, std::int64_t minus,
                                                     std::int64_t pairs, double z = kTwoSided95);

// Mean of the differences and its 95 % interval as if the mean were normal, in the unit of the differences.
// The mean is NaN without pairs; the interval is NaN with fewer than two pairs.
struct MeanDifference {
  std::int64_t pairs = 0;
  double mean = 0, low = 0, high = 0;
};
// Uses the sum of the differences and half the width of the interval; NaN: there is no interval.
MeanDifference mean_of_sum(double sum, std::int64_t pairs,
                           double half_width = std::numeric_limits<double>::quiet_NaN());
// NaN differences are skipped and not counted as pairs.
MeanDifference mean_difference(const std::vector<double>& differences);

// p values of tests made together, adjusted so that the probability of any false "adjusted < alpha" is at
// most alpha, whatever their dependence (S. Holm, Scand. J. Stat. 6 (1979), 65-70). Returned in the given
// order; none is below its own p. pre: all within [0, 1].
std::vector<double> holm_adjusted(const std::vector<double>& p);

}  // namespace remote_touch
