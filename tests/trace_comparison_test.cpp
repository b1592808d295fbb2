// Two traces side by side: the first divergent tick, and in what situation the runs part.
#include "analysis/trace_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

#include "analysis/result_file.h"
#include "runners/simulation.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Columns = std::vector<Column>;
using Texts = std::vector<std::string>;

const Columns& lift() {
  static const Columns columns = [] {
    SimulationOptions options;
    options.hash_frames = true;
    return simulate(Experiment::load("fig4.12"), options).columns();
  }();
  return columns;
}

template <class Columns>
auto& find(Columns& columns, const std::string& name) {
  for (auto& column : columns)
    if (column.name == name) return column;
  throw std::out_of_range(name);
}
std::vector<double>& numbers(Columns& columns, const std::string& name) {
  return std::get<std::vector<double>>(find(columns, name).values);
}
std::vector<std::int32_t>& integers(Columns& columns, const std::string& name) {
  return std::get<std::vector<std::int32_t>>(find(columns, name).values);
}
std::vector<std::uint64_t>& hashes(Columns& columns, const std::string& name) {
  return std::get<std::vector<std::uint64_t>>(find(columns, name).values);
}
double& proxy_x(Columns& columns, std::size_t tick) {
  return numbers(columns, "proxy_position")[3 * tick];
}
std::size_t length() {
  return lift().front().length();
}

// The first tick from a given one on: a new frame came in or not, the state is another than before or not.
std::size_t tick_where(bool new_frame, bool new_state, std::size_t from = 100) {
  Columns columns = lift();
  const auto &frame = integers(columns, "frame_index"), &state = integers(columns, "state");
  for (std::size_t i = from; i < length(); ++i)
    if ((frame[i] != frame[i - 1]) == new_frame && (state[i] != state[i - 1]) == new_state) return i;
  throw std::out_of_range("no such tick");
}
std::size_t quiet_tick() {
  return tick_where(false, false);
}

using Change = std::function<void(Columns&)>;
TraceComparison compare(const Columns& baseline, const Columns& candidate, const Tolerances& tolerances = {},
                        const Texts& configuration = {}) {
  return compare_traces(ColumnsInMemory(baseline), ColumnsInMemory(candidate), tolerances, configuration);
}
TraceComparison after(const Change& change, const Tolerances& tolerances = {},
                      const Texts& configuration = {}) {
  Columns candidate = lift();
  change(candidate);
  return compare(lift(), candidate, tolerances, configuration);
}
// The divergence, or one that no test expects where there is none.
Divergence divergence(const TraceComparison& comparison) {
  EXPECT_FALSE(comparison.is_same());
  EXPECT_TRUE(comparison.divergence);
  return comparison.divergence.value_or(Divergence{});
}

// --- what differs, and from when on ---

TEST(CompareTraces, TheSameRunIsTheSame) {
  const TraceComparison same = compare(lift(), lift());
  EXPECT_TRUE(same.is_same());
  EXPECT_FALSE(same.divergence);
  EXPECT_TRUE(same.added.empty());
  ASSERT_EQ(same.columns.size() + 1, lift().size());  // all but the running hash
  for (std::size_t i = 0; i < same.columns.size(); ++i) {
    EXPECT_EQ(same.columns[i].name, lift()[i].name);
    EXPECT_EQ(same.columns[i].rows, length());
  }
  // Other experiments with the same numbers are the same.
  EXPECT_TRUE(compare(lift(), lift(), {}, {"renderer.r1_m 1 against 2"}).is_same());
}

