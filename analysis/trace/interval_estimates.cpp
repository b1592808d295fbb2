#include "analysis/trace/interval_estimates.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace remote_touch {

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  // Deviations from the first number: those of equal numbers are exactly 0.
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const auto first = std::ranges::find_if(values, is_finite);
  const double origin = first == values.end() ? 0 : *first;
  double sum = 0, squares = 0, cubes = 0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value - origin, ++m.count;
  if (m.count == 0) return m;
  const double shift = sum / m.count;
  m.mean = origin + shift;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const double d = value - origin - shift;
    squares += d * d, cubes += d * d * d;
  }
  if (m.count > 1) m.variance = squares / (m.count - 1);
  m.third = cubes / m.count;
  return m;
}

namespace {

// The critical value of more degrees differs from the normal one by 1e-5 at most.
constexpr double kMostDegrees = 1e5;
constexpr double kHallNumbers = 6, kHallDegrees = 5;  // the fewest for Hall's correction

// Returns the strata with one that has all numbers which are alone in theirs, the first; fixed ones have no
// scatter and count once.
std::vector<Moments> strata_with_scatter(const std::vector<StratumMoments>& strata) {
  std::vector<double> lone;
  std::vector<Moments> all(1);
  for (const StratumMoments& s : strata) {
    if (s.moments.count == 0) continue;
    if (s.is_fixed)
      all.push_back({1, s.moments.mean, 0, 0});
    else if (s.moments.count == 1)
      lone.push_back(s.moments.mean);
    else
      all.push_back(s.moments);
  }
  all.front() = moments_of(lone);
  return all;
}

// Returns the power of 2 below the largest deviation; 1 if nothing scatters. Its square and cube neither
// overflow nor vanish beside those of the deviations, and dividing by it rounds nothing.
double scale_of(const std::vector<Moments>& strata) {
  double most = 0;
  for (const Moments& m : strata) most = std::max(most, std::sqrt(m.variance));
  return most > 0 && std::isfinite(most) ? std::exp2(std::ilogb(most)) : 1;
}

// The mean of strata, its scatter, and what follows from them.
struct PooledMoments {
  double count = 0, sum = 0;
  double scale, scatter = 0, squares = 0, cubes = 0;  // sums over the deviations in units of `scale`

  explicit PooledMoments(const std::vector<Moments>& strata) : scale(scale_of(strata)) {
    for (const Moments& m : strata) {
      count += m.count, sum += m.count * m.mean;
      if (m.count < 2) continue;
      const double part = m.count * (m.variance / scale / scale);
      scatter += part, squares += part * part / (m.count - 1);
      cubes += m.count * (m.third / scale / scale / scale);
    }
  }
  double standard_error() const { return scale * std::sqrt(scatter) / count; }
  double degrees() const {
    // A whole number may be missed by a rounding.
    return std::floor(std::clamp(scatter * scatter / squares * (1 + 1e-12), 1.0, kMostDegrees));
  }
  double skewness() const { return cubes / (scatter * std::sqrt(scatter)); }
};

// Hall's transformation: the t of a mean whose skewness is g.
double hall(double y, double g) {
  if (std::abs(g) < 1e-9) return y;
  return 3 / g * (std::cbrt(1 + g * (y - g / 6)) - 1);
}

}  // namespace

double student_two_sided(double t, double degrees) {
  if (std::isinf(t)) return 0;
  return 2 * boost::math::cdf(complement(boost::math::students_t(degrees), std::abs(t)));
}

double student_quantile(double probability, double degrees) {
  return boost::math::quantile(complement(boost::math::students_t(degrees), probability / 2));
}

Estimate estimated_mean(const std::vector<StratumMoments>& strata, bool has_third) {
  const PooledMoments all(strata_with_scatter(strata));
  Estimate e;
  bool are_fixed = true;
  for (const StratumMoments& s : strata) {
    e.unknown += s.unknown;
    are_fixed &= s.is_fixed || s.moments.count == 0;
  }
  e.clusters = static_cast<std::int64_t>(all.count);
  if (all.count == 0) return e;
  e.value = all.sum / all.count;
  if (are_fixed) e.method = kExactMethod;
  if (are_fixed) return e;
  const bool has_scatter = all.scatter > 0 && std::isfinite(all.scatter);
  if (!has_scatter) e.add_note(all.count > 1 ? "no scatter" : "one run");
  if (!has_scatter) return e;
  const double se = all.standard_error(), d = all.degrees(), t = student_quantile(0.05, d);
  e.low = e.value - t * se, e.high = e.value + t * se, e.method = "Student's t";
  if (all.count < kHallNumbers) e.add_note("assumes a normal distribution");
  if (all.count < kHallNumbers || d < kHallDegrees) return e;
  if (!has_third) e.add_note("no correction for a skewed distribution: needs all runs");
  if (!has_third) return e;
  const double g = all.skewness();
  e.low = std::min(e.low, e.value - se * hall(t, g));
  e.high = std::max(e.high, e.value - se * hall(-t, g));
  e.method = "Student's t, Hall";
  return e;
}

Estimate estimated_mean(const std::vector<Stratum>& strata) {
  std::vector<StratumMoments> moments;
  for (const Stratum& s : strata) {
    StratumMoments& m = moments.emplace_back(StratumMoments{moments_of(s.numbers), s.is_fixed});
    m.unknown = static_cast<std::int64_t>(s.numbers.size()) - static_cast<std::int64_t>(m.moments.count);
  }
  return estimated_mean(moments, true);
}

