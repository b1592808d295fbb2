// Runs of a sweep: the bits of single runs, failures, an early end, refinement.
#include "runners/sweep/sweep_run.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_run_test {
namespace {

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 4}],
  "replicates": 2, "measures": ["max_penetration", "popped_through"]})";

Sweep quick(const std::vector<std::string>& overrides = {}) {
  return Sweep::from_json(kQuick, "quick.json", overrides);
}
Sweep refined() {
  return quick({"axes.1.count=3", "refine.budget=70", "refine.levels=2", "refine.max_replicates=5"});
}

void expect_same(const SweepResult& a, const SweepResult& b) {
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.round, b.round);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.notes, b.notes);
  ASSERT_EQ(a.measures.size(), b.measures.size());
  for (const Column& measure : a.measures)
    for (std::size_t run = 0; run < a.held_count(); ++run)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.measure(measure.name)[run]),
                std::bit_cast<std::uint64_t>(b.measure(measure.name)[run]))
          << measure.name << " of run " << run;
}

TEST(SweepRuns, HaveTheBitsOfSingleRuns) {
  const Sweep sweep = quick();
  const SweepResult result = run_sweep(sweep, {});
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const Trace trace = simulate(sweep.experiment(result.cell_of(run), result.replicate_of(run)));
    EXPECT_EQ(result.measure("max_penetration")[run], max_penetration_m(trace));
    EXPECT_EQ(result.measure("popped_through")[run], popped_through(trace));
  }
  // Replicates differ in their noise, if there is any.
  EXPECT_EQ(result.measure("max_penetration")[0], result.measure("max_penetration")[1]);
  EXPECT_NE(result.measure("max_penetration")[22], result.measure("max_penetration")[23]);
}

// The press of fig4.12 begins at 0.5 s.
TEST(SweepRuns, StoreTheNotesOfSingleRuns) {
  const Sweep sweep =
      quick({R"(axes=[{"parameter": "duration_s", "values": [0.2, 0.45, 0.8666666666666667]}])"});
  const SweepResult result = run_sweep(sweep, {});
  ASSERT_EQ(result.notes.size(), 6u);
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    RunReport report;
    SimulationOptions options;
    options.report = &report;
    simulate(sweep.experiment(result.cell_of(run), result.replicate_of(run)), options);
    EXPECT_EQ(result.notes[run], note_bits(report.notes)) << run;
    EXPECT_EQ((result.notes[run] & note_bits({{"phase not reached", ""}})) != 0u, run < 4) << run;
  }
}

// The hand presses beside the grid with the second value of the axis, where a position below the plane has no
// side.
TEST(SweepRuns, HaveANoteIfTheirOutcomeIsUnknown) {
  const std::uint64_t bit = note_bits({{"outcome unknown", ""}});
  const std::string axis = R"(axes=[{"parameter": "trajectory.start_m.0", "values": [0, 1]}])";
  const Sweep sweep = quick({"replicates=1", axis});
  const SweepResult result = run_sweep(sweep, {});
  EXPECT_FALSE(std::isnan(result.measure("popped_through")[0]));
  EXPECT_TRUE(std::isnan(result.measure("popped_through")[1]));
  EXPECT_EQ(result.notes[0] & bit, 0u);
  EXPECT_EQ(result.notes[1] & bit, bit);
  const StoredSweep stored{result, {}, false};
  EXPECT_EQ(note_bits(replay_run(stored.attributes, sweep, 1, {}, "", Strict::no).report.notes) & bit, bit);
  const SweepResult other = run_sweep(quick({"replicates=1", axis, R"(measures=["max_penetration"])"}), {});
  EXPECT_EQ(other.notes[1] & bit, 0u) << "the outcome is not measured";
}

TEST(SweepRuns, DoNotDependOnThreads) {
  for (const Sweep& sweep : {quick(), refined()}) {
    omp_set_num_threads(1);
    const SweepResult one = run_sweep(sweep, {});
    for (const int threads : {2, 8}) {
      omp_set_num_threads(threads);
      expect_same(run_sweep(sweep, {}), one);
    }
  }
}

TEST(SweepRuns, OnlyPendingRunsAreDoneAndEachIsReportedOnce) {
  const Sweep sweep = quick();
  SweepResult result = sweep.plan();
  for (std::size_t run = 0; run < result.run_count(); run += 3) result.state[run] = RunState::not_sampled;
  std::vector<int> reported(result.run_count(), 0);
  SweepRunOptions options;
  options.finished = [&](std::size_t place) {
    EXPECT_EQ(result.state[place], RunState::done);
    ++reported[place];
  };
  do_pending_runs(sweep, result, options);
  for (std::size_t run = 0; run < reported.size(); ++run) {
    const bool was_pending = run % 3 != 0;
    EXPECT_EQ(reported[run], was_pending ? 1 : 0);
    EXPECT_EQ(result.state[run], was_pending ? RunState::done : RunState::not_sampled);
    EXPECT_EQ(std::isnan(result.measure("popped_through")[run]), !was_pending);
  }
}

