// Tests and intervals for pairs: two versions of a run with the same noise.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

// Root mean square, without overflow or underflow of the squares; 0 for an empty list. pre: no NaN.
double root_mean_square(const std::vector<double>& values);

// Exact two-sided sign test: the probability of a split at least as uneven as plus against minus if every
// differing pair goes either way with probability 1/2. On the discordant pairs of an event it is the exact
// form of McNemar's test (Q. McNemar, Psychometrika 12 (1947), 153-157). Returns 1 if no pair differs. The
// relative error is below 1e-10 for counts up to 1e7 each; a result below about 1e-300 is returned as 0. It
// uses only +, -, * and /, so every machine computes the same bits. pre: plus, minus >= 0.
double sign_test(std::int64_t plus, std::int64_t minus);

// Mean of paired differences of clusters, with a test that it is 0. Those that are not finite are unknown.
// - Fewer than 6 differences: the interval of estimated_mean(), and no p.
// - 6 to 16: the exact test by sign flips (R. Fisher, The Design of Experiments, 1935), which assumes that a
//   difference is as likely as its opposite; the ends of the interval are means of subsets of the differences
//   (J. Hartigan, J. Am. Stat. Assoc. 64 (1969), 1303-1317).
// - More: Student's t; p is at least 2^(1 - n), which an exact test of n pairs can reach.
// If all differences are 0, p is 1. If all are equal, there is no interval, but a note. Numbers that differ
// by less than 1e-9 of the sum of all magnitudes count as equal. is_skewed is true, with a note, if p <= 0.05
// but the interval of estimated_mean() holds 0.
Estimate estimated_difference(const std::vector<double>& differences);

// The outcomes of an event in the two runs of a pair: 1, 0, or NaN if unknown.
struct OutcomePair {
  double first = 0, second = 0;
};
// Difference of the fractions of an event, second minus first. Each element has the pairs of one cluster. If
// each cluster has one pair: the exact sign test of the pairs that differ, and the interval of T. Tango
// (Statistics in Medicine 17 (1998), 891-908), extended to 0 if p > 0.05; no p below 6 pairs. Otherwise the
// clusters' means are compared as numbers. The value is that of the known pairs. With unknown outcomes, the
// interval is the hull of those of both extreme assignments of them, and p the larger one; it is 1 if the two
// differences have different signs.
Estimate estimated_event_difference(const std::vector<std::vector<OutcomePair>>& clusters);

// p values of tests made together, adjusted so that the probability of any false "adjusted < alpha" is at
// most alpha, whatever their dependence (S. Holm, Scand. J. Stat. 6 (1979), 65-70). Returned in the given
// order; none is below its own p. NaN: there was no test; it does not count, and stays NaN. pre: the others
// are within [0, 1].
std::vector<double> holm_adjusted(const std::vector<double>& p);
// Returns the number of tests among them: of the p values that are not NaN.
std::int64_t tests_among(const std::vector<double>& p);
// The fewest pairs whose exact test can reach an adjusted p of alpha in a family of this many tests: with n
// pairs, the least p is 2^(1 - n).
std::int64_t pairs_for_family(std::int64_t tests, double alpha = 0.05);

}  // namespace remote_touch
