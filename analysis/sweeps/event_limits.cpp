#include "analysis/sweeps/sweep_means.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {
namespace {

enum class Place : std::int32_t {
  inside,
  below_the_first,
  above_the_last,
  other_direction,
  no_runs,
  below_the_runs,
  above_the_runs,
  no_direction,
  none_of_the_runs,
  all_of_the_runs,
  rises_and_falls
};
const std::vector<std::string> kPlaceNames = {"inside",
                                              "below the first value",
                                              "above the last value",
                                              "changes the other way",
                                              "no runs",
                                              "below the values with runs",
                                              "above the values with runs",
                                              "no direction",
                                              "none of the runs",
                                              "all of the runs",
                                              "rises and falls"};

// The runs of one group of cells, in increasing order of the axis.
struct AxisRuns {
  std::vector<RunsAtValue> values;
  bool has_first = false, has_last = false;  // the first and the last value of the axis have runs
  bool are_independent = true;

  EventCounts sum() const {
    EventCounts all;
    for (const RunsAtValue& value : values) all.add(value.counts);
    return all;
  }
};

std::vector<std::size_t> axes_without(const SweepGrid& grid, const std::vector<std::size_t>& left_out) {
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    if (std::ranges::find(left_out, axis) == left_out.end()) others.push_back(axis);
  return others;
}

// Returns the places of the cells of a group by increasing value of the axis.
std::vector<std::size_t> by_value(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  return order;
}

AxisRuns runs_of(const SweepGrid& grid, const CellCounts& cells, const LimitQuestion& question,
                 const CellStreams& streams, const CellGroup& group) {
  const auto& x = std::get<std::vector<double>>(grid.axes[question.along].values);
  AxisRuns runs;
  runs.are_independent = streams.are_independent(group.cells);
  const std::vector<std::size_t> order = by_value(x);  // the cells of a group follow the axis
  for (const std::size_t i : order) {
    const EventCounts counts = cells.events(group.cells[i]);
    if (counts.runs() == 0) continue;
    runs.values.push_back(RunsAtValue{x[i], counts, streams.is_fixed(group.cells[i])}.of_one_run_if_fixed());
    runs.has_first |= i == order.front(), runs.has_last |= i == order.back();
  }
  return runs;
}

// The covariance of the event with the index on the axis, times the number of runs, and its variance if the
// event does not depend on the axis. Fixed cells do not vary.
struct Slope {
  double sum = 0, variance = 0, runs = 0;
};

// pre: `unknown_has_event(index - mean index)` says how unknown outcomes count.
Slope slope_of(const AxisRuns& row, bool towards_rising) {
  double runs = 0, indices = 0;
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const auto n = static_cast<double>(row.values[i].counts.runs());
    runs += n, indices += n * static_cast<double>(i);
  }
  const double middle = indices / runs;
  const auto events_at = [&](std::size_t i) {
    const EventCounts& c = row.values[i].counts;
    const bool is_event = (static_cast<double>(i) > middle) == towards_rising;
    return static_cast<double>(c.events + (is_event ? c.unknown : 0));
  };
  double events = 0;
  for (std::size_t i = 0; i < row.values.size(); ++i) events += events_at(i);
  const double share = events / runs;
  Slope slope;
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const auto n = static_cast<double>(row.values[i].counts.runs());
    const double apart = static_cast<double>(i) - middle, with = events_at(i);
    slope.sum += apart * (with - n * share);
    if (row.values[i].is_fixed) continue;
    slope.variance += apart * apart * (with * (1 - share) * (1 - share) + (n - with) * share * share);
    slope.runs += n;
  }
  return slope;
}

// True if the slopes of these rows together are clearly above 0, or below 0 if not `rising`. Unknown outcomes
// are taken against it. Rows that share random numbers may all deviate alike.
bool is_shown(const std::vector<AxisRuns>& rows, bool rising, bool rows_are_independent) {
  double sum = 0, variance = 0, deviation = 0, runs = 0;
  for (const AxisRuns& row : rows) {
    if (row.values.empty()) continue;
    const Slope slope = slope_of(row, !rising);
    sum += slope.sum, variance += slope.variance, deviation += std::sqrt(slope.variance), runs += slope.runs;
  }
  const double sd = rows_are_independent ? std::sqrt(variance) : deviation;
  if (!(rising ? sum > 0 : sum < 0)) return false;
  if (sd == 0) return true;  // fixed cells only
  return runs >= kLeastPairs && std::abs(sum) / sd > student_quantile(0.05, runs - 1);
}

