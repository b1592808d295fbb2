// Confidence interval of a counted proportion.
#pragma once

#include <utility>

namespace remote_touch {

// Two-sided 95 % point of the standard normal distribution.
inline constexpr double kTwoSided95 = 1.959963984540054;

// Wilson's score interval [low, high] for events of runs; [0, 1] for no runs. z: quantile of the confidence.
std::pair<double, double> wilson_interval(int events, int runs, double z = kTwoSided95);

}  // namespace remote_touch
