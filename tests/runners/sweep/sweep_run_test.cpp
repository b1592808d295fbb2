// Runs of a sweep: their notes, an early end, messages of failures, and what a tally keeps of them. The tests
// command_line/sweep and python_module have their bits, threads, shards and refinement.
#include "runners/sweep/sweep_run.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_means.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_session.h"
#include "tests/runners/sweep/quick_sweeps.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_run_test {
namespace {

Sweep quick_runs(const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all = {"keep=runs", "replicates=2"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return quick_sweep(all);
}

// The press of fig4.12 begins at 0.5 s.
TEST(SweepRuns, StoreTheNotesOfSingleRuns) {
  const Sweep sweep =
      quick_runs({R"(axes=[{"parameter": "duration_s", "values": [0.2, 0.45, 0.8666666666666667]}])"});
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
  const Sweep sweep = quick_runs({"replicates=1", axis});
  const SweepResult result = run_sweep(sweep, {});
  EXPECT_FALSE(std::isnan(result.measure("popped_through")[0]));
  EXPECT_TRUE(std::isnan(result.measure("popped_through")[1]));
  EXPECT_EQ(result.notes[0] & bit, 0u);
  EXPECT_EQ(result.notes[1] & bit, bit);
  const StoredSweep stored{result, {}, false};
  EXPECT_EQ(note_bits(replay_run(stored.attributes, sweep, 1, {}, "", Strict::no).report.notes) & bit, bit);
  const SweepResult other =
      run_sweep(quick_runs({"replicates=1", axis, R"(measures=["max_penetration"])"}), {});
  EXPECT_EQ(other.notes[1] & bit, 0u) << "the outcome is not measured";
}

TEST(SweepRuns, OnlyPendingRunsAreDoneAndEachIsReportedOnce) {
  const Sweep sweep = quick_runs();
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

// An interrupted sweep has reported each run that is done, and the others are pending. A second thread may do
// any number of runs after an exception, until the first one has passed it on.
TEST(SweepRuns, EndEarlyWithoutLosingRuns) {
  const Sweep sweep = quick_runs();
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
  const Sweep sweep = quick_runs();
  const StoredSweep stored{sweep.plan(), {{"command", "press-lab sweep quick.json"}}, false};
  identify_program({"press-lab", "12ab"});
  const Replay replay = replay_run(stored.attributes, sweep, 3, {}, "", Strict::no);
  identify_program({});
  EXPECT_EQ(attribute(replay.attributes, "command"),
            "press-lab sweep quick.json; press-lab replay --cell 0,1 --replicate 1");
}

// --- sweeps that keep tallies ---

class TallySessions : public QuickSweeps {
 protected:
  TallySessions() : QuickSweeps("tally_session_test") {}
};

TEST_F(TallySessions, HaveTheSumsOfTheRuns) {
  const SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  const SweepTally tally = tally_in(made("t.h5", quick()));
  ASSERT_TRUE(tally.is_whole());
  for (std::size_t cell = 0; cell < runs.cell_count(); ++cell) {
    double sum = 0, least = 1e300;
    std::vector<std::uint64_t> popped;
    for (int replicate = 0; replicate < 5; ++replicate) {
      const std::size_t run = runs.run(cell, replicate);
      sum += runs.measure("max_penetration")[run];
      least = std::min(least, runs.measure("max_penetration")[run]);
      if (runs.measure("popped_through")[run] == 1) popped.push_back(run);
    }
    const CellTally& kept = tally.tallies[cell];
    EXPECT_EQ(kept.done, 5);
    EXPECT_NEAR(kept.measures[0].sum.value(), sum, 1e-15);
    EXPECT_EQ(kept.measures[0].least, least);
    EXPECT_EQ(kept.events, std::vector<std::vector<std::uint64_t>>{popped});
  }
}

// Interrupted and continued, with one and more threads.
TEST_F(TallySessions, HaveTheSameBytesInAnyWay) {
  const std::string whole = bytes_of(made("whole.h5", quick()));
  omp_set_num_threads(1);
  made("again.h5", quick(), {}, 1);  // after the first batch: on a fast machine the second has all the rest
  EXPECT_LT(tally_in(file("again.h5")).held.count(), 60u) << "it was interrupted";
  omp_set_num_threads(4);
  EXPECT_TRUE(bytes_of(made("again.h5", quick())) == whole);
}

TEST_F(TallySessions, AreRefusedWhereTheyDoNotFit) {
  const auto why = [&](const auto& call) { return refusal(call); };
  made("t.h5", quick());
  EXPECT_HAS(why([&] { made("t.h5", quick({"replicates=6"})); }), "t.h5: is of another configuration");
  EXPECT_HAS(why([&] { quick().plan(); }), "quick: keeps a tally (keep = events)");
  const Sweep longer = quick({"replicates=6"});
  EXPECT_HAS(why([&] { plan_in_file(longer, {}, attributes_of(longer, {}), file("t.h5")); }),
             "t.h5: is of another configuration, first in replicates 5 against 6");
  folder_.write("junk.h5", "junk");
  EXPECT_HAS(why([&] { made("junk.h5", quick()); }), "junk.h5: not a readable HDF5 file");
}

// Limits and means of a tally are those of its runs.
TEST_F(TallySessions, AnswerTheQuestionsThatNeedNoSingleRuns) {
  const SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  const SweepTally tally = tally_in(made("t.h5", quick()));
  const std::string config = quick().to_json();
  SweepQuestion question;
  question.limit = "popped_through";
  question.means = {"max_penetration", "popped_through", "first_pop_through_time"};
  const Figure ours = sweep_answer(tally, config, question), theirs = sweep_answer(runs, config, question);
  ASSERT_EQ(ours.tables.size(), theirs.tables.size());
  EXPECT_EQ(ours.caption, theirs.caption);
  for (std::size_t t = 0; t < ours.tables.size(); ++t)
    for (std::size_t i = 0; i < ours.tables[t].columns.size(); ++i) {
      const Column &column = ours.tables[t].columns[i], &expected = theirs.tables[t].columns[i];
      EXPECT_EQ(column.name, expected.name);
      if (const auto* const values = std::get_if<std::vector<double>>(&column.values)) {
        for (std::size_t row = 0; row < values->size(); ++row) {
          const double wanted = std::get<std::vector<double>>(expected.values)[row];
          EXPECT_EQ(std::isnan((*values)[row]), std::isnan(wanted)) << column.name;
          if (!std::isnan(wanted)) {
            EXPECT_NEAR((*values)[row], wanted, 1e-12 + 1e-9 * std::abs(wanted)) << column.name;
          }
        }
      } else if (std::holds_alternative<std::vector<std::int32_t>>(column.values)) {
        EXPECT_EQ(column.values, expected.values) << column.name;
      }
    }
}

// An answer states in how many runs it is unknown whether the event happened.
TEST_F(TallySessions, AnswersTellHowManyRunsAreUnknown) {
  SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  SweepTally tally = tally_in(made("t.h5", quick()));
  const std::string config = quick().to_json();
  SweepQuestion question;
  question.limit = "popped_through", question.direction = "rises";
  const auto unknown_in = [](const Figure& answer) {
    double sum = 0;
    for (const Column& column : answer.tables.front().columns)
      if (column.name == "unknown")
        for (const std::int32_t count : std::get<std::vector<std::int32_t>>(column.values)) sum += count;
    return sum;
  };
  EXPECT_EQ(unknown_in(sweep_answer(runs, config, question)), 0);
  EXPECT_EQ(unknown_in(sweep_answer(tally, config, question)), 0);
  std::get<std::vector<double>>(runs.measures[1].values)[3] = std::nan("");
  tally.tallies[0].measures[1].unknown = 1;
  EXPECT_EQ(unknown_in(sweep_answer(runs, config, question)), 1);
  EXPECT_EQ(unknown_in(sweep_answer(tally, config, question)), 1);
}

// The notes on the runs of a sweep as lines of counts.

using Lines = std::vector<std::string>;

// A result of 2 x 3 cells, of which one run has failed.
SweepResult two_by_three(int replicates) {
  SweepResult result;
  result.axes = {{"a", "1", "", std::vector<double>{0, 1}, 1, {}},
                 {"b", "1", "", std::vector<double>{0, 1, 2}, 1, {}}};
  result.replicates = replicates;
  result.note_kinds = {"no contact", "a kind of another program"};
  result.start(false);
  result.state.assign(result.run_count(), RunState::done);
  result.state[0] = RunState::failed;
  return result;
}

TEST(SweepNotes, AreCountedByKind) {
  SweepResult result = two_by_three(1);
  EXPECT_EQ(note_lines(result), Lines{});
  EXPECT_NO_THROW(refuse_notes(note_lines(result)));
  result.notes = {1, 0, 0, 0, 3, 1};
  EXPECT_EQ(
      note_lines(result),
      (Lines{"2 of 5 runs: no contact: no point was touched and no force was felt (the first: --cell 1,1)",
             "1 of 5 runs: a kind of another program (the first: --cell 1,1)"}));
  EXPECT_EQ(refusal([&] { refuse_notes(note_lines(result)); }),
            "--strict: " + note_lines(result)[0] + "; " + note_lines(result)[1]);
  result.note_kinds.clear(), result.notes.clear();
  EXPECT_EQ(note_lines(result), Lines{});
  SweepResult several = two_by_three(2);
  several.notes[9] = 2;
  EXPECT_EQ(note_lines(several),
            Lines{"1 of 11 runs: a kind of another program (the first: --cell 1,1 --replicate 1)"});
}

// A run of three ticks at these distances; its first frame comes in the second tick.
std::vector<Note> notes_of_outcome(double first_m, double second_m, double last_m, bool has_frames = true) {
  Trace trace;
  for (const double distance_m : {first_m, second_m, last_m}) {
    RenderOutput out;
    out.frame_index = has_frames && trace.length() > 0 ? 0 : -1;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {distance_m, distance_m, 0});
  }
  std::vector<Note> notes;
  add_unknown_outcome(built_in_measures(), trace, notes);
  return notes;
}

TEST(UnknownOutcome, HasANoteIfTheDistanceWasKnownWithAFrame) {
  EXPECT_TRUE(notes_of_outcome(0.01, 0.01, 0.01).empty());
  EXPECT_TRUE(notes_of_outcome(0.01, 0.01, 0.01, false).empty()) << "another note says that no frame came";
  EXPECT_TRUE(notes_of_outcome(0.01, kNoValue, kNoValue).empty());
  const std::vector<Note> notes = notes_of_outcome(0.01, 0.01, kNoValue);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_HAS(notes[0].text, "true surface is unknown in 33.3 % of the ticks, last at 0.002 s");
}

TEST(NoteCounts, CountSingleRunsAndSweepsTogether) {
  NoteCounts notes;
  EXPECT_EQ(notes.lines(), Lines{});
  notes.add({{"no contact", "a"}, {"no contact", "b"}});
  notes.add(std::vector<Note>{});
  SweepResult result = two_by_three(1);
  result.note_kinds = note_kind_names();
  result.notes = {0, 1 << 3, 0, 0, 1 << 3 | 1 << 4, 0};
  notes.add(result);
  EXPECT_EQ(notes.lines(), (Lines{"3 of 7 runs: no contact: no point was touched and no force was felt",
                                  "1 of 7 runs: no frame: no frame arrived before the run ended"}));
}

}  // namespace
}  // namespace remote_touch::sweep_run_test
