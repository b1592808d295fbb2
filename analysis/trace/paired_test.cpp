#include "analysis/trace/paired_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "analysis/trace/interval_estimates.h"

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

namespace {

constexpr double kSignificance = 0.05;
constexpr std::size_t kMostFlips = 16;  // the most pairs whose 2^n sign flips are all computed

// Sums of all non-empty subsets; one that is 0 within the tolerance is 0.
struct SubsetSums {
  std::vector<double> sums, means;

  SubsetSums(const std::vector<double>& d, double tolerance) {
    std::vector<double> counts = {0};
    sums = {0};
    for (const double value : d)
      for (std::size_t i = 0, n = sums.size(); i < n; ++i)
        sums.push_back(sums[i] + value), counts.push_back(counts[i] + 1);
    for (std::size_t i = 1; i < sums.size(); ++i) {
      if (std::abs(sums[i]) <= tolerance) sums[i] = 0;
      means.push_back(sums[i] / counts[i]);
    }
    sums.erase(sums.begin());
  }
};

// p of the sign flips, for a sum of this sign.
double flip_p(const SubsetSums& subsets, double sum) {
  const auto against = [&](double s) { return sum > 0 ? s <= 0 : s >= 0; };
  const auto count = static_cast<double>(std::count_if(subsets.sums.begin(), subsets.sums.end(), against));
  return std::min(1.0, 2 * (1 + count) / static_cast<double>(subsets.sums.size() + 1));
}

void add_flip_interval(SubsetSums subsets, Estimate& e) {
  const auto k = static_cast<std::ptrdiff_t>((subsets.sums.size() + 1) / 40);  // floor(0.025 2^n)
  std::vector<double>& means = subsets.means;
  std::nth_element(means.begin(), means.begin() + (k - 1), means.end());
  e.low = means[static_cast<std::size_t>(k - 1)];
  std::nth_element(means.begin(), means.end() - k, means.end());
  e.high = *(means.end() - k);
}

bool holds_zero(const Estimate& e) {
  return e.low <= 0 && e.high >= 0;
}

void add_test(const std::vector<double>& d, double sum, double tolerance, Estimate& e) {
  const double n = static_cast<double>(d.size());
  const auto [least, greatest] = std::minmax_element(d.begin(), d.end());
  const bool are_equal = *greatest - *least <= tolerance;
  if (d.size() <= kMostFlips) {
    const SubsetSums subsets(d, tolerance);
    e.p = sum == 0 ? 1 : flip_p(subsets, sum);
    e.method = "sign flips";
    if (!are_equal) add_flip_interval(subsets, e);
  } else {
    const double se = std::sqrt(moments_of(d).variance / n),
                 half = student_quantile(kSignificance, n - 1) * se;
    e.p = sum == 0 ? 1 : std::exp2(1 - n);
    e.method = "Student's t";
    if (!are_equal) {
      e.p = std::max(std::exp2(1 - n), student_two_sided(e.value / se, n - 1));
      e.low = e.value - half, e.high = e.value + half;
    }
  }
  if (are_equal) e.add_note(sum == 0 ? "all pairs are equal" : "no scatter");
}

}  // namespace

Estimate estimated_difference(const std::vector<double>& differences) {
  std::vector<double> d;
  double sum = 0, magnitudes = 0;
  for (const double value : differences)
    if (std::isfinite(value)) d.push_back(value), sum += value, magnitudes += std::abs(value);
  Estimate of_mean = estimated_mean(d);
  of_mean.unknown = static_cast<std::int64_t>(differences.size() - d.size());
  if (of_mean.clusters < kLeastPairs) return of_mean;
  Estimate e;
  e.clusters = of_mean.clusters, e.unknown = of_mean.unknown, e.value = of_mean.value;
  const double tolerance = 1e-9 * magnitudes;
  if (std::abs(sum) <= tolerance) sum = 0;
  add_test(d, sum, tolerance, e);
  e.is_skewed = e.p <= kSignificance && holds_zero(of_mean);
  if (e.is_skewed) e.add_note(kSkewedNote);
  return e;
}

