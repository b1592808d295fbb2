#include "runners/evaluation/scorecard/scorecard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/scorecard/evaluation.h"

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

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Proportion proportion_of(const std::vector<std::vector<double>>& clusters) {
  Proportion share;
  for (const auto& cluster : clusters) {
    share.events += static_cast<int>(std::count(cluster.begin(), cluster.end(), 1.0));
    share.runs += static_cast<int>(cluster.size());
  }
  const Estimate fraction = fraction_of(clusters);
  share.fraction = fraction.value;
  if (share.runs > 0) share.low = fraction.low, share.high = fraction.high;
  return share;
}

// Values of the runs by noise level and replicate.
template <class Value>
PairedValues by_level(const SweepResult& sweep, Value&& value) {
  PairedValues values(sweep.cell_count());
  for (std::size_t run = 0; run < sweep.run_count(); ++run) values[sweep.cell_of(run)].push_back(value(run));
  return values;
}

// Finds the levels whose replicates are all the same run, to the last bit of every measure. They are one run
// if nothing is random there: without noise, or at every level if the noise changes no run at all. Runs that
// are equal at some noisy levels only are separate draws of the noise. A scene's own noise level is NaN.
std::vector<bool> repeats_of(const SweepResult& sweep, const std::vector<double>& noise_m) {
  const auto same = [&](std::size_t a, std::size_t b) {
    const auto equal = [&](const Column& measure) {
      const auto& values = std::get<std::vector<double>>(measure.values);
      return values[a] == values[b] || (std::isnan(values[a]) && std::isnan(values[b]));
    };
    return sweep.state[a] == sweep.state[b] &&
           std::all_of(sweep.measures.begin(), sweep.measures.end(), equal);
  };
  std::vector<bool> repeats;
  bool all = true;
  for (std::size_t level = 0; level < noise_m.size(); ++level) {
    bool own = true;
    for (int k = 1; k < sweep.replicates; ++k) own = own && same(sweep.run(level, 0), sweep.run(level, k));
    repeats.push_back(own);
    all = all && own && same(0, sweep.run(level, 0));
  }
  for (std::size_t level = 0; level < noise_m.size(); ++level)
    repeats[level] = all || (repeats[level] && noise_m[level] == 0);
  return repeats;
}

bool has_noise(double noise_m) {
  return noise_m != 0;  // NaN: the scene's own
}

// The levels with noise.
template <class Level>
std::vector<Level> noisy(const std::vector<Level>& levels, const std::vector<double>& noise_m) {
  std::vector<Level> list;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (has_noise(noise_m[i])) list.push_back(levels[i]);
  return list;
}

// Counts the values that are 1 among those that are a number. If all levels repeat one run, they are one.
Successes counted(const PairedValues& all, const SharedRuns& shared, const std::vector<double>& noise_m) {
  Successes result;
  const PairedValues values = distinct(all, shared);
  PairedValues with_noise = noisy(values, noise_m);
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.at_level.push_back(proportion_of(clusters_of({values[i]}, shared)));
    if (!has_noise(noise_m[i])) result.noise_free = result.at_level.back();
  }
  const bool is_one = std::count(shared.repeats.begin(), shared.repeats.end(), false) == 0;
  if (is_one && with_noise.size() > 1) with_noise.resize(1);
  result.noisy = proportion_of(clusters_of(with_noise, shared));
  return result;
}

// Data that all parts of a score share.
struct Runs {
  const std::vector<SweepResult>& sweeps;
  std::vector<double> noise_m;
  std::vector<SharedRuns> shared = {};  // one for each method

  std::vector<SharedRuns> shared_noisy() const {
    std::vector<SharedRuns> list = shared;
    for (SharedRuns& one : list) one.repeats = noisy(one.repeats, noise_m);
    return list;
  }
  std::vector<PairedValues> noisy_levels(const std::vector<PairedValues>& values) const {
    std::vector<PairedValues> list;
    for (const PairedValues& one : values) list.push_back(noisy(one, noise_m));
    return list;
  }
};

std::vector<PairedValues> won_by(const Runs& runs, const std::vector<Bound>& bounds) {
  std::vector<PairedValues> won;
  for (const SweepResult& sweep : runs.sweeps) {
    const std::vector<bool> success = successes(sweep, bounds);
    won.push_back(by_level(sweep, [&](std::size_t run) { return success[run] ? 1.0 : 0.0; }));
  }
  return won;
}

std::vector<Successes> counts_of(const Runs& runs, const std::vector<PairedValues>& won) {
  std::vector<Successes> list;
  for (std::size_t c = 0; c < won.size(); ++c) list.push_back(counted(won[c], runs.shared[c], runs.noise_m));
  return list;
}