// Every column in turn, at random ticks, whatever its kind; all that follows differs too.
TEST(CompareTraces, FindsTheFirstDivergentTickOfEveryColumn) {
  std::mt19937 random(1);
  for (const Column& column : lift()) {
    if (column.name == "tick_hash") continue;
    const std::size_t tick = random() % length();
    const Divergence found = divergence(after([&](Columns& candidate) {
      std::visit(
          [&](auto& values) {
            if constexpr (std::is_arithmetic_v<typename std::decay_t<decltype(values)>::value_type>)
              for (std::size_t i = tick * static_cast<std::size_t>(column.width); i < values.size(); ++i)
                values[i] += 1;
          },
          find(candidate, column.name).values);
    }));
    EXPECT_EQ(found.tick, tick) << column.name;
    EXPECT_EQ(found.parted, tick) << column.name;
    EXPECT_EQ(found.quantity, column.name);
    EXPECT_DOUBLE_EQ(found.time_s, 0.001 * static_cast<double>(tick));
    EXPECT_NEAR(found.deviation, column.width == 3 ? std::sqrt(3.0) : 1, 1e-12) << column.name;
  }
}

// Whatever the order in which they were changed, and whatever is larger.
TEST(CompareTraces, AmongColumnsTheTraceOrderDecidesAndTimeBeforeIt) {
  const Divergence together = divergence(after([](Columns& c) {
    numbers(c, "force")[3 * 700 + 1] += 5;
    proxy_x(c, 700) += 1e-9;
  }));
  EXPECT_EQ(together.quantity, "proxy_position");
  EXPECT_NEAR(together.deviation, 1e-9, 1e-15);
  const Divergence earlier = divergence(after([](Columns& c) {
    numbers(c, "force")[3 * 699 + 1] += 5;
    proxy_x(c, 700) += 1;
  }));
  EXPECT_EQ(earlier.tick, 699u);
  EXPECT_EQ(earlier.quantity, "force");
  EXPECT_DOUBLE_EQ(earlier.deviation, 5);
}

TEST(CompareTraces, AVectorsDeviationIsALength) {
  const Divergence found = divergence(after([](Columns& c) {
    auto& force = numbers(c, "force");
    force[3 * 500] += 3, force[3 * 500 + 2] -= 4;
  }));
  EXPECT_NEAR(found.deviation, 5, 1e-12);
}

TEST(CompareTraces, TheFirstTickAndTheLast) {
  const Divergence first = divergence(after([](Columns& c) { proxy_x(c, 0) += 1; }));
  EXPECT_EQ(first.tick, 0u);
  EXPECT_EQ(first.time_s, 0);
  EXPECT_EQ(first.first_row, 0u);
  for (const auto* rows : {&first.baseline, &first.candidate})
    for (const Column& column : *rows) EXPECT_EQ(column.length(), 1u) << column.name;

  const std::size_t end = length() - 1;
  const Divergence last = divergence(after([&](Columns& c) { proxy_x(c, end) += 1; }));
  EXPECT_EQ(last.tick, end);
  EXPECT_EQ(last.first_row, end - 1);
  EXPECT_EQ(last.baseline.front().length(), 2u);
}

TEST(CompareTraces, TheRunningHashIsNotJudged) {
  EXPECT_TRUE(after([](Columns& c) { hashes(c, "tick_hash")[3] ^= 1; }).is_same());
  const TraceComparison without = after([](Columns& c) { c.pop_back(); });
  EXPECT_TRUE(without.is_same());
  const Columns no_hash(lift().begin(), lift().end() - 1);
  EXPECT_TRUE(compare(no_hash, lift()).added.empty());
}

// --- tolerances ---

