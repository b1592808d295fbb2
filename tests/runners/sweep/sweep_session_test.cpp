// Sweeps that keep tallies: equal to the runs, the same bytes in any way, what is refused.
#include <gtest/gtest.h>
#include <omp.h>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_means.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"
#include "runners/sweep/sweep_session.h"
#include "tests/runners/sweep/quick_sweeps.h"
#include "tests/support/recorded_wall.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_session_test {
namespace {

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
  EXPECT_HAS(why([&] { made("t.h5", quick({"keep=tally"})); }), "t.h5: is of another configuration");
  EXPECT_HAS(why([&] { made("s.h5", quick(), {13, 20}); }), "shard 13/20 has 0 cells: expected 1 to 1000000");
  EXPECT_HAS(why([&] { quick().plan(); }), "quick: keeps a tally (keep = events)");
  EXPECT_HAS(why([] { quick({"keep=all"}); }), R"(keep = "all": expected runs, tally or events)");
  EXPECT_HAS(why([] { quick({"refine.budget=100"}); }), "refinement needs the values of all runs");
  const Sweep longer = quick({"replicates=6"});
  EXPECT_HAS(why([&] { plan_in_file(longer, {}, attributes_of(longer, {}), file("t.h5")); }),
             "t.h5: is of another configuration, first in replicates 5 against 6");
  folder_.write("junk.h5", "junk");
  EXPECT_HAS(why([&] { made("junk.h5", quick()); }), "junk.h5: not a readable HDF5 file");
}

// Limits and means of a tally are those of its runs; what needs single runs is refused.
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
    for (const Column& column : ours.tables[t].columns)
      if (const auto* const values = std::get_if<std::vector<double>>(&column.values))
        for (std::size_t row = 0; row < values->size(); ++row) {
          const double expected = numbers(theirs.tables[t], column.name)[row];
          if (std::isnan(expected))
            EXPECT_TRUE(std::isnan((*values)[row])) << column.name;
          else
            EXPECT_NEAR((*values)[row], expected, 1e-12 + 1e-9 * std::abs(expected)) << column.name;
        }
  for (std::size_t t = 0; t < ours.tables.size(); ++t)
    for (std::size_t i = 0; i < ours.tables[t].columns.size(); ++i) {
      const Column &column = ours.tables[t].columns[i], &expected = theirs.tables[t].columns[i];
      EXPECT_EQ(column.name, expected.name);
      if (std::holds_alternative<std::vector<std::int32_t>>(column.values)) {
        EXPECT_EQ(column.values, expected.values) << column.name;
      }
    }
  question = {};
  question.differences = {"max_penetration"}, question.between = "noise_sigma_m";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }), "a tally does not keep pairs of runs");
  question = {};
  question.limit = "max_penetration";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }),
             "a tally counts only the events themselves");
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
}

TEST(SweepNotes, NameTheReplicateWhereThereAreSeveral) {
  SweepResult result = two_by_three(2);
  result.notes[9] = 2;
  EXPECT_EQ(note_lines(result),
            Lines{"1 of 11 runs: a kind of another program (the first: --cell 1,1 --replicate 1)"});
}

TEST(SweepNotes, AResultWithoutNotesHasNoLines) {
  SweepResult result = two_by_three(1);
  result.note_kinds.clear(), result.notes.clear();
  EXPECT_EQ(note_lines(result), Lines{});
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

// A sweep over the truth of a recording: the same runs, judged by the measurement and by the meshes.

TEST(TruthSweep, JudgesTheSameRunsByBothSurfaces) {
  const TestFolder folder("truth_sweep_test");
  const std::string experiment = R"({"scenario": )" + recorded_wall::scenario(recorded_wall::write(folder)) +
                                 R"(, "renderer": {"name": "god-object"}, "trajectory": )" +
                                 recorded_wall::kPress + R"(, "duration_s": 0.5})";
  const Sweep sweep =
      Sweep::from_json(R"({"title": "truth", "experiment": )" + experiment +
                           R"(, "axes": [{"parameter": "scenario.truth", "values": ["measured", "mesh"]}],
             "measures": ["rms_contact_error", "rms_renderer_error", "rms_camera_error", "max_force"]})",
                       "test");
  const SweepResult result = run_sweep(sweep, {});
  const auto value = [&](const char* measure, std::size_t run) { return result.measure(measure)[run]; };
  EXPECT_EQ(value("max_force", 0), value("max_force", 1)) << "the truth changes no force";
  EXPECT_LT(value("rms_contact_error", 0), 2e-5);
  EXPECT_NEAR(value("rms_contact_error", 1), recorded_wall::kCameraError_m, 4e-5);
  EXPECT_TRUE(std::isnan(value("rms_camera_error", 0)));
  EXPECT_TRUE(std::isnan(value("rms_renderer_error", 0)));
  EXPECT_NEAR(value("rms_camera_error", 1), recorded_wall::kCameraError_m, 2e-5);
  EXPECT_LT(value("rms_renderer_error", 1), 2e-5);
}

}  // namespace
}  // namespace remote_touch::sweep_session_test
