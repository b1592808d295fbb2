// Interval of the mean difference of pairs, without an assumption about its distribution: the percentile
// bootstrap (B. Efron, Annals of Statistics 7 (1979), 1-26), resampled within groups.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/paired_test.h"

namespace remote_touch {

inline constexpr int kBootstrapDraws = 2000;

// differences[g] has the differences of the pairs of group g, such as a noise level. A draw takes from each
// group as many pairs as the group has, with replacement; low and high are the 2.5 % and 97.5 % quantiles of
// the means of the draws. NaNs are skipped. The mean is NaN without pairs; low and high are NaN with fewer
// than two pairs or without draws. Draws come from Philox with this key, so the same numbers give the same
// interval on every machine.
MeanDifference bootstrap_mean(const std::vector<std::vector<double>>& differences, std::uint64_t key,
                              int draws = kBootstrapDraws);

}  // namespace remote_touch
