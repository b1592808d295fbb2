#include "analysis/sweeps/event_limits.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "analysis/statistics/isotonic_regression.h"
#include "analysis/statistics/proportion.h"
#include "analysis/sweeps/cell_groups.h"

namespace remote_touch {

namespace {

constexpr double kOutside = std::numeric_limits<double>::quiet_NaN();

enum class Place : std::int32_t {
  inside,
  below_the_first,
  above_the_last,
  other_direction,
  no_runs,
  below_the_runs,
  above_the_runs
};
const std::vector<std::string> kPlaceNames = {
    "inside",  "below the first value",      "above the last value",      "changes the other way",
    "no runs", "below the values with runs", "above the values with runs"};

// The counts of one group of cells, in increasing order of the axis.
struct Counts {
  std::vector<double> x, runs;
  std::vector<Tally> tallies;
  bool has_first = false, has_last = false;  // the first and the last value of the axis have runs
};

std::vector<std::size_t> other_axes(const SweepResult& result, std::size_t along) {
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < result.axes.size(); ++axis)
    if (axis != along) others.push_back(axis);
  return others;
}

Counts counts_of(const SweepResult& outline, const CellCounts& cells, const LimitQuestion& question,
                 const CellGroup& group) {
  const auto& x = std::get<std::vector<double>>(outline.axes[question.along].values);
  std::vector<std::size_t> order(group.cells.size());  // the cells of a group follow the axis
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  Counts counts;
  for (const std::size_t i : order) {
    const Tally t = cells.events(group.cells[i]);
    if (t.runs == 0) continue;
    counts.x.push_back(x[i]), counts.runs.push_back(t.runs), counts.tallies.push_back(t);
    counts.has_first |= i == order.front(), counts.has_last |= i == order.back();
  }
  return counts;
}

// Covariance of the share of events with the index on the axis, times the number of runs.
double slope(const Counts& counts) {
  double runs = 0, events = 0, indices = 0, products = 0;
  for (std::size_t i = 0; i < counts.x.size(); ++i) {
    const auto index = static_cast<double>(i);
    runs += counts.runs[i], events += counts.tallies[i].events;
    indices += counts.runs[i] * index, products += counts.tallies[i].events * index;
  }
  return runs > 0 ? products - events * indices / runs : 0;
}

// True if the share of events at one end of the axis is clearly on the wrong side of that at the other end:
// their intervals do not overlap.
bool changes_the_other_way(const Counts& counts, bool rises) {
  if (counts.tallies.empty()) return false;
  const Tally &first = counts.tallies.front(), &last = counts.tallies.back();
  const Tally &less = rises ? last : first, &more = rises ? first : last;
  return wilson_interval(less.events, less.runs).second < wilson_interval(more.events, more.runs).first;
}

struct Crossing {
  double x = kOutside;
  Place place = Place::no_runs;
};

// Returns the x at which the falling curve that is nearest to the values crosses the level.
Crossing crossing_of(const Counts& counts, const std::vector<double>& values, double level) {
  if (values.empty()) return {};
  const std::vector<double> falling = isotonic_falling(values, counts.runs);
  if (falling.front() < level)
    return {kOutside, counts.has_first ? Place::below_the_first : Place::below_the_runs};
  if (falling.back() > level)
    return {kOutside, counts.has_last ? Place::above_the_last : Place::above_the_runs};
  return {crossing(counts.x, falling, level), Place::inside};
}

struct Limit {
  Crossing best, low, high;
  double at_least = kOutside, at_most = kOutside;
};

// Sets the values of the axis that enclose the limit: the last one with the curve of the low ends above the
// level, and the first one with the curve of the high ends below it.
void enclose(const Counts& counts, const std::vector<double>& low, const std::vector<double>& high,
             double level, Limit& limit) {
  if (counts.x.empty()) return;
  const std::vector<double> from = isotonic_falling(low, counts.runs);
  const std::vector<double> to = isotonic_falling(high, counts.runs);
  for (std::size_t i = 0; i < counts.x.size(); ++i)
    if (from[i] > level) limit.at_least = counts.x[i];
  for (std::size_t i = counts.x.size(); i-- > 0;)
    if (to[i] < level) limit.at_most = counts.x[i];
}

// Returns the number of finished runs of a cell that have a note.
std::int32_t noted_runs(const SweepResult& result, std::size_t cell) {
  std::int32_t count = 0;
  for (int replicate = 0; replicate < result.replicates; ++replicate)
    if (result.notes[result.run(cell, replicate)] != 0) ++count;
  return count;
}

// A rising share is a falling share with the other sign, so that no share is rounded.
Limit limit_of(const Counts& counts, bool rises, double level) {
  if (changes_the_other_way(counts, rises)) return {{kOutside, Place::other_direction}, {}, {}};
  const double sign = rises ? -1 : 1;
  std::vector<double> shares, low, high;
  for (const Tally& t : counts.tallies) {
    const auto [from, to] = wilson_interval(t.events, t.runs);
    shares.push_back(sign * (static_cast<double>(t.events) / t.runs));
    low.push_back(sign * (rises ? to : from)), high.push_back(sign * (rises ? from : to));
  }
  Limit limit{crossing_of(counts, shares, sign * level), crossing_of(counts, low, sign * level),
              crossing_of(counts, high, sign * level)};
  enclose(counts, low, high, sign * level, limit);
  return limit;
}

}  // namespace

