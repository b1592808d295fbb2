// The situation in which two traces begin to differ, and its explanation.
#include <gtest/gtest.h>

#include <set>

#include "analysis/storage/trace_comparison.h"
#include "tests/analysis/storage/changed_traces.h"
#include "tests/support/test_files.h"

namespace remote_touch::divergence_test {
namespace {

using namespace changed_traces;

// --- the situation in which the runs begin to differ ---

TEST(Causes, Drift) {
  const std::size_t tick = quiet_tick();
  const Divergence found = divergence(after([&](Columns& c) { proxy_x(c, tick) += 1e-9; }));
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.situation, Cause::drift);
  EXPECT_HAS(found.explanation, "no frame arrived and the state, ");
  EXPECT_HAS(found.explanation, "did not change");
}

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
  // The orientation of the device is an input too.
  Columns turning = lift(), turned;
  turning.push_back({"hip_orientation", "1", "", std::vector<double>(4 * length(), 0.5), 4, {}});
  turned = turning;
  numbers(turned, "hip_orientation")[4 * tick] = -0.5;
  EXPECT_EQ(divergence(compare(turning, turned)).explanation, "hip_orientation");
}

// The frame in use is the renderer's own choice if both renderers were given the same frames.
TEST(Causes, AFrameThatOneDidNotTakeIsAFrameUpdate) {
  for (const std::size_t tick : {quiet_tick(), tick_where(true, false)}) {
    const Change change = [&](Columns& c) {
      integers(c, "frame_index")[tick] -= 1;
      proxy_x(c, tick) += 1;
    };
    const Divergence found = divergence(after(change));
    EXPECT_EQ(found.cause, Cause::frame_update);
    EXPECT_HAS(found.explanation, "one did not use the newest");
  }
}

// If the same position has another distance to the true surface, the truth differs. If the position differs
// too, the distance differs as a consequence.
TEST(Causes, TheTruthAloneIsAnInput) {
  const std::size_t tick = quiet_tick();
  const Change truth = [&](Columns& c) { numbers(c, "signed_distance")[tick] += 1e-3; };
  const Divergence alone = divergence(after(truth));
  EXPECT_EQ(alone.cause, Cause::input);
  EXPECT_EQ(alone.explanation, "signed_distance (the true surface)");
  const Divergence follows = divergence(after([&](Columns& c) {
    truth(c);
    proxy_x(c, tick) += 1e-3;
  }));
  EXPECT_EQ(follows.cause, Cause::drift);
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

TEST(Causes, HaveNames) {
  std::set<std::string> names;
  for (const Cause cause :
       {Cause::configuration, Cause::input, Cause::frame_update, Cause::state_transition, Cause::drift})
    names.insert(name_of(cause));
  EXPECT_EQ(names.size(), 5u);
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
}  // namespace remote_touch::divergence_test
