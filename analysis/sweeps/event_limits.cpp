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

enum class Place : std::int32_t { inside, below_the_first, above_the_last, no_runs };
const std::vector<std::string> kPlaceNames = {"inside", "below the first value", "above the last value",
                                              "no runs"};

// The counts of one group of cells, in increasing order of the axis.
struct Counts {
  std::vector<double> x, runs;
  std::vector<Tally> tallies;
};

std::vector<std::size_t> other_axes(const SweepResult& result, std::size_t along) {
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < result.axes.size(); ++axis)
    if (axis != along) others.push_back(axis);
  return others;
}

Counts counts_of(const SweepResult& result, const LimitQuestion& question, const CellGroup& group) {
  const auto& x = std::get<std::vector<double>>(result.axes[question.along].values);
  const std::vector<double>& measure = result.measure(question.measure);
  std::vector<std::size_t> order(group.cells.size());  // the cells of a group follow the axis
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  Counts counts;
  for (const std::size_t i : order) {
    const Tally t = tally(result, measure, group.cells[i], question.threshold);
    if (t.runs == 0) continue;
    counts.x.push_back(x[i]), counts.runs.push_back(t.runs), counts.tallies.push_back(t);
  }
  return counts;
}

// Covariance of the share of events with the place on the axis, summed over a group.
double slope(const Counts& counts) {
  double runs = 0, events = 0, places = 0, products = 0;
  for (std::size_t i = 0; i < counts.x.size(); ++i) {
    const auto place = static_cast<double>(i);
    runs += counts.runs[i], events += counts.tallies[i].events;
    places += counts.runs[i] * place, products += counts.tallies[i].events * place;
  }
  return runs > 0 ? products - events * places / runs : 0;
}

struct Crossing {
  double x = kOutside;
  Place place = Place::no_runs;
};

// A rising share of events is a falling share of runs without the event.
Crossing crossing_of(const Counts& counts, const std::vector<double>& shares, double level) {
  if (shares.empty()) return {};
  const std::vector<double> falling = isotonic_falling(shares, counts.runs);
  if (falling.front() < level) return {kOutside, Place::below_the_first};
  if (falling.back() > level) return {kOutside, Place::above_the_last};
  return {crossing(counts.x, falling, level), Place::inside};
}

struct Limit {
  Crossing best, low, high;
};

Limit limit_of(const Counts& counts, bool rises, double level) {
  std::vector<double> shares, low, high;
  for (const Tally& t : counts.tallies) {
    const int counted = rises ? t.runs - t.events : t.events;
    const auto [from, to] = wilson_interval(counted, t.runs);
    shares.push_back(static_cast<double>(counted) / t.runs), low.push_back(from), high.push_back(to);
  }
  const double share = rises ? 1 - level : level;
  return {crossing_of(counts, shares, share), crossing_of(counts, low, share),
          crossing_of(counts, high, share)};
}

}  // namespace

bool event_rises(const SweepResult& result, const LimitQuestion& question) {
  double sum = 0;
  for (const CellGroup& group : cell_groups(result, other_axes(result, question.along)))
    sum += slope(counts_of(result, question, group));
  return sum >= 0;
}

Table event_limits(const SweepResult& result, const LimitQuestion& question) {
  const std::vector<std::size_t> others = other_axes(result, question.along);
  const std::vector<CellGroup> groups = cell_groups(result, others);
  const bool rises = event_rises(result, question);
  std::vector<double> limits, low, high;
  std::vector<std::int32_t> places, runs;
  for (const CellGroup& group : groups) {
    const Counts counts = counts_of(result, question, group);
    const Limit limit = limit_of(counts, rises, question.level);
    limits.push_back(limit.best.x), low.push_back(limit.low.x), high.push_back(limit.high.x);
    places.push_back(static_cast<std::int32_t>(limit.best.place));
    runs.push_back(static_cast<std::int32_t>(std::accumulate(counts.runs.begin(), counts.runs.end(), 0.0)));
  }
  const Column& axis = result.axes[question.along];
  Table table{"limits", "limit of " + question.measure + " along " + axis.name,
              axes_of(result, others, groups)};
  table.add("limit", axis.units, "where the event has the given probability; NaN: not within the values",
            limits);
  table.add("limit_low", axis.units, "lower end of its 95 % interval; NaN: not within the values", low);
  table.add("limit_high", axis.units, "upper end of its 95 % interval; NaN: not within the values", high);
  table.columns.push_back({"place", "1", "where the limit is, relative to the values of the axis",
                           std::move(places), 1, kPlaceNames});
  table.add("runs", "1", "number of finished runs", std::move(runs));
  return table;
}

}  // namespace remote_touch
