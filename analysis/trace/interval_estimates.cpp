#include "analysis/trace/interval_estimates.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>

namespace remote_touch {

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  // Deviations from the first number: those of equal numbers are exactly 0.
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const auto first = std::find_if(values.begin(), values.end(), is_finite);
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
  const bool are_runs =
      std::all_of(clusters.begin(), clusters.end(), [](const EventCounts& c) { return c.runs() <= 1; });
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

Estimate estimated_quantile(std::vector<double> values, double q) {
  Estimate e;
  e.unknown = std::erase_if(values, [](double value) { return std::isnan(value); });
  e.clusters = static_cast<std::int64_t>(values.size());
  if (values.empty()) return e;
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const double rank = std::ceil(q * n - 1e-9);  // 0.07 times 100 is above 7 by a rounding
  e.value = values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
  double l = 0, u = n + 1;  // ranks from 1; X(0) and X(n + 1) do not exist
  while (l < n && probability_of_at_most(l, n, q) <= kTail) ++l;
  while (u > 1 && probability_of_at_least(u - 1, n, q) <= kTail) --u;
  if (l >= 1) e.low = values[static_cast<std::size_t>(l) - 1];
  if (u <= n) e.high = values[static_cast<std::size_t>(u) - 1];
  e.method = "order statistics";
  return e;
}

}  // namespace remote_touch
