#include "runners/sweep/stored_sweep.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/run_notes.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_sweep_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::stored_sweep_test