struct Row {
  Estimate estimate;
  Place place = Place::no_runs;
};

Row without_limit(const AxisRuns& runs, Place place) {
  Row row{{}, place};
  const EventCounts all = runs.sum();
  row.estimate.clusters = all.runs(), row.estimate.unknown = all.unknown;
  return row;
}

Row row_of(const AxisRuns& runs, const std::optional<bool>& rises, double level) {
  if (runs.values.empty()) return {};
  const EventCounts all = runs.sum();
  if (!rises && all.known() > 0 && (all.events == 0 || all.without == 0))
    return without_limit(runs, all.events == 0 ? Place::none_of_the_runs : Place::all_of_the_runs);
  if (!rises) return without_limit(runs, Place::no_direction);
  if (is_shown({runs}, !*rises, true)) return without_limit(runs, Place::other_direction);
  const Limit limit = estimated_limit(runs.values, {level, *rises, runs.are_independent});
  Row row{limit.estimate, static_cast<Place>(limit.place)};
  if (limit.place == LimitPlace::no_runs) row.place = Place::no_runs;
  if (limit.place == LimitPlace::rises_and_falls) row.place = Place::rises_and_falls;
  if (limit.place == LimitPlace::below_the_first && !runs.has_first) row.place = Place::below_the_runs;
  if (limit.place == LimitPlace::above_the_last && !runs.has_last) row.place = Place::above_the_runs;
  return row;
}

// Adds a note if more than 5 % of the runs at a value are unknown.
void note_unknown_values(const AxisRuns& runs, Estimate& e) {
  Estimate worst;
  std::int64_t of_runs = 1;
  for (const RunsAtValue& value : runs.values)
    if (value.counts.unknown * of_runs > worst.unknown * value.counts.runs())
      worst.unknown = value.counts.unknown, of_runs = value.counts.runs();
  note_unknown(worst, of_runs, true);
  if (!worst.note.empty()) e.add_note("at one value " + worst.note);
}

EventOutcome outcome_of(const SweepResult& result, double value, std::size_t run, double threshold) {
  if (result.state[run] != RunState::done) return EventOutcome::missing;
  if (std::isnan(value)) return EventOutcome::unknown;
  return value > threshold ? EventOutcome::event : EventOutcome::without;
}

CellCounts counts_of_runs(const SweepResult& result, const LimitQuestion& question) {
  const std::vector<double>& measure = result.measure(question.measure);
  return {[&](std::size_t cell) { return event_counts(result, measure, cell, question.threshold); }};
}

// Returns the number of runs of these cells that share no random numbers.
std::int64_t clusters_in(const CellCounts& cells, const CellStreams& streams,
                         const std::vector<std::size_t>& group) {
  if (cells.clusters) return cells.clusters(group);
  const bool by_replicate = streams.share_replicates(group);
  std::map<std::pair<bool, std::size_t>, std::int64_t> most;
  for (const std::size_t cell : group) {
    const std::int64_t runs = cells.events(cell).runs();
    const bool is_fixed = streams.is_fixed(cell);
    const std::size_t key = is_fixed ? cell : by_replicate ? streams.seed[cell] : streams.noise_cell[cell];
    std::int64_t& own = most[{is_fixed, key}];
    own = std::max(own, is_fixed ? std::min<std::int64_t>(runs, 1) : runs);
  }
  std::int64_t sum = 0;
  for (const auto& [key, runs] : most) sum += runs;
  return sum;
}

// Returns the direction in which the event becomes more probable.
std::optional<bool> direction_of(const std::vector<AxisRuns>& rows, bool are_independent) {
  for (const bool rising : {true, false})
    if (is_shown(rows, rising, are_independent)) return rising;
  return std::nullopt;
}

// True if no two of the groups share random numbers.
bool groups_are_independent(const std::vector<CellGroup>& groups, const CellStreams& streams) {
  std::vector<std::size_t> one_of_each;  // along the axis sharing does no harm
  for (const CellGroup& group : groups) {
    const auto random =
        std::ranges::find_if(group.cells, [&](std::size_t cell) { return !streams.is_fixed(cell); });
    if (random != group.cells.end()) one_of_each.push_back(*random);
  }
  return streams.are_independent(one_of_each);
}

}  // namespace

