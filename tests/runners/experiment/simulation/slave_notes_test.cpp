// Notes on a slave that could not touch, got no command, is part of an unstable loop, or has settings that
// cannot act.
#include "runners/experiment/simulation/slave_notes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

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

// Returns the notes "setting without effect" of a run.
std::vector<Note> setting_notes(const std::string& experiment, const std::vector<std::string>& overrides) {
  RunReport report;
  SimulationOptions options;
  options.report = &report;
  simulate(Experiment::load(experiment, overrides), options);
  std::erase_if(report.notes, [](const Note& note) { return note.kind != "setting without effect"; });
  return report.notes;
}

TEST(SlaveNotes, AreNoneForASlaveThatFollows) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1"}), Kinds{});
  EXPECT_EQ(notes_of("fig4.11", {}), Kinds{});
}

// The error of the registration puts the slave behind the surface in some of these replicates.
TEST(SlaveNotes, SayThatTheSlaveStartsInContact) {
  int in_contact = 0;
  for (int replicate = 0; replicate < 8; ++replicate) {
    const Trace trace = simulate(
        Experiment::load("steer-robot", {"fixtures=[]", "duration_s=0.1", "registration.offset_m=0.03",
                                         "command_link.delay_s=0", "replicate=" + std::to_string(replicate),
                                         "trajectory.waypoints=[[0, 0.012, 0, 0], [0, 0.05, 0, 0.1]]"}),
        {});
    const std::vector<Note> notes = slave_notes(trace);
    const bool starts_inside = trace.slave_clearance_m.front() < 0;
    ASSERT_EQ(notes.size(), starts_inside ? 1u : 0u) << replicate;
    EXPECT_TRUE(!starts_inside || notes[0].kind == "slave starts in contact");
    EXPECT_EQ(trace.slave_peak_force_N[1] > 0, starts_inside) << replicate;
    in_contact += starts_inside ? 1 : 0;
  }
  EXPECT_GT(in_contact, 0);
  EXPECT_LT(in_contact, 8);
}

TEST(SlaveNotes, SayThatNoCommandArrived) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1", "command_link.loss_probability=1"}),
            Kinds{"slave without command"});
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=1", "command_link.delay_s=2"}),
            Kinds{"slave without command"});
}

// A command that is sent in the last tick cannot be received any more.
TEST(SlaveNotes, AreNoneForARunThatEndsBeforeACommandCanArrive) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=0.002", "command_link.delay_s=0"}), Kinds{});
}

TEST(SlaveNotes, SayThatTheSlaveNeverStarted) {
  Trace trace = simulate(Experiment::load("steer-robot", {"duration_s=0.05", "command_link.delay_s=0"}), {});
  EXPECT_EQ(slave_notes(trace).size(), 0u);
  const double unknown = std::nan("");
  for (std::size_t i = 0; i < trace.length(); ++i) {
    trace.received_command_m[i].setConstant(unknown);
    trace.slave_clearance_m[i] = trace.slave_peak_force_N[i] = unknown;
  }
  const std::vector<Note> notes = slave_notes(trace);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_HAS(notes[0].text, "the slave never started");
}

TEST(SlaveNotes, SayThatNoForceArrived) {
  const std::vector<std::string> set = {"duration_s=2.5", "feedback.force=slave-force", "feedback.gain=0.05",
                                        "fixtures=[]"};
  EXPECT_EQ(notes_of("steer-robot", set), Kinds{});
  for (const char* link :
       {"force_link.loss_probability=1", "force_link.delay_s=10", "force_link.least=100"}) {
    std::vector<std::string> broken = set;
    broken.emplace_back(link);
    EXPECT_EQ(notes_of("steer-robot", broken), Kinds{"slave without command"}) << link;
  }
}

// The force of a renderer does not pass through the slave, so the slave is not part of its loop.
TEST(SlaveNotes, BlameTheSlaveOnlyForALoopThatItIsPartOf) {
  const std::vector<std::string> set = {"duration_s=3", "feedback.force=slave-force"};
  Trace trace = simulate(Experiment::load("steer-robot", set), {});
  EXPECT_EQ(slave_notes(trace).size(), 1u);
  trace.force_packets.assign(trace.length(), 0);
  EXPECT_EQ(slave_notes(trace).size(), 0u);
}

