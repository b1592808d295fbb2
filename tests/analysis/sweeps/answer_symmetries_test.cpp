// Properties that all answers about a sweep have: means, differences, limits, and comparisons of limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "analysis/sweeps/sweep_means.h"
#include "tests/analysis/sweeps/example_sweeps.h"

namespace remote_touch::answer_symmetries_test {
namespace {

using namespace made_sweeps;

// Two methods and these values of x; an event that becomes more probable with x, and a depth.
SweepResult sweep_over(const std::vector<double>& x, int replicates) {
  return sweep({names("method", {"old", "new"}), {"x", "m", "", x}}, replicates);
}

// Some runs failed, and some have no value.
SweepResult random_sweep(std::mt19937& random) {
  SweepResult result = sweep_over({1, 2, 4, 7}, 12);
  std::normal_distribution<double> normal;
  constexpr unsigned kChances[] = {0, 30, 70, 100};
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::vector<std::size_t> at = result.axis_indices(result.cell_of(run));
    event(result)[run] = random() % 100 + 10 * at[0] < kChances[at[1]] + 10 * at[0] * at[1] ? 1 : 0;
    depth(result)[run] = normal(random) + 0.3 * static_cast<double>(at[0]);
    if (random() % 30 == 0) result.state[run] = RunState::failed;
    for (std::vector<double>* values : {&event(result), &depth(result)})
      if (result.state[run] == RunState::failed || random() % 30 == 0) (*values)[run] = kNaN;
  }
  return result;
}

std::vector<Table> answers_of(const SweepResult& result, const CellStreams& streams) {
  LimitQuestion question{"event", 0.5, 1, 0.5};
  EventLimits limits = event_limits(result, question, streams);
  question.rises = limits.rises;
  return {sweep_means(result, "event", {1}, streams),
          sweep_means(result, "depth", {}, streams),
          sweep_differences(result, "event", 0, {1}, streams),
          sweep_differences(result, "depth", 0, {1}, streams),
          std::move(limits.table),
          limit_comparisons(result, question, 0, streams, LimitComparison::difference),
          limit_comparisons(result, question, 0, streams, LimitComparison::ratio)};
}

// Change of the numbers of an answer that follows from one of the sweep; null: nothing follows.
using Change = double (*)(double);
constexpr Change kKept = [](double v) { return v; }, kNegative = [](double v) { return -v; },
                 kComplement = [](double v) { return 1 - v; }, kInverse = [](double v) { return 1 / v; },
                 kMirrored = [](double v) { return 10 - v; }, kScaled = [](double v) { return 1024 * v; };

bool are_same(double a, double b) {
  return a == b || (std::isnan(a) ? std::isnan(b) : std::abs(a - b) <= 1e-8 * (1 + std::abs(b)));
}

// Values and intervals of `after` are those of `before` after the change, which may exchange the ends; counts
// and p are equal.
void expect_changed(const Table& before, const Table& after, Change change) {
  const bool falls = change(2) < change(1);
  for (std::size_t k = 0; k < before.columns.size(); ++k) {
    const Column& column = before.columns[k];
    if (column.name == "runs" || column.name == "unknown") {
      EXPECT_TRUE(column.values == after.columns[k].values) << before.name << ", " << column.name;
    }
    if (column.name == "p") {
      const std::vector<double>&one = numbers(before, "p"), &other = numbers(after, "p");
      EXPECT_TRUE(std::equal(one.begin(), one.end(), other.begin(), other.end(), are_same)) << before.name;
    }
  }
  for (const auto& [name, source] : {std::pair("value", "value"), std::pair("low", falls ? "high" : "low"),
                                     std::pair("high", falls ? "low" : "high")})
    for (std::size_t row = 0; row < numbers(before, "value").size(); ++row)
      EXPECT_TRUE(are_same(change(numbers(before, source)[row]), numbers(after, name)[row]))
          << before.name << ", row " << row << ", " << name << ": " << numbers(before, source)[row] << " and "
          << numbers(after, name)[row];
}

void exchange_methods(SweepResult& result, std::mt19937&) {
  const auto half = static_cast<std::ptrdiff_t>(result.run_count() / 2);
  for (std::vector<double>* values : {&event(result), &depth(result)})
    std::swap_ranges(values->begin(), values->begin() + half, values->begin() + half);
  std::swap_ranges(result.state.begin(), result.state.begin() + half, result.state.begin() + half);
}

void exchange_event_and_absence(SweepResult& result, std::mt19937&) {
  for (double& value : event(result)) value = 1 - value;
}

// The values of the axis then fall.
void mirror_axis(SweepResult& result, std::mt19937&) {
  for (double& x : std::get<std::vector<double>>(result.axes[1].values)) x = kMirrored(x);
}

void shuffle_replicates(SweepResult& result, std::mt19937& random) {
  std::vector<int> order(static_cast<std::size_t>(result.replicates));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  const SweepResult before = result;
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const auto replicate = static_cast<std::size_t>(result.replicate_of(run));
    const std::size_t from = result.run(result.cell_of(run), order[replicate]);
    result.state[run] = before.state[from];
    event(result)[run] = before.measure("event")[from];
    depth(result)[run] = before.measure("depth")[from];
  }
}