// Returns the measure's values of method c by level. NaN in the runs that do not count: those without
// success, if successful_only.
PairedValues values_in(const Runs& runs, std::size_t c, const std::string& name, bool successful_only,
                       const PairedValues& won) {
  const std::vector<double>& all = runs.sweeps[c].measure(name);
  PairedValues values = by_level(runs.sweeps[c], [&](std::size_t run) { return all[run]; });
  if (!successful_only) return values;
  for (std::size_t i = 0; i < won.size(); ++i)
    for (std::size_t k = 0; k < won[i].size(); ++k)
      if (won[i][k] == 0) values[i][k] = kNone;
  return values;
}

// A method that loses the surface early has a short and quiet run. So judged measures count successes only.
JudgedMeasure judged(const std::string& name, Better better, const Runs& runs,
                     const std::vector<PairedValues>& won) {
  JudgedMeasure measure{name, "1", better};
  for (const Column& column : runs.sweeps.front().measures)
    if (column.name == name) measure.units = column.units;
  std::vector<PairedValues> values;
  for (std::size_t c = 0; c < runs.sweeps.size(); ++c) {
    values.push_back(values_in(runs, c, name, better != Better::neither, won[c]));
    measure.at_level.emplace_back();
    for (const auto& level : distinct(values.back(), runs.shared[c]))
      measure.at_level.back().push_back(estimated_mean(level));
  }
  measure.ranking = ranking(runs.noisy_levels(values), better, false, runs.shared_noisy());
  return measure;
}

SceneThreshold below(const PerceptionThreshold& threshold, const Runs& runs,
                     const std::vector<PairedValues>& won) {
  SceneThreshold scene{threshold.measure, {}};
  for (std::size_t c = 0; c < runs.sweeps.size(); ++c) {
    PairedValues values = values_in(runs, c, threshold.measure, true, won[c]);
    for (std::vector<double>& level : values)
      for (double& value : level)
        if (!std::isnan(value)) value = is_below(threshold, value) ? 1 : 0;
    scene.below.push_back(counted(values, runs.shared[c], runs.noise_m));
  }
  return scene;
}

Table success_table(const Scorecard& card, const CardNumbers& numbers) {
  std::vector<std::int32_t> old_events;
  for (const SceneScore& s : card.scenes)
    for (std::size_t c = 0; c < card.methods.size(); ++c)
      for (std::size_t i = 0; i < s.noise_m.size(); ++i)
        old_events.push_back(s.old_success.empty() ? -1 : s.old_success[c].at_level[i].events);
  Table table = counts_table(numbers);
  table.add("old_successes", "1", "successes by the previous rule; -1 if there is none", old_events);
  return table;
}

struct Standing {
  std::string scene, measure, method;
  std::int32_t place, mark, top_group;
};

// The place is 1, 2, ... in the order of each ranking. The mark is 1 for the best method, -1 for the worst
// and 0 for others.
Table ranking_table(const Scorecard& card) {
  std::vector<Standing> rows;
  const auto add = [&](const SceneScore& s, const std::string& name, const Ranking& ranking) {
    for (std::size_t i = 0; i < ranking.order.size(); ++i) {
      const std::size_t c = ranking.order[i];
      const int mark = i == 0 && ranking.has_best ? 1 : i + 1 == ranking.ranked && ranking.has_worst ? -1 : 0;
      const bool top = std::count(ranking.top_group.begin(), ranking.top_group.end(), c) > 0;
      rows.push_back({s.name, name, card.methods[c], static_cast<std::int32_t>(i + 1), mark, top});
    }
  };
  for (const SceneScore& s : card.scenes) {
    add(s, "success", s.ranking);
    for (const JudgedMeasure& m : s.measures)
      if (m.better != Better::neither) add(s, m.name, m.ranking);
  }
  Table table{"standings", "methods in order over all levels with noise"};
  add_column(table, rows, "scene", "scene", &Standing::scene);
  add_column(table, rows, "measure", "success or measure", &Standing::measure);
  add_column(table, rows, "place", "place in the order, 1 the best", &Standing::place);
  add_column(table, rows, "method", "method", &Standing::method);
  add_column(table, rows, "mark",
             "1 if significantly better, -1 if significantly worse than all others, else 0", &Standing::mark);
  add_column(table, rows, "top_group",
             "1 for the first method and for all that it is not significantly better than",
             &Standing::top_group);
  return table;
}

