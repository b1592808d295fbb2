// Comparison of two traces: what differs, from which tick on, in which situation, and its explanation.
#include "analysis/storage/trace_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "analysis/storage/result_file.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::trace_comparison_test {
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

// Returns the first tick, not before `from`, in which the frame is new if new_frame (else the same as before)
// and the state is new if new_state (else the same).
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
// Returns the divergence. If there is none, the test fails and a default divergence is returned.
Divergence divergence(const TraceComparison& comparison) {
  EXPECT_FALSE(comparison.is_same());
  EXPECT_TRUE(comparison.divergence);
  return comparison.divergence.value_or(Divergence{});
}

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
  // The running hash is not judged.
  EXPECT_TRUE(after([](Columns& c) { hashes(c, "tick_hash")[3] ^= 1; }).is_same());
  EXPECT_TRUE(after([](Columns& c) { c.pop_back(); }).is_same());
  EXPECT_TRUE(compare(Columns(lift().begin(), lift().end() - 1), lift()).added.empty());
  // Traces with the same numbers are the same, even if their experiments differ.
  EXPECT_TRUE(compare(lift(), lift(), {}, {"renderer.r1_m 1 against 2"}).is_same());
}

// Each column in turn is changed from a random tick to the end.
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
    EXPECT_EQ(found.first_difference, tick) << column.name;
    EXPECT_EQ(found.quantity, column.name);
    EXPECT_DOUBLE_EQ(found.time_s, 0.001 * static_cast<double>(tick));
    EXPECT_NEAR(found.deviation, column.width == 3 ? std::sqrt(3.0) : 1, 1e-12) << column.name;
  }
}

// Neither the order nor the size of the changes matters.
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

// The runs begin to differ within the tolerance, and exceed it later. Both ticks are reported, and the
// situation is that at the first difference.
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
  EXPECT_EQ(found.first_difference, quiet);
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.first_row, quiet - 1);
  EXPECT_EQ(find(found.candidate, "force").length(), 2u);
  for (const ColumnComparison& column : comparison.columns) {
    const bool force = column.name == "force", proxy = column.name == "proxy_position";
    EXPECT_EQ(column.is_same(), !proxy) << column.name;
    EXPECT_EQ(column.first_difference.has_value(), force || proxy) << column.name;
  }
  // The same two runs diverge at the first difference if there is no tolerance.
  const Divergence exact = divergence(after(change));
  EXPECT_EQ(exact.tick, quiet);
  EXPECT_EQ(exact.quantity, "force");
  // They are the same within a tolerance that is wide enough, but the difference is reported.
  const TraceComparison wide = after(change, {{"*", {0.1, 0}}});
  EXPECT_TRUE(wide.is_same());
  EXPECT_FALSE(wide.divergence);
  EXPECT_NEAR(wide.columns[2].max, 1e-3, 1e-12);
  EXPECT_EQ(divergence(after(change, {{"force", {1, 0}}})).quantity, "proxy_position");
  // A number against none is a divergence whatever the tolerance.
  const Divergence none =
      divergence(after([&](Columns& c) { proxy_x(c, later) = kNaN; }, {{"*", {kInfinity, kInfinity}}}));
  EXPECT_EQ(none.tick, later);
  EXPECT_TRUE(std::isnan(none.deviation));
}

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
  // The column is of another experiment, not of a later program.
  const TraceComparison other = compare(less, lift(), {}, {"seed 1 against 2"});
  EXPECT_TRUE(other.added.empty());
  EXPECT_EQ(other.columns.back().name, "time");
  EXPECT_EQ(other.columns.back().problem, "missing in the baseline");
  for (std::size_t i = 0; i + 1 < lift().size(); ++i) {  // all but the running hash
    Columns without = lift();
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(compare(lift(), without).is_same()) << lift()[i].name;
    EXPECT_FALSE(compare(without, lift(), {}, {"seed 1 against 2"}).is_same()) << lift()[i].name;
  }
  // A divergence is found in the other columns.
  Columns changed = less;
  proxy_x(changed, 300) += 1;
  EXPECT_EQ(divergence(compare(lift(), changed)).tick, 300u);
  const Divergence untimed = divergence(compare(less, changed));
  EXPECT_EQ(untimed.tick, 300u);
  EXPECT_TRUE(std::isnan(untimed.time_s));
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
    EXPECT_FALSE(comparison.divergence);  // the ticks that both have are equal
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
  // No rows are not the same.
  const Columns none = shortened(lift(), 0);
  for (const auto& [baseline, candidate] :
       {std::pair(none, none), std::pair(none, lift()), std::pair(lift(), none),
        std::pair(Columns{}, Columns{}), std::pair(Columns{}, lift())}) {
    const TraceComparison comparison = compare(baseline, candidate);
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.divergence);
  }
}

