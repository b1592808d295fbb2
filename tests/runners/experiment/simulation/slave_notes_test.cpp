// Notes on a slave that could not touch, got no command, or is part of an unstable loop.
#include "runners/experiment/simulation/slave_notes.h"

#include <gtest/gtest.h>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::slave_notes_test {
namespace {

std::vector<std::string> notes_of(const std::string& experiment, std::vector<std::string> overrides) {
  RunReport report;
  SimulationOptions options;
  options.report = &report;
  simulate(Experiment::load(experiment, overrides), options);
  std::vector<std::string> kinds;
  for (const Note& note : report.notes)
    if (note.kind.starts_with("slave")) kinds.push_back(note.kind);
  return kinds;
}

using Kinds = std::vector<std::string>;

TEST(SlaveNotes, AreNoneForASlaveThatFollows) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1"}), Kinds{});
  EXPECT_EQ(notes_of("fig4.11", {}), Kinds{});
}

TEST(SlaveNotes, SayThatNoCommandArrived) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1", "command_link.loss_probability=1"}),
            Kinds{"slave without command"});
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1", "command_link.delay_s=2"}),
            Kinds{"slave without command"});
}

// Position-force with the whole force and a delay is unstable against a stiff scene.
TEST(SlaveNotes, SayThatTheLoopIsUnstable) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=3", "feedback.force=slave-force"}),
            Kinds{"slave loop gains energy"});
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=3", "feedback.force=none"}), Kinds{});
}

TEST(SlaveNotes, SayThatThereIsNoSurfaceToTouch) {
  EXPECT_EQ(notes_of("fig5.5", {"slave={}"}), Kinds{"slave without surface"});
}

}  // namespace
}  // namespace remote_touch::slave_notes_test
