#include "runners/evaluation/scorecard/scorecard.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/paired_test.h"
#include "runners/evaluation/scorecard/card_summaries.h"

namespace remote_touch {

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

namespace {

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