// Files, read in pieces, give the same comparison as columns in memory; 5000 ticks are stored in chunks.
TEST(CompareTraces, FilesGiveTheSameResultAsMemory) {
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
  EXPECT_EQ(from_files.first_difference, 4096u);
  EXPECT_EQ(from_files.quantity, "force");
  EXPECT_EQ(from_files.deviation, from_memory.deviation);
  EXPECT_EQ(from_files.explanation, from_memory.explanation);
  EXPECT_EQ(from_files.frame, from_memory.frame);
  ASSERT_EQ(from_files.baseline.size(), from_memory.baseline.size());
  for (std::size_t i = 0; i < from_files.baseline.size(); ++i)
    EXPECT_EQ(from_files.baseline[i].values, from_memory.baseline[i].values);
}

// --- the situation in which the runs begin to differ ---

TEST(Causes, FrameUpdate) {
  const std::size_t tick = tick_where(true, false);
  Columns columns = lift();
  const std::string frame = "frame " + std::to_string(integers(columns, "frame_index")[tick]);
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(found.cause, Cause::frame_update);
  EXPECT_EQ(found.explanation, frame + " arrived in this tick, the same in both");
  // The ticks before and after it are not frame updates.
  for (const std::size_t other : {tick - 1, tick + 1})
    EXPECT_NE(divergence(after([&](Columns& c) { proxy_x(c, other) += 1e-9; })).cause, Cause::frame_update);
  // The very first frame is one.
  const auto first_tick = [&](std::int32_t first_frame) {
    auto& frames = integers(columns, "frame_index");
    for (std::size_t i = 0; i < 30; ++i) frames[i] = first_frame;
    Columns changed = columns;
    proxy_x(changed, 0) += 1;
    const Divergence first = divergence(compare(columns, changed));
    EXPECT_EQ(first.tick + first.first_row, 0u);
    for (const Column& column : first.candidate) EXPECT_EQ(column.length(), 1u) << column.name;
    return first.cause;
  };
  EXPECT_EQ(first_tick(0), Cause::frame_update);
  EXPECT_EQ(first_tick(-1), Cause::drift);
  // The frame in use is the renderer's own choice if both renderers were given the same frames.
  for (const std::size_t other : {quiet_tick(), tick}) {
    const Divergence not_taken = divergence(after([&](Columns& c) {
      integers(c, "frame_index")[other] -= 1;
      proxy_x(c, other) += 1;
    }));
    EXPECT_EQ(not_taken.cause, Cause::frame_update);
    EXPECT_HAS(not_taken.explanation, "one did not use the newest");
  }
}

TEST(Causes, StateTransition) {
  // Both runs change the state, and something else differs in that tick.
  const std::size_t tick = tick_where(false, true);
  const Divergence both = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(both.cause, Cause::state_transition);
  // One run changes the state.
  const std::size_t quiet = quiet_tick();
  Columns steady = lift(), leaves = lift();
  integers(steady, "state")[quiet - 1] = integers(steady, "state")[quiet] = 1;
  leaves = steady;
  integers(leaves, "state")[quiet] = 0;
  const std::string stays = "contact to contact", goes = "contact to free";
  EXPECT_EQ(divergence(compare(steady, leaves)).explanation, "baseline " + stays + ", candidate " + goes);
  EXPECT_EQ(divergence(compare(leaves, steady)).explanation, "baseline " + goes + ", candidate " + stays);
  EXPECT_EQ(divergence(compare(leaves, steady)).cause, Cause::state_transition);
  // There is no state before the first tick.
  integers(steady, "frame_index")[0] = integers(leaves, "frame_index")[0] = -1;
  integers(leaves, "state")[0] = 2 - integers(steady, "state")[0];
  EXPECT_EQ(divergence(compare(steady, leaves)).cause, Cause::state_transition);
  EXPECT_EQ(divergence(compare(steady, leaves)).explanation, "baseline free, candidate entrenched");
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
      proxy_x(c, tick) += 1;  // a consequence of the change
    }));
    EXPECT_EQ(found.cause, Cause::input) << name;
    EXPECT_EQ(found.explanation, name);
  }
  const Divergence all = divergence(after([&](Columns& c) {
    for (const auto& [name, change] : inputs) change(c);
  }));
  EXPECT_EQ(all.explanation, "time, hip_position, frame_hash");
  // If the same position has another distance to the true surface, the truth differs. If the position differs
  // too, the distance differs as a consequence.
  const Change truth = [&](Columns& c) { numbers(c, "signed_distance")[tick] += 1e-3; };
  EXPECT_EQ(divergence(after(truth)).explanation, "signed_distance (the true surface)");
  EXPECT_EQ(divergence(after([&](Columns& c) { truth(c), proxy_x(c, tick) += 1e-3; })).cause, Cause::drift);
  // The orientation of the device is an input too.
  Columns turning = lift(), turned;
  turning.push_back({"hip_orientation", "1", "", std::vector<double>(4 * length(), 0.5), 4, {}});
  turned = turning;
  numbers(turned, "hip_orientation")[4 * tick] = -0.5;
  EXPECT_EQ(divergence(compare(turning, turned)).explanation, "hip_orientation");
}

