#include "runners/sweep/stored_sweep.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "analysis/measures/no_value.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_session.h"
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
  EXPECT_NO_THROW(refuse_notes(result));
  result.notes = {1, 0, 0, 0, 3, 1};
  EXPECT_EQ(
      note_lines(result),
      (Lines{"2 of 5 runs: no contact: no point was touched and no force was felt (the first: --cell 1,1)",
             "1 of 5 runs: a kind of another program (the first: --cell 1,1)"}));
  EXPECT_EQ(refusal([&] { refuse_notes(result); }),
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

// Sweeps of schema /2 are read with the present names of their settings.

// The configuration of a sweep as version 0.2 stored it, over one axis.
std::string old_configuration(const std::string& axis) {
  return R"({"title": "old", "experiment": {"scenario": {"name": "plates", "true_motion": false},
    "renderer": {"name": "proxy", "contact_rule": "tangent_plane"}, "trajectory": {"name": "press"},
    "duration_s": 0.1}, "axes": [)" +
         axis + R"(], "replicates": 1, "measures": ["max_force"]})";
}

// A finished sweep of two runs over the axis.
SweepResult two_runs(Column axis) {
  SweepResult result;
  result.axes = {std::move(axis)};
  result.measures = {{"max_force", "N", "maximum force", {}}};
  result.start(false);
  result.state = {RunState::done, RunState::done};
  std::get<std::vector<double>>(result.measures[0].values) = {1, 2};
  return result;
}

void write_old(const std::filesystem::path& file, const SweepResult& result, const std::string& config) {
  Hdf5Writer hdf5;
  hdf5.attributes("/", {{"schema", "remote-touch-sweep/2"},
                        {"axes", result.axes[0].name},
                        {"measures", "max_force"},
                        {"config", config},
                        {"digest", digest(result)}});
  hdf5.group("/sweep");
  hdf5.columns(
      "/sweep",
      {result.axes[0], result.measures[0], state_column(result), {"error", "1", "reason", result.error}}, "");
  hdf5.save(file);
}

// Writes an old sweep over the contact rule of the proxy.
void write_contact_rules(const std::filesystem::path& file) {
  const std::string config =
      old_configuration(R"({"parameter": "renderer.contact_rule", "values": ["tangent_plane", "regions"]})");
  write_old(file,
            two_runs({"contact_rule",
                      "1",
                      "renderer.contact_rule",
                      std::vector<std::int32_t>{0, 1},
                      1,
                      {"tangent_plane", "regions"}}),
            config);
}

TEST(StoredSweep, HasPresentNamesOfAxesAndValues) {
  const TestFolder folder("stored_sweep_test");
  write_contact_rules(folder / "old.h5");
  EXPECT_EQ(read_sweep(folder / "old.h5").result.axes[0].name, "contact_rule");
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  const Column& axis = stored.result.axes.at(0);
  EXPECT_EQ(axis.name, "contact_motion");
  EXPECT_EQ(axis.long_name, "renderer.contact_motion");
  EXPECT_EQ(axis.value_names, (std::vector<std::string>{"tangent-plane", "regions"}));
  EXPECT_EQ(stored.result.measure("max_force"), (std::vector<double>{1, 2}));
  const Sweep sweep = Sweep::from_json(attribute(stored.attributes, "config"), "old.h5");
  EXPECT_NO_THROW(sweep.require_fits(stored.result, "old.h5"));
}

TEST(StoredSweep, ASwitchThatIsNowAChoiceHasItsNames) {
  const TestFolder folder("stored_sweep_test");
  const std::string config =
      old_configuration(R"({"parameter": "scenario.true_motion", "values": [true, false]})");
  write_old(folder / "old.h5",
            two_runs({"true_motion",
                      "1",
                      "scenario.true_motion",
                      std::vector<std::int32_t>{0, 1},
                      1,
                      {"true", "false"}}),
            config);
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  EXPECT_EQ(stored.result.axes.at(0).name, "truth");
  EXPECT_EQ(stored.result.axes.at(0).value_names, (std::vector<std::string>{"moving", "newest-frame"}));
}

// `merge` writes shards of schema /2 in this way.
TEST(StoredSweep, WhatIsWrittenOfItSaysThatItsNamesAreTranslated) {
  const TestFolder folder("stored_sweep_test");
  const std::string config = old_configuration(R"({"parameter": "seed", "values": [1, 2]})");
  write_old(folder / "old.h5", two_runs({"seed", "1", "seed", std::vector<double>{1, 2}, 1, {}}), config);
  EXPECT_EQ(attribute(read_sweep(folder / "old.h5").attributes, "translated_from"), "");
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  EXPECT_EQ(stored.schema, schema_name("sweep"));
  write_sweep(folder / "new.h5", stored.result, stored.attributes);
  const StoredSweep again = read_stored_sweep(folder / "new.h5");
  EXPECT_EQ(again.schema, schema_name("sweep"));
  EXPECT_EQ(again.attributes, stored.attributes);
  EXPECT_EQ(attribute(again.attributes, "translated_from"), "remote-touch-sweep/2");
}

TEST(StoredSweep, IsNotContinued) {
  const TestFolder folder("stored_sweep_test");
  write_contact_rules(folder / "old.h5");
  const Sweep sweep =
      Sweep::from_json(attribute(read_stored_sweep(folder / "old.h5").attributes, "config"), "new.json");
  EXPECT_HAS(refusal([&] {
               plan_in_file(sweep, {}, {{"config", sweep.to_json()}}, folder / "old.h5");
             }),
             "old.h5: was written with the earlier schema remote-touch-sweep/2: expected a new file");
}

TEST(StoredSweep, OtherAxesAreUnchanged) {
  const TestFolder folder("stored_sweep_test");
  const std::string config =
      old_configuration(R"({"parameter": "renderer.stiffness_N_per_m", "values": [300, 600]})");
  write_old(
      folder / "old.h5",
      two_runs({"stiffness_N_per_m", "N/m", "renderer.stiffness_N_per_m", std::vector<double>{300, 600}}),
      config);
  const Column axis = read_stored_sweep(folder / "old.h5").result.axes.at(0);
  EXPECT_EQ(axis.name, "stiffness_N_per_m");
  EXPECT_EQ(std::get<std::vector<double>>(axis.values), (std::vector<double>{300, 600}));
}

}  // namespace
}  // namespace remote_touch::stored_sweep_test
