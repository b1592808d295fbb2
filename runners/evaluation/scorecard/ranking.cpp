#include "runners/evaluation/scorecard/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/paired_test.h"

namespace remote_touch {

namespace {

// Returns of(a, b) of each pair of runs as values of both methods together; NaN unless both have a number.
template <class Of>
PairedValues paired(const PairedValues& a, const PairedValues& b, Of&& of) {
  PairedValues all(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].size(); ++k) {
      const bool is_pair = !std::isnan(a[i][k]) && !std::isnan(b[i][k]);
      all[i].push_back(is_pair ? of(a[i][k], b[i][k]) : std::numeric_limits<double>::quiet_NaN());
    }
  return all;
}

// Returns by how much worse the first method is than the second. An event is a success or none.
Estimate difference_of(const PairedValues& a, const PairedValues& b, Better better, bool event,
                       const SharedRuns& shared) {
  const auto worse_by = [&](double x, double y) { return badness(x, better) - badness(y, better); };
  const auto clusters = clusters_of(distinct(paired(a, b, worse_by), shared), shared);
  if (event) {
    std::vector<std::vector<OutcomePair>> outcomes;
    for (const std::vector<double>& cluster : clusters) {
      outcomes.emplace_back();
      for (const double d : cluster) outcomes.back().push_back({d < 0 ? 1.0 : 0.0, d > 0 ? 1.0 : 0.0});
    }
    return estimated_event_difference(outcomes);
  }
  std::vector<double> means;
  for (const std::vector<double>& cluster : clusters) means.push_back(mean(cluster));
  return estimated_difference(means);
}

SharedRuns of_both(const SharedRuns& a, const SharedRuns& b) {
  SharedRuns both{std::vector<bool>(std::min(a.repeats.size(), b.repeats.size())),
                  a.by_replicate || b.by_replicate};
  for (std::size_t i = 0; i < both.repeats.size(); ++i) both.repeats[i] = a.repeats[i] && b.repeats[i];
  return both;
}

double mean_badness(const PairedValues& values, Better better) {
  double sum = 0, count = 0;
  for (const auto& group : values)
    for (const double value : group)
      if (!std::isnan(value)) sum += badness(value, better), ++count;
  return sum / count;
}

std::int64_t numbers_in(const std::vector<std::vector<double>>& clusters) {
  std::int64_t count = 0;
  for (const auto& cluster : clusters) count += static_cast<std::int64_t>(cluster.size());
  return count;
}

void decide(Ranking& r) {
  if (r.against.empty() || r.ranked == 0) return;
  const auto is_above = [&](std::size_t i, std::size_t k) {
    return r.against[r.order[i]][r.order[k]].shows_better();
  };
  r.top_group = {r.order[0]};
  for (std::size_t i = 1; i < r.ranked; ++i)
    if (!is_above(0, i)) r.top_group.push_back(r.order[i]);
  r.has_best = r.ranked > 1 && r.top_group.size() == 1;
  r.has_worst = r.ranked > 1;
  for (std::size_t i = 0; i + 1 < r.ranked; ++i) r.has_worst = r.has_worst && is_above(i, r.ranked - 1);
}

}  // namespace

PairedValues distinct(const PairedValues& values, const SharedRuns& shared) {
  PairedValues once = values;
  for (std::size_t i = 0; i < std::min(once.size(), shared.repeats.size()); ++i)
    if (shared.repeats[i] && once[i].size() > 1) once[i].erase(once[i].begin() + 1, once[i].end());
  return once;
}

std::vector<std::vector<double>> clusters_of(const PairedValues& values, const SharedRuns& shared) {
  std::vector<std::vector<double>> clusters;
  for (const auto& level : values)
    for (std::size_t k = 0; k < level.size(); ++k) {
      if (!shared.by_replicate)
        clusters.emplace_back();
      else if (clusters.size() <= k)
        clusters.resize(k + 1);
      auto& cluster = shared.by_replicate ? clusters[k] : clusters.back();
      if (!std::isnan(level[k])) cluster.push_back(level[k]);
    }
  std::erase_if(clusters, [](const auto& cluster) { return cluster.empty(); });
  return clusters;
}

Estimate fraction_of(const std::vector<std::vector<double>>& clusters) {
  std::vector<EventCounts> counts;
  for (const auto& cluster : clusters) {
    const std::int64_t events = std::count(cluster.begin(), cluster.end(), 1.0);
    counts.push_back({events, static_cast<std::int64_t>(cluster.size()) - events, 0});
  }
  return estimated_fraction(counts);
}

Estimate mean_of(const PairedValues& values, const SharedRuns& shared) {
  if (shared.by_replicate) {
    std::vector<double> means;
    for (const auto& cluster : clusters_of(values, shared)) means.push_back(mean(cluster));
    return estimated_mean(means);
  }
  std::vector<Stratum> levels;
  for (std::size_t i = 0; i < values.size(); ++i)
    levels.push_back({values[i], i < shared.repeats.size() && shared.repeats[i]});
  return estimated_mean(levels);
}

Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event,
                const std::vector<SharedRuns>& shared) {
  Ranking result;
  std::vector<double> bad;
  const auto shared_by = [&](std::size_t c) { return c < shared.size() ? shared[c] : SharedRuns{}; };
  for (std::size_t c = 0; c < methods.size(); ++c) {
    const PairedValues values = distinct(methods[c], shared_by(c));
    result.mean.push_back(mean_of(values, shared_by(c)));
    bad.push_back(numbers_in(clusters_of(values, shared_by(c))) >= (event ? 1 : kMinPairs)
                      ? mean_badness(values, better)
                      : std::numeric_limits<double>::infinity());
  }
  result.order.resize(methods.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return bad[a] < bad[b]; });
  for (const double each : bad) result.ranked += each < std::numeric_limits<double>::infinity() ? 1 : 0;
  if (better == Better::neither) return result;
  result.against.assign(methods.size(), std::vector<MethodComparison>(methods.size()));
  for (std::size_t i = 0; i < result.ranked; ++i)
    for (std::size_t k = i + 1; k < result.ranked; ++k) {
      const std::size_t a = result.order[i], b = result.order[k];
      const Estimate worse =
          difference_of(methods[a], methods[b], better, event, of_both(shared_by(a), shared_by(b)));
      if (worse.clusters < kMinPairs) continue;
      result.against[a][b] = {worse.p, worse.value < 0, worse.is_skewed};
      result.against[b][a] = {worse.p, worse.value > 0, worse.is_skewed};
    }
  decide(result);
  return result;
}

// Each pair of methods is one test, although against[a][b] and against[b][a] both hold its p value.
std::int64_t correct_together(const std::vector<Ranking*>& rankings) {
  std::vector<MethodComparison*> there, back;
  std::vector<double> p;
  for (Ranking* r : rankings)
    for (std::size_t a = 0; a < r->against.size(); ++a)
      for (std::size_t b = a + 1; b < r->against.size(); ++b) {
        there.push_back(&r->against[a][b]), back.push_back(&r->against[b][a]);
        p.push_back(r->against[a][b].p);
      }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < p.size(); ++i) there[i]->p = back[i]->p = adjusted[i];
  for (Ranking* r : rankings) decide(*r);
  return tests_among(p);
}

}  // namespace remote_touch
