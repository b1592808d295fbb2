#include "analysis/statistics/paired_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/statistics/mean.h"

namespace remote_touch {

namespace {

double max_magnitude(const std::vector<double>& values) {
  double max = 0;
  for (const double value : values) max = std::max(max, std::abs(value));
  return max;
}

}  // namespace

double root_mean_square(const std::vector<double>& values) {
  const double max = max_magnitude(values);
  if (max == 0 || std::isinf(max)) return max;
  double squares = 0;
  for (const double value : values) squares += (value / max) * (value / max);
  return max * std::sqrt(squares / static_cast<double>(values.size()));
}

// Computes the binomial weights downwards from the middle, where they are largest, in units of the largest
// weight. Each weight follows from the one before it, so no factorials are needed. `half` is half of the sum
// of all weights, so no powers of 2 are needed.
double sign_test(std::int64_t plus, std::int64_t minus) {
  const std::int64_t count = plus + minus, fewer = std::min(plus, minus);
  if (2 * fewer >= count - 1) return 1;
  double weight = 1, half = count % 2 == 0 ? 0.5 : 1, tail = 0;
  for (std::int64_t i = count / 2; i > 0 && weight > 0; --i) {
    weight *= static_cast<double>(i) / static_cast<double>(count - i + 1);  // now the weight of i - 1
    half += weight;
    if (i - 1 > fewer) continue;
    tail += weight;
    if (weight < 1e-18 * tail) break;
  }
  return std::min(1.0, tail / half);
}

double symmetry_test(const std::vector<double>& differences) {
  const double max = max_magnitude(differences);
  if (max == 0) return 1;
  double sum = 0, squares = 0;  // scaled by the largest, so that no square overflows or vanishes
  for (const double d : differences) sum += d / max, squares += (d / max) * (d / max);
  return std::min(1.0, 2 * std::exp(-sum * sum / (2 * squares)));
}

std::pair<double, double> paired_difference_interval(std::int64_t plus, std::int64_t minus,
                                                     std::int64_t pairs, double z) {
  if (pairs <= 0) return {-1, 1};
  const double n = static_cast<double>(pairs) + 2, difference = static_cast<double>(plus - minus);
  const double discordant = static_cast<double>(plus + minus) + 1;
  const double half = z * std::sqrt(discordant - difference * difference / n) / n;
  return {std::max(-1.0, difference / n - half), std::min(1.0, difference / n + half)};
}

MeanDifference mean_of_sum(double sum, std::int64_t pairs, double half_width) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double mean = pairs > 0 ? sum / static_cast<double>(pairs) : kNone;
  if (std::isnan(half_width)) return {pairs, mean, kNone, kNone};
  return {pairs, mean, mean - half_width, mean + half_width};
}

MeanDifference mean_difference(const std::vector<double>& differences) {
  const Moments m = moments_of(differences);
  const auto pairs = static_cast<std::int64_t>(m.count);
  if (pairs < 2) return mean_of_sum(m.mean, pairs);
  const double half = kTwoSided95 * std::sqrt(m.variance / m.count);
  return {pairs, m.mean, m.mean - half, m.mean + half};
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double max = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    max = std::max(max, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
    adjusted[order[i]] = max;
  }
  return adjusted;
}

}  // namespace remote_touch