Estimate estimated_mean(const std::vector<double>& numbers) {
  return estimated_mean(std::vector<Stratum>{{numbers}});
}

namespace {

constexpr double kTail = 0.025;  // probability on each side of an interval

// Korn and Graubard's interval. fractions: of the clusters; runs: their number in all clusters together.
std::pair<double, double> interval_of_clusters(const std::vector<double>& fractions, double runs) {
  const Moments m = moments_of(fractions);
  const double f = m.mean, v = m.variance / m.count;
  double effective = m.count;
  if (f > 0 && f < 1 && v > 0) {
    const double t = student_quantile(2 * kTail, runs - 1) / student_quantile(2 * kTail, m.count - 1);
    effective = std::min(runs, f * (1 - f) / v * t * t);
  }
  return exact_interval(f * effective, effective);
}

enum class Unknown { left_out, without, events };

// Returns the fractions of the clusters that have a run, and the number of these runs.
std::pair<std::vector<double>, double> fractions_of(const std::vector<EventCounts>& clusters, Unknown rule) {
  std::vector<double> fractions;
  double all = 0;
  for (const EventCounts& c : clusters) {
    const auto runs = static_cast<double>(rule == Unknown::left_out ? c.known() : c.runs());
    if (runs == 0) continue;
    fractions.push_back(static_cast<double>(c.events + (rule == Unknown::events ? c.unknown : 0)) / runs);
    all += runs;
  }
  return {fractions, all};
}

}  // namespace

double probability_of_at_most(double events, double runs, double probability) {
  return events >= runs ? 1 : boost::math::ibetac(events + 1, runs - events, probability);
}

double probability_of_at_least(double events, double runs, double probability) {
  return events <= 0 ? 1 : boost::math::ibeta(events, runs - events + 1, probability);
}

std::pair<double, double> exact_interval(double events, double runs) {
  if (runs <= 0) return {0, 1};
  return {events <= 0 ? 0 : boost::math::ibeta_inv(events, runs - events + 1, kTail),
          events >= runs ? 1 : boost::math::ibetac_inv(events + 1, runs - events, kTail)};
}

EventCounts sum_of(const std::vector<EventCounts>& counts) {
  EventCounts sum;
  for (const EventCounts& c : counts) sum.add(c);
  return sum;
}

Estimate estimated_fraction(const EventCounts& runs) {
  Estimate e;
  e.clusters = runs.runs(), e.unknown = runs.unknown;
  if (e.clusters == 0) return e;
  const auto n = static_cast<double>(runs.runs());
  e.value = runs.known() > 0 ? static_cast<double>(runs.events) / static_cast<double>(runs.known()) : e.value;
  e.low = exact_interval(static_cast<double>(runs.events), n).first;
  e.high = exact_interval(static_cast<double>(runs.events + runs.unknown), n).second;
  e.method = "Clopper-Pearson";
  return e;
}

Estimate exact_fraction(const EventCounts& runs) {
  Estimate e = estimated_fraction(runs);
  e.low = e.high = std::numeric_limits<double>::quiet_NaN(), e.method = kExactMethod;
  if (runs.unknown == 0) return e;
  const auto n = static_cast<double>(runs.runs());
  e.low = static_cast<double>(runs.events) / n, e.high = static_cast<double>(runs.events + runs.unknown) / n;
  return e;
}

Estimate estimated_fraction(const std::vector<EventCounts>& clusters) {
  const EventCounts sum = sum_of(clusters);
  const bool are_runs = std::ranges::all_of(clusters, [](const EventCounts& c) { return c.runs() <= 1; });
  if (are_runs) return estimated_fraction(sum);
  Estimate e;
  const auto [least, runs] = fractions_of(clusters, Unknown::without);
  const auto [most, same_runs] = fractions_of(clusters, Unknown::events);
  e.clusters = static_cast<std::int64_t>(least.size()), e.unknown = sum.unknown;
  e.value = mean(fractions_of(clusters, Unknown::left_out).first);
  e.low = interval_of_clusters(least, runs).first, e.high = interval_of_clusters(most, runs).second;
  e.method = "Korn-Graubard";
  return e;
}

double root_mean_square(const std::vector<double>& values) {
  double max = 0;
  for (const double value : values) max = std::max(max, std::abs(value));
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
  const auto count = static_cast<double>(std::ranges::count_if(subsets.sums, against));
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
  const auto [least, greatest] = std::ranges::minmax_element(d);
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

// Equal pairs have no interval. If they are enough for a test, their difference counts as exact.
std::pair<double, double> interval_in_hull(const Estimate& e) {
  const bool is_exact = std::isnan(e.low) && !std::isnan(e.p);
  return is_exact ? std::pair{e.value, e.value} : std::pair{e.low, e.high};
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
  const auto from = interval_in_hull(least), to = interval_in_hull(most);
  const bool is_known = !std::isnan(from.first + to.first);
  e.low = is_known ? std::min(from.first, to.first) : kNone;
  e.high = is_known ? std::max(from.second, to.second) : kNone;
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
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size(), std::numeric_limits<double>::quiet_NaN());
  double max = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    max = std::max(max, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
    adjusted[order[i]] = max;
  }
  return adjusted;
}

std::int64_t tests_among(const std::vector<double>& p) {
  return std::ranges::count_if(p, [](double value) { return !std::isnan(value); });
}

std::int64_t pairs_for_family(std::int64_t tests, double alpha) {
  std::int64_t pairs = kLeastPairs;
  while (static_cast<double>(tests) * std::exp2(1 - static_cast<double>(pairs)) > alpha) ++pairs;
  return pairs;
}

}  // namespace remote_touch