// Position-force with the whole force and a delay is unstable against a stiff scene.
TEST(SlaveNotes, SayThatTheLoopIsUnstable) {
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=3", "feedback.force=slave-force"}),
            Kinds{"slave loop gains energy"});
  EXPECT_EQ(notes_of("steer-robot", {"duration_s=3", "feedback.force=none"}), Kinds{});
}

// The slave follows the HIP through the region. The notes of a real or recorded hand do not mention its path.
TEST(SlaveNotes, SayThatFixturesHoldNothingBack) {
  for (const std::string force : {"none", "slave-force", "passive-slave-force"}) {
    const std::vector<std::string> set = {"feedback.force=" + force, "duration_s=0.1"};
    const std::vector<Note> notes = setting_notes("steer-robot", set);
    ASSERT_EQ(notes.size(), 1u) << force;
    EXPECT_HAS(notes[0].text, "fixtures hold nothing back with feedback.force = " + force);
    EXPECT_EQ(setting_notes("steer-robot", {set[0], "fixtures=[]"}).size(), 0u);
    EXPECT_EQ(slave_setting_notes(Experiment::load("steer-robot", set), Experiment::Hand::real).size(), 1u);
  }
  EXPECT_EQ(setting_notes("steer-robot", {"duration_s=0.1"}).size(), 0u);
  EXPECT_EQ(setting_notes("fixture-tasks", {"duration_s=0.1"}).size(), 0u);
}

TEST(SlaveNotes, SayThatAForceCannotMoveAHandWithoutAnOperator) {
  const std::string ball = R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"}, "slave": {},
      "trajectory": {"name": "waypoints"}, "duration_s": 0.02, "feedback": {"force": ")";
  const auto notes_of_force = [&](const std::string& force, const std::string& more, Experiment::Hand hand) {
    return slave_setting_notes(Experiment::from_json(ball + force + "\"}" + more + "}", "test"), hand);
  };
  for (const std::string force : {"slave-force", "passive-slave-force"}) {
    const std::vector<Note> notes = notes_of_force(force, "", Experiment::Hand::simulated);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].kind, "setting without effect");
    EXPECT_HAS(notes[0].text, "feedback.force = " + force + " moves nothing");
    EXPECT_EQ(notes_of_force(force, R"(, "operator": {})", Experiment::Hand::simulated).size(), 0u);
    EXPECT_EQ(notes_of_force(force, "", Experiment::Hand::real).size(), 0u);
  }
  for (const char* force : {"rendered", "none"})
    EXPECT_EQ(notes_of_force(force, "", Experiment::Hand::simulated).size(), 0u);
}

TEST(SlaveNotes, TheSummaryHasTheFirstContactAndTheLargestForce) {
  Trace trace;
  const auto add = [&](double peak_N, double clearance_m) {
    SlaveState slave;
    slave.peak_force_N = peak_N, slave.clearance_m = clearance_m;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, {}, {}, HandState{}, slave);
  };
  EXPECT_EQ(slave_summary(trace), "");
  add(0, std::nan(""));
  EXPECT_EQ(slave_summary(trace), "") << "the surface is not known";
  add(0, 0.0123);
  EXPECT_EQ(slave_summary(trace), "the slave did not touch; it came within 12.3 mm of the surface");
  add(4.5, -0.001);
  add(12.34, -0.002);
  EXPECT_EQ(slave_summary(trace),
            "the slave touched first at 0.002 s; largest force of the scene on it: 12.3 N");
  Trace unknown;
  std::swap(trace, unknown);
  add(std::nan(""), -0.001);
  EXPECT_EQ(slave_summary(trace), "it is not known whether the slave touched: its force is unknown");
}

TEST(SlaveNotes, SayThatThereIsNoSurfaceToTouch) {
  EXPECT_EQ(notes_of("fig5.5", {"slave={}"}), Kinds{"slave without surface"});
}

TEST(SlaveNotes, SayThatTheNormalIsNotKnownBehindTheSurface) {
  Trace trace = simulate(Experiment::load("steer-robot", {"duration_s=1"}), {});
  trace.slave_clearance_m.back() = -0.001;
  EXPECT_EQ(slave_notes(trace).size(), 0u);
  trace.slave_peak_force_N.back() = std::nan("");
  const std::vector<Note> notes = slave_notes(trace);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].kind, "slave without surface");
  EXPECT_HAS(notes[0].text, "normal");
}

}  // namespace
}  // namespace remote_touch::slave_notes_test