namespace {

struct PairCounts {
  std::int64_t up = 0, down = 0, pairs = 0;
};

// All D at which Tango's score is at most z.
std::pair<double, double> tango_interval(const PairCounts& counts) {
  const auto b = static_cast<double>(counts.up), c = static_cast<double>(counts.down);
  const auto n = static_cast<double>(counts.pairs);
  const auto is_inside = [&](double D) {
    const double A = 2 * n, B = -b - c + (2 * n - b + c) * D, C = -c * D * (1 - D);
    const double q = (std::sqrt(std::max(0.0, B * B - 4 * A * C)) - B) / (2 * A);
    const double variance = n * (2 * q + D * (1 - D));
    return std::abs(b - c - n * D) <= kTwoSided95 * std::sqrt(std::max(0.0, variance));
  };
  const auto end_towards = [&](double outside) {
    double inside = (b - c) / n;
    if (is_inside(outside)) return outside;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_inside(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  return {end_towards(-1), end_towards(1)};
}

Estimate difference_of_counts(const PairCounts& counts) {
  Estimate e;
  e.clusters = counts.pairs;
  if (counts.pairs == 0) return e;
  e.value = static_cast<double>(counts.up - counts.down) / static_cast<double>(counts.pairs);
  const double p = sign_test(counts.up, counts.down);
  std::tie(e.low, e.high) = tango_interval(counts);
  if (p > kSignificance) e.low = std::min(e.low, 0.0), e.high = std::max(e.high, 0.0);
  e.method = "Tango, sign test";
  if (counts.pairs >= kLeastPairs) e.p = p;
  return e;
}

// The way in which unknown outcomes are taken: left out, or so that the difference is smallest or largest.
enum class Assignment { left_out, smallest, largest };

// Returns the difference of a pair; NaN if it is left out.
double difference_of(const OutcomePair& pair, Assignment rule) {
  const double first = rule == Assignment::smallest ? 1 : 0, second = 1 - first;
  if (rule == Assignment::left_out) return pair.second - pair.first;
  return (std::isnan(pair.second) ? second : pair.second) - (std::isnan(pair.first) ? first : pair.first);
}

Estimate difference_by(const std::vector<std::vector<OutcomePair>>& clusters, Assignment rule,
                       bool are_runs) {
  PairCounts counts;
  std::vector<double> means;
  for (const std::vector<OutcomePair>& cluster : clusters) {
    std::vector<double> differences;
    for (const OutcomePair& pair : cluster)
      if (const double d = difference_of(pair, rule); !std::isnan(d)) {
        differences.push_back(d);
        counts.up += d > 0 ? 1 : 0, counts.down += d < 0 ? 1 : 0, ++counts.pairs;
      }
    if (!differences.empty()) means.push_back(mean(differences));
  }
  return are_runs ? difference_of_counts(counts) : estimated_difference(means);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Interval {
  double low, high;
};

// Equal pairs have no interval. If they are enough for a test, their difference counts as exact.
Interval interval_in_hull(const Estimate& e) {
  const bool is_exact = std::isnan(e.low) && !std::isnan(e.p);
  return is_exact ? Interval{e.value, e.value} : Interval{e.low, e.high};
}

}  // namespace

Estimate estimated_event_difference(const std::vector<std::vector<OutcomePair>>& clusters) {
  std::int64_t unknown = 0;
  bool are_runs = true;
  for (const std::vector<OutcomePair>& cluster : clusters) {
    are_runs &= cluster.size() <= 1;
    for (const OutcomePair& pair : cluster) unknown += std::isnan(pair.second - pair.first) ? 1 : 0;
  }
  Estimate known = difference_by(clusters, Assignment::left_out, are_runs);
  if (unknown == 0) return known;
  const Estimate least = difference_by(clusters, Assignment::smallest, are_runs);
  const Estimate most = difference_by(clusters, Assignment::largest, are_runs);
  Estimate e = most;
  e.value = known.value, e.unknown = unknown;
  const Interval from = interval_in_hull(least), to = interval_in_hull(most);
  const bool is_known = !std::isnan(from.low + to.low);
  e.low = is_known ? std::min(from.low, to.low) : kNone;
  e.high = is_known ? std::max(from.high, to.high) : kNone;
  e.p = least.value * most.value < 0 ? (std::isnan(most.p) ? most.p : 1) : std::max(least.p, most.p);
  if (e.p > kSignificance) e.low = std::min(e.low, 0.0), e.high = std::max(e.high, 0.0);
  e.is_skewed = e.p <= kSignificance && (least.is_skewed || most.is_skewed);
  if (std::isnan(e.p)) e.add_note(least.note);
  if (!std::isnan(e.p)) e.note.clear();
  if (e.is_skewed) e.add_note(kSkewedNote);
  return e;
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!std::isnan(p[i])) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size(), std::numeric_limits<double>::quiet_NaN());
  double max = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    max = std::max(max, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
    adjusted[order[i]] = max;
  }
  return adjusted;
}

std::int64_t tests_among(const std::vector<double>& p) {
  return std::count_if(p.begin(), p.end(), [](double value) { return !std::isnan(value); });
}

std::int64_t pairs_for_family(std::int64_t tests, double alpha) {
  std::int64_t pairs = kLeastPairs;
  while (static_cast<double>(tests) * std::exp2(1 - static_cast<double>(pairs)) > alpha) ++pairs;
  return pairs;
}

}  // namespace remote_touch
