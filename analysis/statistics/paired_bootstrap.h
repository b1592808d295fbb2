// Interval of the mean difference of pairs, without an assumption about its distribution: the percentile
// bootstrap (B. Efron, Annals of Statistics 7 (1979), 1-26), resampled within groups.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/paired_test.h"

namespace remote_touch {

inline constexpr int kBootstrapDraws = 2000;

// differences: of each group, such as a noise level, those of its pairs. A draw takes as many pairs of each
// group as it has, with replacement; low and high are the 2.5 % and 97.5 % points of the means of the draws.
// NaNs are skipped; results for which there are too few pairs are NaN. Draws come from Philox with this key,
// so that the same numbers give the same interval on every machine.
MeanDifference bootstrap_mean(const std::vector<std::vector<double>>& differences, std::uint64_t key,
                              int draws = kBootstrapDraws);

}  // namespace remote_touch