void change_units(SweepResult& result, std::mt19937&) {
  for (double& x : std::get<std::vector<double>>(result.axes[1].values)) x = kScaled(x);
  for (double& value : depth(result)) value = kScaled(value);
}

// The bootstrap of a comparison draws replicates by their numbers.
TEST(Answers, FollowTheSymmetriesOfTheirRuns) {
  struct Symmetry {
    const char* name;
    void (*apply)(SweepResult&, std::mt19937&);
    std::vector<Change> changes;  // one for each answer
  };
  const Symmetry symmetries[] = {
      {"methods", exchange_methods, {kKept, kKept, kNegative, kNegative, nullptr, kNegative, kInverse}},
      {"event", exchange_event_and_absence, {kComplement, kKept, kNegative, kKept, kKept, kKept, kKept}},
      {"axis", mirror_axis, {kKept, kKept, kKept, kKept, kMirrored, kNegative, nullptr}},
      {"order", shuffle_replicates, {kKept, kKept, kKept, kKept, kKept, nullptr, nullptr}},
      {"units", change_units, {kKept, kScaled, kKept, kScaled, kScaled, kScaled, kKept}}};
  std::mt19937 random(2);
  std::vector<int> intervals(7);
  for (int trial = 0; trial < 15; ++trial) {
    const SweepResult result = random_sweep(random);
    const CellStreams streams = independent_streams(result.cell_count());
    const std::vector<Table> before = answers_of(result, streams);
    for (std::size_t i = 0; i < before.size(); ++i)
      intervals[i] += std::isfinite(numbers(before[i], "low")[0] + numbers(before[i], "high")[0]) ? 1 : 0;
    for (const Symmetry& symmetry : symmetries) {
      SCOPED_TRACE(symmetry.name);
      SweepResult changed = result;
      symmetry.apply(changed, random);
      const std::vector<Table> after = answers_of(changed, streams);
      for (std::size_t i = 0; i < before.size(); ++i)
        if (symmetry.changes[i] != nullptr) expect_changed(before[i], after[i], symmetry.changes[i]);
    }
  }
  for (std::size_t i = 0; i < intervals.size(); ++i) EXPECT_GT(intervals[i], 3) << "answer " << i;
}

// Runs of cells that draw no random numbers are equal, however many there are.
TEST(Answers, GainNothingByEqualRuns) {
  const auto fixed_sweep = [](int replicates) {
    SweepResult result = sweep_over({1, 2, 4, 7}, replicates);
    for (std::size_t run = 0; run < result.run_count(); ++run) {
      const std::size_t cell = result.cell_of(run);
      event(result)[run] = cell % 4 > 1 + cell / 4 ? 1 : 0;
      depth(result)[run] = 0.1 * static_cast<double>(cell * cell);
    }
    return result;
  };
  CellStreams streams = independent_streams(8);
  for (RandomStreams& draws : streams.draws) draws = {};
  const std::vector<Table> few = answers_of(fixed_sweep(2), streams),
                           many = answers_of(fixed_sweep(40), streams);
  for (std::size_t i = 0; i < few.size(); ++i) expect_changed(few[i], many[i], kKept);
}

// Cells that draw from the stream of their replicate and whose axis has no effect are one cell.
TEST(Answers, GainNothingByCellsThatShareAllDraws) {
  const auto pooled = [](const std::vector<double>& x) {
    SweepResult result = sweep_over(x, 12);
    for (std::size_t run = 0; run < result.run_count(); ++run) {
      const double i = result.replicate_of(run), method = static_cast<double>(run / (12 * x.size()));
      depth(result)[run] = std::sin(i) + method * std::cos(3 * i);
    }
    CellStreams streams = independent_streams(result.cell_count());
    for (RandomStreams& draws : streams.draws) draws.of_replicate = true;
    return std::vector<Table>{sweep_means(result, "depth", {0}, streams),
                              sweep_differences(result, "depth", 0, {}, streams)};
  };
  const std::vector<Table> one = pooled({1}), many = pooled({1, 2, 3, 4});
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_FALSE(std::isnan(numbers(one[i], "low")[0]));
    expect_changed(one[i], many[i], kKept);
  }
}

}  // namespace
}  // namespace remote_touch::answer_symmetries_test