// Within the tolerance the runs part, later they leave it: both ticks are told, and the situation is that of
// the first.
TEST(CompareTraces, RunsPartBeforeTheyLeaveTheTolerance) {
  const std::size_t quiet = quiet_tick(), later = tick_where(true, false, quiet + 100);
  const Change change = [&](Columns& c) {
    numbers(c, "force")[3 * quiet] += 1e-12;
    proxy_x(c, later) += 1e-3;
  };
  const TraceComparison comparison = after(change, {{"*", {1e-9, 0}}});
  const Divergence found = divergence(comparison);
  EXPECT_EQ(found.tick, later);
  EXPECT_EQ(found.quantity, "proxy_position");
  EXPECT_NEAR(found.deviation, 1e-3, 1e-12);
  EXPECT_EQ(found.parted, quiet);
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.first_row, quiet - 1);
  EXPECT_EQ(find(found.candidate, "force").length(), 2u);
  for (const ColumnComparison& column : comparison.columns) {
    const bool force = column.name == "force", proxy = column.name == "proxy_position";
    EXPECT_EQ(column.is_same(), !proxy) << column.name;
    EXPECT_EQ(column.first_difference.has_value(), force || proxy) << column.name;
  }
  // Exact, the same two are apart from the first on.
  const Divergence exact = divergence(after(change));
  EXPECT_EQ(exact.tick, quiet);
  EXPECT_EQ(exact.quantity, "force");
  // Wide enough, they are not; what differs is told all the same.
  const TraceComparison wide = after(change, {{"*", {0.1, 0}}});
  EXPECT_TRUE(wide.is_same());
  EXPECT_FALSE(wide.divergence);
  EXPECT_NEAR(wide.columns[2].largest, 1e-3, 1e-12);
}

TEST(CompareTraces, ATolerancesNameIsAColumnOrAllOthers) {
  const Change change = [](Columns& c) {
    numbers(c, "force")[0] += 1e-3;
    proxy_x(c, 5) += 1e-3;
  };
  EXPECT_EQ(divergence(after(change, {{"force", {1, 0}}})).quantity, "proxy_position");
  EXPECT_EQ(divergence(after(change, {{"*", {1, 0}}, {"force", {}}})).quantity, "force");
  EXPECT_TRUE(after(change, {{"force", {1, 0}}, {"proxy_position", {1, 0}}}).is_same());
}

TEST(CompareTraces, ANumberAgainstNoneIsADivergenceWhateverTheTolerance) {
  for (const double none : {kNaN, kInfinity, -kInfinity}) {
    const TraceComparison comparison =
        after([&](Columns& c) { proxy_x(c, 40) = none; }, {{"*", {kInfinity, kInfinity}}});
    const Divergence found = divergence(comparison);
    EXPECT_EQ(found.tick, 40u);
    EXPECT_TRUE(std::isnan(found.deviation));
    EXPECT_EQ(comparison.columns[2].not_numbers, 1u);
  }
  Columns both = lift();
  proxy_x(both, 40) = kNaN;
  EXPECT_TRUE(compare(both, both).is_same());
  EXPECT_FALSE(compare(both, lift()).is_same());
}

// --- shapes ---

TEST(CompareTraces, AMissingColumnIsAProblemAndAnAddedOneIsNot) {
  const Columns less(lift().begin() + 1, lift().end());  // no time
  const TraceComparison missing = compare(lift(), less);
  EXPECT_FALSE(missing.is_same());
  EXPECT_FALSE(missing.divergence);
  EXPECT_EQ(missing.columns.front().problem, "missing in the candidate");
  EXPECT_EQ(missing.columns.front().rows, 0u);
  const TraceComparison added = compare(less, lift());
  EXPECT_TRUE(added.is_same());
  EXPECT_EQ(added.added, Texts{"time"});
  // A divergence is found in the others.
  Columns changed = less;
  proxy_x(changed, 300) += 1;
  EXPECT_EQ(divergence(compare(lift(), changed)).tick, 300u);
  const Divergence untimed = divergence(compare(less, changed));
  EXPECT_EQ(untimed.tick, 300u);
  EXPECT_EQ(untimed.time_s, 0);
  Columns of_texts = lift();
  of_texts.front().values = std::vector<std::string>(length(), "now");
  EXPECT_EQ(divergence(compare(of_texts, changed)).tick, 300u);
}

Columns shortened(const Columns& columns, std::size_t rows) {
  Columns some;
  const ColumnsInMemory all(columns);
  for (const Column& column : columns) some.push_back(all.rows(column.name, 0, rows));
  return some;
}