TEST(SweepRuns, OfAShardHaveTheBitsOfTheWholeSweep) {
  const Sweep sweep = quick();
  const SweepResult whole = run_sweep(sweep, {});
  for (const int index : {1, 2, 3}) {
    SweepResult part = sweep.plan({index, 3});
    EXPECT_EQ(part.held_count(), 8u);
    do_pending_runs(sweep, part, {});
    for (std::size_t place = 0; place < part.held_count(); ++place) {
      const std::size_t run = part.run_at(place);
      EXPECT_EQ(part.state[place], RunState::done);
      EXPECT_EQ(part.notes[place], whole.notes[run]);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(part.measure("max_penetration")[place]),
                std::bit_cast<std::uint64_t>(whole.measure("max_penetration")[run]));
    }
    const SweepResult expanded = whole_of(part);
    EXPECT_EQ(expanded.runs_in(RunState::done).size(), 8u);
    EXPECT_EQ(expanded.runs_in(RunState::elsewhere).size(), 16u);
  }
}

TEST(SweepRuns, OfChosenNumbersHaveTheBitsOfTheWholeSweep) {
  const Sweep sweep = quick();
  const SweepResult whole = run_sweep(sweep, {});
  SweepResult part = sweep.part({3, 4, 23});
  ASSERT_EQ(part.runs_in(RunState::pending).size(), 3u);
  do_pending_runs(sweep, part, {});
  SweepResult others = whole;
  others.part = part.part;
  others.start(false);
  for (std::size_t place = 0; place < 3; ++place) {
    const std::size_t run = part.run_at(place);
    others.state[place] = RunState::done, others.notes[place] = whole.notes[run];
    for (Column& measure : others.measures)
      std::get<std::vector<double>>(measure.values)[place] = whole.measure(measure.name)[run];
  }
  expect_same(part, others);
  for (const std::vector<std::uint64_t>& wrong : {std::vector<std::uint64_t>{4, 3}, {3, 3}, {23, 24}})
    EXPECT_THROW(sweep.part(wrong), InputError);
}

// An interrupted sweep has reported each run that is done, and the others are pending. A second thread may do
// any number of runs after an exception, until the first one has passed it on.
TEST(SweepRuns, EndEarlyWithoutLosingRuns) {
  const Sweep sweep = quick();
  for (const auto& end : {std::pair{true, 1}, {false, 1}, {true, 2}, {false, 2}}) {
    const bool by_signal = end.first;  // no structured binding: clang++ 14 captures none in a lambda
    const int threads = end.second;
    omp_set_num_threads(threads);
    SweepResult result = sweep.plan();
    std::atomic<bool> stop{false};
    std::size_t reported = 0;
    SweepRunOptions options;
    options.stop = &stop;
    options.finished = [&](std::size_t) {
      if (++reported != 5) return;
      if (!by_signal) throw std::out_of_range("a full disk");
      stop = true;
    };
    if (by_signal) {
      EXPECT_THROW(do_pending_runs(sweep, result, options), Interrupted);
    } else {
      EXPECT_THROW(do_pending_runs(sweep, result, options), std::out_of_range);
    }
    EXPECT_GE(reported, 5u);
    EXPECT_LE(reported, threads == 1 ? 5u : by_signal ? 6u : 24u);
    EXPECT_EQ(result.runs_in(RunState::done).size(), reported);
    EXPECT_EQ(result.runs_in(RunState::pending).size(), 24 - reported);
  }
}

// A recording is opened when its run begins.
TEST(SweepRuns, AFailureIsReportedAndTheOthersContinue) {
  const TestFolder folder("sweep_run_test");
  const CameraIntrinsics camera{64, 48, 50, 50, 31.5, 23.5};
  const std::string sound = folder.write("sound.pcd", organised_pcd(camera, 0)).string();
  const std::string missing = (folder / "missing.pcd").string();
  const Sweep sweep = Sweep::from_json(
      R"({"experiment": {"scenario": {"name": "recording", "path": "x"}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "image-scan"}, "duration_s": 0.1}, "measures": ["mean_steps"],
      "axes": [{"parameter": "scenario.path", "values": [")" +
          sound + R"(", ")" + missing + R"("]}, {"parameter": "seed", "values": [1, 2]}]})",
      "recordings");
  SweepResult result = sweep.plan();
  do_pending_runs(sweep, result, {});
  for (std::size_t run = 0; run < 4; ++run) {
    const bool fails = run >= 2;
    EXPECT_EQ(result.state[run], fails ? RunState::failed : RunState::done) << result.error[run];
    EXPECT_EQ(std::isnan(result.measure("mean_steps")[run]), fails);
    EXPECT_EQ(result.error[run].empty(), !fails);
    EXPECT_EQ(contains(result.error[run], "missing.pcd"), fails);
  }
  const SweepResult all = run_sweep(sweep, {});
  ASSERT_FALSE(all.runs_in(RunState::failed).empty());
  EXPECT_HAS(all.error[all.runs_in(RunState::failed).front()], "missing.pcd");
}

