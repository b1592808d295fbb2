#include "analysis/statistics/proportion.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>

#include "analysis/statistics/mean.h"
#include "analysis/statistics/student.h"

namespace remote_touch {

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