TEST(CompareTraces, OneRunIsLonger) {
  const Columns half = shortened(lift(), 400);
  for (const auto& [baseline, candidate] : {std::pair(lift(), half), std::pair(half, lift())}) {
    const TraceComparison comparison = compare(baseline, candidate, {{"*", {1, 1}}});
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.divergence);  // as far as both go
    for (const ColumnComparison& column : comparison.columns) {
      EXPECT_EQ(column.rows, 400u) << column.name;
      EXPECT_EQ(column.outside, 0u) << column.name;
      EXPECT_HAS(column.problem, "against");
    }
  }
  Columns changed = half;
  proxy_x(changed, 399) += 1;
  EXPECT_EQ(divergence(compare(lift(), changed)).tick, 399u);
  EXPECT_EQ(divergence(compare(changed, lift())).tick, 399u);
}

TEST(CompareTraces, NoRowsAreNotTheSame) {
  const Columns none = shortened(lift(), 0);
  for (const auto& [baseline, candidate] :
       {std::pair(none, none), std::pair(none, lift()), std::pair(lift(), none)}) {
    const TraceComparison comparison = compare(baseline, candidate);
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.divergence);
    for (const ColumnComparison& column : comparison.columns) EXPECT_FALSE(column.problem.empty());
  }
  EXPECT_FALSE(compare({}, {}).is_same());
  EXPECT_FALSE(compare({}, lift()).is_same());
}

// --- in what situation the runs part ---

TEST(Causes, Drift) {
  const std::size_t tick = quiet_tick();
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.situation, Cause::drift);
  EXPECT_HAS(found.because, "no frame came in and the state, ");
  EXPECT_HAS(found.because, "did not change");
}

TEST(Causes, FrameUpdate) {
  const std::size_t tick = tick_where(true, false);
  Columns columns = lift();
  const std::string frame = "frame " + std::to_string(integers(columns, "frame_index")[tick]);
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(found.cause, Cause::frame_update);
  EXPECT_EQ(found.because, frame + " came in with this tick, the same in both");
  // A tick before and a tick after it are none.
  for (const std::size_t other : {tick - 1, tick + 1})
    EXPECT_NE(divergence(after([&](Columns& c) { proxy_x(c, other) += 1e-9; })).cause, Cause::frame_update);
}

TEST(Causes, TheVeryFirstFrameIsAnUpdate) {
  Columns columns = lift();
  const auto first_tick = [&](std::int32_t frame) {
    auto& frames = integers(columns, "frame_index");
    for (std::size_t i = 0; i < 30; ++i) frames[i] = frame;
    Columns changed = columns;
    proxy_x(changed, 0) += 1;
    return divergence(compare(columns, changed));
  };
  EXPECT_EQ(first_tick(0).cause, Cause::frame_update);
  EXPECT_EQ(first_tick(-1).cause, Cause::drift);
}

TEST(Causes, StateTransition) {
  // Both change it: something else differs in the tick of the change.
  const std::size_t tick = tick_where(false, true);
  const Divergence both = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(both.cause, Cause::state_transition);
  // One changes it.
  const std::size_t quiet = quiet_tick();
  Columns steady = lift(), leaves = lift();
  integers(steady, "state")[quiet - 1] = integers(steady, "state")[quiet] = 1;
  leaves = steady;
  integers(leaves, "state")[quiet] = 0;
  const std::string stays = "contact to contact", goes = "contact to free";
  EXPECT_EQ(divergence(compare(steady, leaves)).because, "baseline " + stays + ", candidate " + goes);
  EXPECT_EQ(divergence(compare(leaves, steady)).because, "baseline " + goes + ", candidate " + stays);
  EXPECT_EQ(divergence(compare(leaves, steady)).cause, Cause::state_transition);
  // There is none before the first tick.
  integers(steady, "frame_index")[0] = integers(leaves, "frame_index")[0] = -1;
  integers(leaves, "state")[0] = 2 - integers(steady, "state")[0];
  EXPECT_EQ(divergence(compare(steady, leaves)).cause, Cause::state_transition);
  EXPECT_EQ(divergence(compare(steady, leaves)).because, "baseline free, candidate entrenched");
}