EventLimits event_limits(const SweepResult& result, const LimitQuestion& question,
                         const CellStreams& streams) {
  CellCounts cells = counts_of_runs(result, question);
  cells.clusters = [&](const std::vector<std::size_t>& group) {
    const bool by_replicate = streams.share_replicates(group);
    return static_cast<std::int64_t>(clusters_of(result, streams, group, by_replicate).size());
  };
  if (!result.notes.empty())
    cells.noted = [&](std::size_t cell) { return noted_runs(result, {{{}, {cell}}}).front(); };
  return event_limits(result, cells, question, streams);
}

EventLimits event_limits(const SweepGrid& grid, const CellCounts& cells, const LimitQuestion& question,
                         const CellStreams& streams) {
  const std::vector<std::size_t> others = axes_without(grid, {question.along});
  const std::vector<CellGroup> groups = cell_groups(grid, others);
  std::vector<AxisRuns> all;
  for (const CellGroup& group : groups) all.push_back(runs_of(grid, cells, question, streams, group));
  const std::optional<bool> rises =
      question.rises ? question.rises : direction_of(all, groups_are_independent(groups, streams));
  std::vector<Estimate> estimates;
  std::vector<std::int32_t> places;
  std::vector<std::int64_t> noted;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Row row = row_of(all[i], rises, question.level);
    note_unknown_values(all[i], row.estimate);
    row.estimate.clusters = clusters_in(cells, streams, groups[i].cells);
    const auto runs_in = [&](std::size_t cell) { return cells.events(cell).runs(); };
    row.estimate.add_note(equal_runs_note(streams, groups[i].cells, runs_in));
    note_shared(row.estimate, all[i].sum().runs(), row.estimate.clusters, "runs");
    estimates.push_back(std::move(row.estimate)), places.push_back(static_cast<std::int32_t>(row.place));
    if (!cells.noted) continue;
    noted.push_back(0);
    for (const std::size_t cell : groups[i].cells) noted.back() += cells.noted(cell);
  }
  const Column& axis = grid.axes[question.along];
  Table table{"limits", "limit of " + question.measure + " along " + axis.name,
              axes_of(grid, others, groups)};
  add_estimates(table, estimates,
                {axis.units,
                 "value of the axis at which the event has the given probability; NaN: not between values "
                 "with runs",
                 kRunsMeaning},
                noted);
  table.columns.push_back({name_beside(table, "place"), "1",
                           "where the limit is, relative to the values of the axis", std::move(places), 1,
                           kPlaceNames});
  return {std::move(table), rises};
}

Table limit_comparisons(const SweepResult& result, const LimitQuestion& question, std::size_t between,
                        const CellStreams& streams, LimitComparison comparison) {
  const bool is_ratio = comparison == LimitComparison::ratio;
  std::vector<std::size_t> kept = axes_without(result, {question.along, between});
  kept.push_back(between);
  std::vector<CellGroup> groups = cell_groups(result, kept);
  std::erase_if(groups, [](const CellGroup& group) { return group.indices.back() == 0; });
  const auto& x = std::get<std::vector<double>>(result.axes[question.along].values);
  const std::vector<double>& measure = result.measure(question.measure);
  const auto first_of = [&](const CellGroup& group) {
    std::vector<std::size_t> cells;
    for (const std::size_t cell : group.cells) {
      std::vector<std::size_t> indices = result.axis_indices(cell);
      indices[between] = 0;
      cells.push_back(result.cell_at(indices));
    }
    return cells;
  };
  const auto curve_of = [&](const std::vector<std::size_t>& cells) {
    std::vector<OutcomesAtValue> curve;
    for (const std::size_t i : by_value(x)) {
      const std::size_t cell = cells[i];
      OutcomesAtValue& value = curve.emplace_back(OutcomesAtValue{x[i], {}, streams.is_fixed(cell)});
      for (int replicate = 0; replicate < result.replicates; ++replicate) {
        const std::size_t run = result.run(cell, replicate);
        value.outcomes.push_back(outcome_of(result, measure[run], run, question.threshold));
      }
    }
    return curve;
  };
  std::vector<Estimate> estimates;
  for (const CellGroup& group : groups) {
    Estimate& e = estimates.emplace_back();
    if (!question.rises) e.add_note("no direction");
    if (!question.rises) continue;
    const std::vector<std::size_t> first = first_of(group);
    const bool are_independent = streams.are_independent(first) && streams.are_independent(group.cells);
    e = estimated_limit_comparison(curve_of(first), curve_of(group.cells),
                                   {question.level, *question.rises, are_independent}, comparison);
    if (result.round.empty()) continue;
    e.low = e.high = e.p = std::numeric_limits<double>::quiet_NaN();
    e.method.clear(), e.add_note("the sweep was refined: no interval");
  }
  const Column &axis = result.axes[question.along], &variants = result.axes[between];
  const std::string what = is_ratio ? "ratio" : "difference";
  Table table{"limit_" + what,
              what + " of the limit of " + question.measure + " along " + axis.name +
                  (is_ratio ? " to" : " from") + " that of the first value of " + variants.name,
              axes_of(result, kept, groups)};
  add_estimates(table, estimates,
                {is_ratio ? "1" : axis.units, what + " of the limits", "number of replicates", !is_ratio},
                noted_runs(result, groups));
  return table;
}

