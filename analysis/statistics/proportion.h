// Confidence interval of a counted proportion.
#pragma once

#include <cstdint>
#include <utility>

namespace remote_touch {

// Two-sided 95 % point of the standard normal distribution.
inline constexpr double kTwoSided95 = 1.959963984540054;

// Wilson's score interval [low, high] of the proportion events / runs; [0, 1] if there are no runs. z:
// two-sided quantile of the confidence.
std::pair<double, double> wilson_interval(std::int64_t events, std::int64_t runs, double z = kTwoSided95);

}  // namespace remote_touch