TEST(Causes, EveryInput) {
  const std::size_t tick = quiet_tick();
  const std::pair<const char*, Change> inputs[] = {
      {"time", [&](Columns& c) { numbers(c, "time")[tick] += 1e-9; }},
      {"hip_position", [&](Columns& c) { numbers(c, "hip_position")[3 * tick + 2] += 1e-9; }},
      {"frame_hash", [&](Columns& c) { hashes(c, "frame_hash")[tick] ^= 1; }},
  };
  for (const auto& [name, change] : inputs) {
    const Divergence found = divergence(after([&, change = change](Columns& c) {
      change(c);
      proxy_x(c, tick) += 1;  // what follows from it
    }));
    EXPECT_EQ(found.cause, Cause::input) << name;
    EXPECT_EQ(found.because, std::string(name) + " differs; the renderer was given something else");
  }
  const Divergence all = divergence(after([&](Columns& c) {
    for (const auto& [name, change] : inputs) change(c);
  }));
  EXPECT_HAS(all.because, "time, hip_position, frame_hash differs");
  // A device that turns.
  Columns turning = lift(), turned;
  turning.push_back({"hip_orientation", "1", "", std::vector<double>(4 * length(), 0.5), 4, {}});
  turned = turning;
  numbers(turned, "hip_orientation")[4 * tick] = -0.5;
  EXPECT_HAS(divergence(compare(turning, turned)).because, "hip_orientation differs");
}

// Which frame is in use is the renderer's own doing when both were given the same.
TEST(Causes, AFrameThatOneDidNotTakeIsAFrameUpdate) {
  for (const std::size_t tick : {quiet_tick(), tick_where(true, false)}) {
    const Change change = [&](Columns& c) {
      integers(c, "frame_index")[tick] -= 1;
      proxy_x(c, tick) += 1;
    };
    const Divergence found = divergence(after(change));
    EXPECT_EQ(found.cause, Cause::frame_update);
    EXPECT_HAS(found.because, "one did not take the newest");
  }
}

// At the same place another distance to the true surface: the truth is another. At another place it follows.
TEST(Causes, TheTruthAloneIsAnInput) {
  const std::size_t tick = quiet_tick();
  const Change truth = [&](Columns& c) { numbers(c, "signed_distance")[tick] += 1e-3; };
  const Divergence alone = divergence(after(truth));
  EXPECT_EQ(alone.cause, Cause::input);
  EXPECT_HAS(alone.because, "signed_distance (the true surface) differs");
  const Divergence follows = divergence(after([&](Columns& c) {
    truth(c);
    proxy_x(c, tick) += 1e-3;
  }));
  EXPECT_EQ(follows.cause, Cause::drift);
}

TEST(Causes, TheConfigurationIsTheCauseAndTheSituationIsToldBeside) {
  const std::size_t tick = tick_where(true, false);
  const Texts differences = {"renderer.r1_m 0.004 against 0.005", "seed 1 against 2"};
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }, {}, differences));
  EXPECT_EQ(found.cause, Cause::configuration);
  EXPECT_EQ(found.because, "renderer.r1_m 0.004 against 0.005, seed 1 against 2");
  EXPECT_EQ(found.situation, Cause::frame_update);
  EXPECT_HAS(found.seen, "came in with this tick");
}