TEST(Causes, TheConfigurationIsTheCauseAndTheSituationIsAdded) {
  const std::size_t tick = tick_where(true, false);
  const Texts differences = {"renderer.r1_m 0.004 against 0.005", "seed 1 against 2"};
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }, {}, differences));
  EXPECT_EQ(found.cause, Cause::configuration);
  EXPECT_EQ(found.explanation, "renderer.r1_m 0.004 against 0.005, seed 1 against 2");
  EXPECT_EQ(found.situation, Cause::frame_update);
  EXPECT_HAS(found.observation, "arrived in this tick");
}

// The order is configuration, input, frame update, state transition, drift. The test begins with a tick that
// has all of these causes and removes them one by one.
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

// Differences after the first different tick are consequences, or at least cannot be the cause.
TEST(Causes, AreThoseOfTheTickAtWhichTheRunsPart) {
  const std::size_t tick = quiet_tick();
  const Divergence found = divergence(after([&](Columns& c) {
    proxy_x(c, tick) += 1e-9;
    numbers(c, "hip_position")[3 * (tick + 1)] += 1;
    integers(c, "state")[tick + 1] = (integers(c, "state")[tick] + 1) % 3;
    hashes(c, "frame_hash")[tick + 2] ^= 1;
  }));
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.situation, Cause::drift);
  EXPECT_HAS(found.explanation, "no frame arrived and the state, ");
  EXPECT_HAS(found.explanation, "did not change");
}

// Missing columns do not prevent an explanation.
TEST(Causes, DriftIsTheCauseIfFramesAndStatesAreMissing) {
  Columns bare, changed;
  for (const char* name : {"time", "proxy_position"}) bare.push_back(find(lift(), name));
  changed = bare;
  proxy_x(changed, 200) += 1;
  const Divergence found = divergence(compare(bare, changed));
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_HAS(found.explanation, "the state, unknown,");
  EXPECT_EQ(found.frame, "unknown: the traces have no frame_index here");
}

// --- the rows and the frame that are shown ---

TEST(Rows, ShowTheTickBeforeAndTheTickItself) {
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

// A column is left out, and does not affect the cause, if one trace lacks it, has too few rows of it or has
// another type.
TEST(Rows, ShowOnlyColumnsThatBothHave) {
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
      EXPECT_EQ(found.baseline.size(), lift().size() - 3);  // tick_hash is left out too
      ASSERT_EQ(found.candidate.size(), found.baseline.size());
      for (std::size_t i = 0; i < found.baseline.size(); ++i) {
        EXPECT_EQ(found.baseline[i].name, found.candidate[i].name);
        for (const std::string absent : {"hip_position", odd}) EXPECT_NE(found.baseline[i].name, absent);
      }
    }
  }
}

TEST(FrameText, NamesTheFrameAndTheNextOne) {
  Columns columns = lift();
  auto& frames = integers(columns, "frame_index");
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i] = i < 10 ? -1 : i < 50 ? 0 : i < 90 ? 4 : 5;  // frames 1 to 3 were dropped
  const auto at = [&](std::size_t tick) {
    Columns changed = columns;
    proxy_x(changed, tick) += 1;
    return divergence(compare(columns, changed)).frame;
  };
  EXPECT_EQ(at(0), "no frame had arrived yet");
  EXPECT_EQ(at(9), "no frame had arrived yet");
  EXPECT_EQ(at(10), "frame 0 since tick 10, frame 4 with tick 50");
  EXPECT_EQ(at(49), "frame 0 since tick 10, frame 4 with tick 50");
  EXPECT_EQ(at(50), "frame 4 since tick 50, frame 5 with tick 90");
  EXPECT_EQ(at(length() - 1), "frame 5 since tick 90");
}

}  // namespace
}  // namespace remote_touch::trace_comparison_test