namespace {

struct Belief {
  bool known = false;      // the outcome of some run is known
  bool uncertain = false;  // neither "likely" nor its opposite is certain
  bool likely = false;     // more than half of the known runs had the event
};

// A cell is certain if it has more events than n / 2 by 1.96 deviations of n tosses of a fair coin, or as
// many fewer, whatever its unknown outcomes are.
Belief belief(const SweepResult& result, const RefinementRule& rule, std::size_t cell) {
  const EventCounts counts = event_counts(result, result.measure(rule.measure), cell, rule.threshold);
  const auto runs = static_cast<double>(counts.runs());
  const double chance = 0.5 * runs + 0.5 * kTwoSided95 * std::sqrt(runs);
  const bool is_certain = static_cast<double>(std::max(counts.events, counts.without)) >= chance;
  return {counts.known() > 0, !is_certain, counts.events > counts.without};
}

int requested_replicates(const SweepResult& result, std::size_t cell) {
  int count = 0;
  for (int replicate = 0; replicate < result.replicates; ++replicate)
    count += result.state[result.run(cell, replicate)] != RunState::not_sampled ? 1 : 0;
  return count;
}

// Adds the cells half way between this cell and each neighbour if they disagree or one of them is uncertain,
// at every spacing from the first round's down to 2.
void add_between(const SweepResult& result, const std::vector<Belief>& beliefs,
                 const std::vector<std::size_t>& strides, std::size_t cell, std::set<std::size_t>& cells) {
  const std::vector<std::size_t> here = result.axis_indices(cell);
  for (std::size_t axis = 0; axis < here.size(); ++axis)
    for (std::size_t stride = strides[axis]; stride >= 2; stride /= 2) {
      std::vector<std::size_t> there = here;
      there[axis] += stride;
      if (here[axis] % stride != 0 || there[axis] >= result.axes[axis].length()) continue;
      const Belief &a = beliefs[cell], &b = beliefs[result.cell_at(there)];
      if (!a.known || !b.known || !(a.uncertain || b.uncertain || a.likely != b.likely)) continue;
      there[axis] -= stride / 2;
      const std::size_t middle = result.cell_at(there);
      if (requested_replicates(result, middle) == 0) cells.insert(middle);
    }
}

}  // namespace

std::vector<std::size_t> next_round(const SweepResult& result, const RefinementRule& rule) {
  std::vector<Belief> beliefs;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell)
    beliefs.push_back(belief(result, rule, cell));
  std::set<std::size_t> cells;
  for (std::size_t cell = 0; cell < beliefs.size(); ++cell) {
    if (beliefs[cell].known && beliefs[cell].uncertain) cells.insert(cell);
    add_between(result, beliefs, rule.strides, cell, cells);
  }
  std::vector<std::size_t> order(cells.begin(), cells.end());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return requested_replicates(result, a) < requested_replicates(result, b);
  });

  const auto spent = static_cast<std::uint64_t>(
      std::ranges::count_if(result.state, [](RunState state) { return state != RunState::not_sampled; }));
  std::vector<std::size_t> runs;
  for (const std::size_t cell : order) {
    const int from = requested_replicates(result, cell),
              to = std::min(from + rule.first_replicates, result.replicates);
    for (int replicate = from; replicate < to && spent + runs.size() < rule.budget; ++replicate)
      runs.push_back(result.run(cell, replicate));
  }
  std::ranges::sort(runs);
  return runs;
}

}  // namespace remote_touch