// Configuration before input before frame update before state transition before drift: at a tick that is
// all of these, taken away one by one.
TEST(Causes, HaveAnOrder) {
  const std::size_t tick = tick_where(true, false);
  Columns baseline = lift(), candidate;
  auto& state = integers(baseline, "state");
  state[tick] = (state[tick - 1] + 1) % 3;
  candidate = baseline;
  proxy_x(candidate, tick) += 1e-3;
  numbers(candidate, "hip_position")[3 * tick] += 1e-3;
  const auto cause = [&](const Texts& configuration = {}) {
    return divergence(compare(baseline, candidate, {}, configuration)).cause;
  };
  EXPECT_EQ(cause({"seed 1 against 2"}), Cause::configuration);
  EXPECT_EQ(cause(), Cause::input);
  numbers(candidate, "hip_position")[3 * tick] = numbers(baseline, "hip_position")[3 * tick];
  EXPECT_EQ(cause(), Cause::frame_update);
  for (Columns* columns : {&baseline, &candidate})
    integers(*columns, "frame_index")[tick] = integers(*columns, "frame_index")[tick - 1];
  EXPECT_EQ(cause(), Cause::state_transition);
  for (Columns* columns : {&baseline, &candidate}) integers(*columns, "state")[tick] = state[tick - 1];
  EXPECT_EQ(cause(), Cause::drift);
}

// What comes after the runs parted is a consequence, or at least cannot have been the cause.
TEST(Causes, AreThoseOfTheTickAtWhichTheRunsPart) {
  const std::size_t tick = quiet_tick();
  const Divergence found = divergence(after([&](Columns& c) {
    proxy_x(c, tick) += 1e-9;
    numbers(c, "hip_position")[3 * (tick + 1)] += 1;
    integers(c, "state")[tick + 1] = (integers(c, "state")[tick] + 1) % 3;
    hashes(c, "frame_hash")[tick + 2] ^= 1;
  }));
  EXPECT_EQ(found.cause, Cause::drift);
}

// Columns that a trace does not have are no obstacle.
TEST(Causes, WithoutFramesAndStates) {
  Columns bare, changed;
  for (const char* name : {"time", "proxy_position"}) bare.push_back(find(lift(), name));
  changed = bare;
  proxy_x(changed, 200) += 1;
  const Divergence found = divergence(compare(bare, changed));
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_HAS(found.because, "the state, unknown,");
  EXPECT_EQ(found.frame, "unknown: the traces have no frame_index here");
}

TEST(Causes, HaveNames) {
  std::set<std::string> names;
  for (const Cause cause :
       {Cause::configuration, Cause::input, Cause::frame_update, Cause::state_transition, Cause::drift})
    names.insert(name_of(cause));
  EXPECT_EQ(names.size(), 5u);
}

// --- what is shown of it ---

TEST(Rows, OfTheTickBeforeAndOfTheTickItself) {
  const std::size_t tick = 640;
  const Divergence found = divergence(after([&](Columns& c) {
    proxy_x(c, tick) = 7;
    numbers(c, "force")[3 * (tick + 1)] = 8;
  }));
  EXPECT_EQ(found.first_row, tick - 1);
  ASSERT_EQ(found.baseline.size(), lift().size() - 1);
  ASSERT_EQ(found.candidate.size(), lift().size() - 1);
  const ColumnsInMemory all(lift());
  for (std::size_t i = 0; i < found.baseline.size(); ++i) {
    const Column want = all.rows(lift()[i].name, tick - 1, 2);
    EXPECT_EQ(found.baseline[i].name, want.name);
    EXPECT_EQ(found.baseline[i].units, want.units);
    EXPECT_EQ(found.baseline[i].value_names, want.value_names);
    EXPECT_EQ(found.baseline[i].values, want.values) << want.name;
    EXPECT_EQ(found.candidate[i].values == want.values, want.name != "proxy_position") << want.name;
  }
  EXPECT_EQ(std::get<std::vector<double>>(find(found.candidate, "proxy_position").values)[3], 7);
}