// Its path is longer than the message that is stored, and one of two neighbours is cut within a character.
TEST(SweepRuns, AMessageIsNotCutWithinACharacter) {
  std::string umlauts;
  for (int i = 0; i < 170; ++i) umlauts += i == 85 ? "/\xc3\xa4" : "\xc3\xa4";
  const Sweep sweep = Sweep::from_json(
      R"({"experiment": {"scenario": {"name": "recording", "path": "x"}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "image-scan"}, "duration_s": 0.1}, "measures": ["mean_steps"],
      "axes": [{"parameter": "scenario.path", "values": ["/)" +
          umlauts + R"(", "/x)" + umlauts + R"("]}]})",
      "recordings");
  const SweepResult result = run_sweep(sweep, {});
  for (const std::string& error : result.error) {
    EXPECT_GE(error.size(), 299u) << error;
    EXPECT_LE(error.size(), 300u);
    EXPECT_EQ(printable(error), error) << "UTF-8 stays as it is";
  }
  EXPECT_EQ(result.error[0].size() + result.error[1].size(), 599u);
}

// A stored sweep of an earlier version has no recipe.
TEST(Replays, HaveTheCommandOfTheirOwnProgram) {
  const Sweep sweep = quick();
  const StoredSweep stored{sweep.plan(), {{"command", "press-lab sweep quick.json"}}, false};
  identify_program({"press-lab", "12ab"});
  const Replay replay = replay_run(stored.attributes, sweep, 3, {}, "", Strict::no);
  identify_program({});
  EXPECT_EQ(attribute(replay.attributes, "command"),
            "press-lab sweep quick.json; press-lab replay --cell 0,1 --replicate 1");
}

TEST(Refinement, KeepsItsBudgetAndNumbersItsRounds) {
  const SweepResult result = run_sweep(refined(), {});
  EXPECT_EQ(result.runs_in(RunState::done).size(), 70u);
  std::int32_t last = 0;
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    EXPECT_EQ(result.round[run] >= 0, result.state[run] == RunState::done);
    last = std::max(last, result.round[run]);
    // The first round has every fourth value and two replicates.
    const auto indices = result.axis_indices(result.cell_of(run));
    const bool is_first = indices[0] % 4 == 0 && indices[1] % 4 == 0 && result.replicate_of(run) < 2;
    EXPECT_EQ(result.round[run] == 0, is_first);
  }
  EXPECT_GE(last, 2);
  SweepResult plain = run_sweep(quick(), {});
  EXPECT_FALSE(add_round(quick(), plain));
}

// A round depends on results alone: a sweep that is ended after every third run chooses the same runs.
TEST(Refinement, AnInterruptedRefinementGivesTheSameResult) {
  omp_set_num_threads(2);
  const Sweep sweep = refined();
  SweepResult result = sweep.plan();
  int ends = 0;
  do {
    while (!result.runs_in(RunState::pending).empty()) {
      int reported = 0;
      SweepRunOptions options;
      options.finished = [&](std::size_t) {
        if (++reported == 3) throw std::out_of_range("enough");
      };
      try {
        do_pending_runs(sweep, result, options);
      } catch (const std::out_of_range&) {
        ++ends;
      }
    }
  } while (add_round(sweep, result));
  EXPECT_GT(ends, 0);
  expect_same(result, run_sweep(sweep, {}));
}

// Returns a file of a sweep whose session forgets a run of this round when the last round has been done.
void make_forgetful(const Sweep& sweep, const std::filesystem::path& file, std::int32_t round) {
  SweepSession session(sweep, {}, {{"config", sweep.to_json()}}, file);
  const auto forget_at_the_end = [&](SweepResult& result, const auto& stored) -> std::size_t {
    do_pending_runs(sweep, result, {nullptr, nullptr, stored});
    SweepResult next = result;
    if (add_round(sweep, next)) return 0;
    const auto found = std::find(result.round.begin(), result.round.end(), round);
    session.forget({static_cast<std::size_t>(found - result.round.begin())}, "");
    throw std::out_of_range("forgotten");
  };
  EXPECT_THROW(session.run(forget_at_the_end, 1, [](auto...) {}), std::out_of_range);
}

// The runs of later rounds depend on the outcome that was wrong.
TEST(Refinement, AForgottenRunTakesTheLaterRoundsWithIt) {
  const Sweep sweep = refined();
  const SweepResult whole = run_sweep(sweep, {});
  const TestFolder folder("forgotten");
  for (const std::int32_t round : {0, 1}) {
    const auto file = folder / ("round" + std::to_string(round) + ".h5");
    make_forgetful(sweep, file, round);
    const StoredSweep stored = read_sweep(file);
    EXPECT_TRUE(stored.in_progress);
    EXPECT_EQ(*std::max_element(stored.result.round.begin(), stored.result.round.end()), round);
    EXPECT_EQ(stored.result.runs_in(RunState::pending).size(), 1u);
    SweepSession again(sweep, {}, {{"config", sweep.to_json()}}, file);
    EXPECT_TRUE(again.run(kernels_for(best_isa()), nullptr, [](auto...) {}));
    expect_same(std::get<SweepResult>(again.kept().kept), whole);
  }
}

}  // namespace
}  // namespace remote_touch::sweep_run_test