EventLimits event_limits(const SweepResult& result, const LimitQuestion& question) {
  const std::vector<double>& measure = result.measure(question.measure);
  CellCounts cells{[&](std::size_t cell) { return tally(result, measure, cell, question.threshold); }};
  if (!result.notes.empty()) cells.noted = [&](std::size_t cell) { return noted_runs(result, cell); };
  return event_limits(result, cells, question);
}

EventLimits event_limits(const SweepResult& result, const CellCounts& cells, const LimitQuestion& question) {
  const std::vector<std::size_t> others = other_axes(result, question.along);
  const std::vector<CellGroup> groups = cell_groups(result, others);
  std::vector<Counts> all;
  double sum = 0;
  for (const CellGroup& group : groups)
    sum += slope(all.emplace_back(counts_of(result, cells, question, group)));
  const bool rises = sum >= 0;
  std::vector<double> limits, low, high, at_least, at_most;
  std::vector<std::int32_t> places, noted;
  std::vector<std::int64_t> runs;
  for (const Counts& counts : all) {
    const Limit limit = limit_of(counts, rises, question.level);
    limits.push_back(limit.best.x), low.push_back(limit.low.x), high.push_back(limit.high.x);
    at_least.push_back(limit.at_least), at_most.push_back(limit.at_most);
    places.push_back(static_cast<std::int32_t>(limit.best.place));
    runs.push_back(static_cast<std::int64_t>(std::accumulate(counts.runs.begin(), counts.runs.end(), 0.0)));
  }
  const Column& axis = result.axes[question.along];
  Table table{"limits", "limit of " + question.measure + " along " + axis.name,
              axes_of(result, others, groups)};
  table.add(
      "limit", axis.units,
      "value of the axis at which the event has the given probability; NaN: not between values with runs",
      limits);
  table.add("limit_low", axis.units, "lower end of its 95 % interval; NaN: not between values with runs",
            low);
  table.add("limit_high", axis.units, "upper end of its 95 % interval; NaN: not between values with runs",
            high);
  table.add("at_least", axis.units,
            "last value of the axis before the limit at which the interval is off the given probability",
            std::move(at_least));
  table.add("at_most", axis.units,
            "first value of the axis after the limit at which the interval is off the given probability",
            std::move(at_most));
  table.columns.push_back({"place", "1", "where the limit is, relative to the values of the axis",
                           std::move(places), 1, kPlaceNames});
  table.columns.push_back({"runs", "1", "number of finished runs", counts_in_column(runs)});
  if (cells.noted) {
    for (const CellGroup& group : groups) {
      noted.push_back(0);
      for (const std::size_t cell : group.cells) noted.back() += cells.noted(cell);
    }
    table.add("noted_runs", "1", "number of finished runs with a note", std::move(noted));
  }
  return {std::move(table), rises};
}

}  // namespace remote_touch