// Columns that one of them has not, not that far or as something else are left out, and tell nothing.
TEST(Rows, AreOfColumnsThatBothHave) {
  const std::size_t tick = quiet_tick();
  for (const char* odd : {"state", "frame_index", "frame_hash", "status"}) {
    Columns baseline = lift(), another_kind = lift(), shorter = lift();
    for (Columns* candidate : {&another_kind, &shorter}) {
      candidate->erase(candidate->begin() + 1);
      proxy_x(*candidate, tick) += 1;
    }
    find(another_kind, odd).values = std::vector<double>(length(), 0.5);
    find(shorter, odd) = ColumnsInMemory(baseline).rows(odd, 0, tick);
    for (const auto& [first, second] : {std::pair(baseline, another_kind), std::pair(baseline, shorter),
                                        std::pair(another_kind, baseline), std::pair(shorter, baseline)}) {
      const Divergence found = divergence(compare(first, second));
      EXPECT_EQ(found.tick, tick);
      EXPECT_EQ(found.cause, Cause::drift);
      EXPECT_EQ(found.baseline.size(), lift().size() - 3);  // without tick_hash too
      ASSERT_EQ(found.candidate.size(), found.baseline.size());
      for (std::size_t i = 0; i < found.baseline.size(); ++i) {
        EXPECT_EQ(found.baseline[i].name, found.candidate[i].name);
        for (const std::string absent : {"hip_position", odd}) EXPECT_NE(found.baseline[i].name, absent);
      }
    }
  }
}

TEST(FrameText, TellsTheFrameAndTheNextOne) {
  Columns columns = lift();
  auto& frames = integers(columns, "frame_index");
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i] = i < 10 ? -1 : i < 50 ? 0 : i < 90 ? 4 : 5;  // frames 1 to 3 were dropped
  const auto at = [&](std::size_t tick) {
    Columns changed = columns;
    proxy_x(changed, tick) += 1;
    return divergence(compare(columns, changed)).frame;
  };
  EXPECT_EQ(at(0), "none had come yet");
  EXPECT_EQ(at(9), "none had come yet");
  EXPECT_EQ(at(10), "frame 0 since tick 10, frame 4 with tick 50");
  EXPECT_EQ(at(49), "frame 0 since tick 10, frame 4 with tick 50");
  EXPECT_EQ(at(50), "frame 4 since tick 50, frame 5 with tick 90");
  EXPECT_EQ(at(length() - 1), "frame 5 since tick 90");
}

// --- files ---

// From files, read in pieces, comes what comes from memory; 5000 ticks are stored in chunks.
TEST(CompareTraces, FilesAreAsGoodAsMemory) {
  const TestFolder folder("trace_comparison_test");
  const Columns baseline = simulate(Experiment::load("fig4.14", {"duration_s=5"})).columns();
  ASSERT_EQ(baseline.front().length(), 5000u);
  Columns candidate = baseline;
  proxy_x(candidate, 4096) += 1e-12;
  numbers(candidate, "force")[3 * 4500] += 1;
  write_trace(folder / "a.h5", baseline, {}, {}), write_trace(folder / "b.h5", candidate, {}, {});
  const StoredTrace a(folder / "a.h5"), b(folder / "b.h5");
  EXPECT_TRUE(compare_traces(a, a, {}, {}).is_same());
  const Tolerances tolerances = {{"*", {1e-9, 0}}};
  const TraceComparison stored = compare_traces(a, b, tolerances, {}),
                        held = compare(baseline, candidate, tolerances);
  const Divergence from_files = divergence(stored), from_memory = divergence(held);
  EXPECT_EQ(from_files.tick, 4500u);
  EXPECT_EQ(from_files.parted, 4096u);
  EXPECT_EQ(from_files.quantity, "force");
  EXPECT_EQ(from_files.deviation, from_memory.deviation);
  EXPECT_EQ(from_files.because, from_memory.because);
  EXPECT_EQ(from_files.frame, from_memory.frame);
  ASSERT_EQ(from_files.baseline.size(), from_memory.baseline.size());
  for (std::size_t i = 0; i < from_files.baseline.size(); ++i) {
    EXPECT_EQ(from_files.baseline[i].values, from_memory.baseline[i].values);
    EXPECT_EQ(from_files.candidate[i].values, from_memory.candidate[i].values);
  }
  ASSERT_EQ(stored.columns.size(), held.columns.size());
  for (std::size_t i = 0; i < stored.columns.size(); ++i)
    EXPECT_EQ(stored.columns[i].largest, held.columns[i].largest);
}

}  // namespace
}  // namespace remote_touch