// Adds a panel of the fraction of successes over the noise. A scene with its own noise has one point, at 0
// mm.
void add_panel(const Scorecard& card, std::size_t number, Figure& figure) {
  const SceneScore& s = card.scenes[number];
  Table table{"panel_" + std::to_string(number), s.name};
  std::vector<double> noise_mm;
  for (const double noise : s.noise_m) noise_mm.push_back(noise != noise ? 0 : 1e3 * noise);
  table.add("noise", "mm", "standard deviation of the noise", noise_mm);
  Panel panel{s.name, "noise (mm)", "success"};
  panel.y_range = std::pair(-0.05, 1.05);
  constexpr std::size_t kAcross = 5;
  const std::size_t row = number / kAcross, column = number % kAcross;
  panel.grid_position = std::pair(static_cast<double>(row), static_cast<double>(column));
  for (std::size_t c = 0; c < card.methods.size(); ++c) {
    const std::string& name = card.methods[c];
    const std::vector<Proportion>& shares = s.success[c].at_level;
    add_column(table, shares, name, "share of successful runs", &Proportion::fraction);
    add_column(table, shares, name + "_low", "lower end of its interval", &Proportion::low);
    add_column(table, shares, name + "_high", "upper end of its interval", &Proportion::high);
    panel.curves.push_back({table.name, "noise", name, CurveStyle::line, number == 0 ? name : ""});
  }
  figure.tables.push_back(std::move(table));
  figure.panels.push_back(std::move(panel));
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

std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds) {
  std::vector<bool> kept;
  for (const RunState state : result.state) kept.push_back(state == RunState::done);
  for (const Bound& bound : bounds) {
    const std::vector<double>& values = result.measure(bound.measure);
    for (std::size_t run = 0; run < kept.size(); ++run) kept[run] = kept[run] && bound.holds(values[run]);
  }
  return kept;
}

long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell) {
  using Failure = std::tuple<std::size_t, double, std::size_t>;  // bound, value, run: no two are equal
  std::vector<Failure> failures;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const std::size_t run = result.run(cell, replicate);
    if (result.state[run] == RunState::failed) failures.emplace_back(bounds.size(), 0, run);
    if (result.state[run] != RunState::done) continue;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const double value = result.measure(bounds[i].measure)[run];
      if (bounds[i].holds(value)) continue;
      // NaN sorts behind all numbers.
      failures.emplace_back(i, std::isnan(value) ? std::numeric_limits<double>::infinity() : value, run);
      break;
    }
  }
  if (failures.empty()) return -1;
  std::sort(failures.begin(), failures.end());
  return static_cast<long>(std::get<2>(failures[(failures.size() - 1) / 2]));
}

SceneScore score(const SceneRules& rules, const std::vector<SweepResult>& sweeps, bool own_noise) {
  SceneScore scene{rules.name, rules.title, rules.meaning, {kNone}, {}, {}, {}, {}};
  if (!own_noise) scene.noise_m = std::get<std::vector<double>>(sweeps.front().axes.front().values);
  Runs runs{sweeps, scene.noise_m};
  for (std::size_t c = 0; c < sweeps.size(); ++c)
    runs.shared.push_back(
        {repeats_of(sweeps[c], scene.noise_m), c < rules.by_replicate.size() && rules.by_replicate[c]});
  const std::vector<PairedValues> won = won_by(runs, rules.success);
  scene.success = counts_of(runs, won);
  if (!rules.old_success.empty()) scene.old_success = counts_of(runs, won_by(runs, rules.old_success));
  scene.ranking = ranking(runs.noisy_levels(won), Better::larger, true, runs.shared_noisy());
  for (const auto& [name, better] : rules.measures) scene.measures.push_back(judged(name, better, runs, won));
  for (const PerceptionThreshold& threshold : perception_thresholds())
    if (std::any_of(rules.measures.begin(), rules.measures.end(),
                    [&](const auto& measure) { return measure.first == threshold.measure; }))
      scene.thresholds.push_back(below(threshold, runs, won));
  return scene;
}

void correct(Scorecard& card) {
  std::vector<Ranking*> rankings;
  for (SceneScore& scene : card.scenes) {
    rankings.push_back(&scene.ranking);
    for (JudgedMeasure& measure : scene.measures) rankings.push_back(&measure.ranking);
  }
  card.tests = correct_together(rankings);
  card.least_pairs = std::max(kMinPairs, pairs_for_family(card.tests));
}

Figure scorecard_figure(const Scorecard& card) {
  const CardNumbers numbers = numbers_of(card, KeptMeasures::all);
  Figure figure{
      kScorecardFigure,
      "Scorecard of 3-DOF renderers",
      "Share of successful runs over noise, scene by scene. All methods were run with the same noise.",
      {success_table(card, numbers), means_table(numbers), ranking_table(card), overview_table(card),
       behind_table(card), thresholds_table(card)}};
  for (std::size_t i = 0; i < card.scenes.size(); ++i) add_panel(card, i, figure);
  return figure;
}

}  // namespace remote_touch
