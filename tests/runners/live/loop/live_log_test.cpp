// The memory of a live run has a bound, however long it runs.
#include "runners/live/loop/live_log.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/note_kinds.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_log_test {
namespace {

// The disk accepts nothing, so the logger refuses a frame when too many wait.
TEST(LiveLogger, AcceptsNoMoreFramesThanCanWait) {
  const TestFolder folder("live_logger");
  SensorView view;
  view.camera = {2, 2, 2, 2, 1, 1};
  Ring<LiveTick> rows(4);
  LiveLogger logger(rows, 1000,
                    std::make_unique<SessionRecorder>(folder / "session.h5", view, RigidTransform::Identity(),
                                                      TextAttributes{{"config", "{}"}}));
  SensorFrame frame;
  frame.depth = {1000, 1000, 1000, 1000};
  int taken = 0;
  while (taken < 1000 && logger.record(frame, 0.03 * taken, 0)) ++taken;
  EXPECT_EQ(taken, 90);
  EXPECT_FALSE(logger.record(frame, 4, 0));
  logger.step();
  EXPECT_EQ(logger.failure(), "");
  EXPECT_TRUE(logger.record(frame, 5, 0)) << "those that waited are on the disk";
  logger.finish();
}

TEST(Samples, KeepAllUpToTheirMaximumAndThenAnEvenPart) {
  Samples samples;
  EXPECT_TRUE(std::isnan(samples.least()));
  const std::size_t all = 5 * Samples::kMax / 2 + 3;
  for (std::size_t i = 0; i < all; ++i) {
    samples.push_back(static_cast<double>(i));
    if (i == Samples::kMax - 1) {
      EXPECT_EQ(samples.kept().size(), Samples::kMax);
    }
  }
  EXPECT_EQ(samples.size(), all);
  EXPECT_EQ(samples.least(), 0);
  EXPECT_EQ(samples.greatest(), static_cast<double>(all - 1));
  ASSERT_LE(samples.kept().size(), Samples::kMax);
  ASSERT_GE(samples.kept().size(), Samples::kMax / 2);
  for (std::size_t i = 0; i < samples.kept().size(); ++i)
    ASSERT_EQ(samples.kept()[i], 4 * static_cast<double>(i));
}

TEST(GreatestOfPieces, EveryPieceHasItsGreatest) {
  GreatestOfPieces pieces;
  const int all = 10 * static_cast<int>(GreatestOfPieces::kPieces);
  for (int i = 0; i < all; ++i) pieces.push_back(i, i == 1234 ? 7 : 1);
  ASSERT_LE(pieces.greatest().size(), 2 * GreatestOfPieces::kPieces);
  ASSERT_GE(pieces.greatest().size(), GreatestOfPieces::kPieces);
  const double length = pieces.begin_s()[1] - pieces.begin_s()[0];
  for (std::size_t i = 0; i < pieces.greatest().size(); ++i) {
    const double begin = length * static_cast<double>(i);
    EXPECT_EQ(pieces.begin_s()[i], begin);
    EXPECT_EQ(pieces.greatest()[i], begin <= 1234 && 1234 < begin + length ? 7 : 1) << i;
  }
}

TEST(LiveLog, TheTraceEndsWhereItsRowsEndAndTheCountsGoOn) {
  LiveLog log;
  log.max_rows = 100;
  LiveTick tick;
  for (int i = 0; i < 1000; ++i) {
    tick.number = i, tick.step_s = 1e-6f * static_cast<float>(i);
    log.append(tick, 1000);
    EXPECT_EQ(log.is_whole(), i < 100);
  }
  EXPECT_EQ(log.trace.length(), 100u);
  EXPECT_EQ(log.row_step_s.size(), 100u);
  const LiveReport report = live_report(log, {});
  EXPECT_EQ(report.counts.front().value, 1000);
  EXPECT_EQ(report.times.front().count, 1000u);
  EXPECT_FLOAT_EQ(static_cast<float>(report.times.front().greatest), 999e-6f);
}

double count_of(const LiveReport& report, const std::string& name) {
  for (const auto& count : report.counts)
    if (count.name == name) return count.value;
  ADD_FAILURE() << name;
  return -1;
}

constexpr const char *kMissed = "missed deadlines, percent", *kProcessing = "processing of a frame, mean us",
                     *kPause = "longest pause between frames, ms", *kForce = "largest force written, N";

TEST(LiveReport, HasNoValueForWhatWasNotMeasured) {
  const LiveReport report = live_report({}, {});
  for (const char* name : {kMissed, kProcessing, kPause, kForce})
    EXPECT_TRUE(std::isnan(count_of(report, name))) << name;
  EXPECT_EQ(count_of(report, "ticks"), 0);
  EXPECT_EQ(count_of(report, "missed deadlines"), 0);
  const std::string shown = text(report);
  EXPECT_HAS(shown, std::string("  ") + kForce + std::string(29, ' ') + "none\n");
  EXPECT_HAS(shown, "0   none  none  none   none     none\n");
  EXPECT_EQ(shown.find("nan"), std::string::npos) << shown;
  const Figure figure = live_figure(report);
  EXPECT_TRUE(std::isnan(std::get<std::vector<double>>(figure.tables[1].columns[1].values).back()));
}

TEST(LiveReport, HasNoPauseWithOneFrameAndAForceOfZeroWithOneTick) {
  LiveCounts counts;
  counts.camera.received = 3, counts.camera.reversed = 2, counts.camera.processing_s = 0.004;
  LiveLog log;
  log.append({}, 1000);
  const LiveReport one = live_report(log, counts);
  EXPECT_EQ(count_of(one, kMissed), 0);
  EXPECT_EQ(count_of(one, kForce), 0);
  EXPECT_TRUE(std::isnan(count_of(one, kPause)));
  EXPECT_EQ(count_of(one, kProcessing), 4000);
  counts.camera.received = 4, counts.camera.max_pause_s = 0.5;
  EXPECT_EQ(count_of(live_report({}, counts), kPause), 500);
}

TEST(LiveLog, ACloudOfASlowCameraIsStaleAfterTwoAndAHalfPeriods) {
  EXPECT_EQ(LiveLog::stale_after_s(30), 0.2);
  EXPECT_EQ(LiveLog::stale_after_s(2), 1.25);
  LiveLog log;
  log.stale_s = LiveLog::stale_after_s(2);
  LiveTick tick;
  for (int i = 0; i < 1300; ++i) {
    tick.number = i, tick.taken = i == 0 ? 0 : -1;
    log.append(tick, 1000);
  }
  EXPECT_EQ(log.stale_ticks, 1299 - 1250);
}

TEST(LiveLog, CountsFramesInTheWrongOrderAndTicksInWhichTheGateLimits) {
  LiveLog log;
  LiveTick tick;
  for (const int taken : {3, -1, 4, 4, -1, 2, 5}) {  // -1: no frame
    tick.taken = taken, tick.is_limited = taken < 3;
    log.append(tick, 1000);
    ++tick.number;
  }
  EXPECT_EQ(log.reversed_frames, 2);
  EXPECT_EQ(log.latency_s.size(), 5u);
  EXPECT_EQ(count_of(live_report(log, {}), "ticks with a force or torque limited for safety"), 3);
}

// The recordings that a live run reads.

using Paths = std::vector<std::string>;

// The scenario, the trajectory and the tool each read a file. None is opened here.
Experiment experiment() {
  return Experiment::from_json(
      R"({"scenario": {"name": "recording", "path": "scene"}, "depth_pipeline": {},
          "renderer": {"name": "tool", "tool_mesh": "ball.obj"},
          "trajectory": {"name": "live-session", "path": "hand.h5"}})",
      "test");
}

Paths paths(const std::string& device, const std::string& depth, bool has_view = false) {
  Paths all;
  for (const InputPart& part : live_inputs(experiment(), device, depth, has_view)) all.push_back(part.path);
  std::sort(all.begin(), all.end());
  return all;
}

TEST(LiveInputs, NameTheSourceOfTheDepth) {
  for (const std::string scheme : {"dir:", "tum:", "pcd:", "replay:"})
    EXPECT_EQ(paths("fd:0", scheme + "seen"), (Paths{"ball.obj", "seen"})) << scheme;
  EXPECT_EQ(paths("fd:0", "sim:"), (Paths{"ball.obj", "scene"}));
  EXPECT_EQ(paths("fd:0", "k4a:0"), Paths{"ball.obj"});
  EXPECT_EQ(paths("fd:0", "oni:any"), Paths{"ball.obj"});
  EXPECT_EQ(paths("fd:0", "oni:seen.oni"), (Paths{"ball.obj", "seen.oni"}));
}

TEST(LiveInputs, NameTheSceneInWhichAHandIsPlanned) {
  for (const char* device : {"sim:", "browser:"})
    EXPECT_EQ(paths(device, "dir:seen"), (Paths{"ball.obj", "hand.h5", "scene", "seen"})) << device;
  EXPECT_EQ(paths("fd:0", "dir:seen", true), (Paths{"ball.obj", "hand.h5", "scene", "seen"}));
  EXPECT_EQ(paths("replay:other.h5", "dir:seen"), (Paths{"ball.obj", "other.h5", "scene", "seen"}));
}

// A live session on a simulated clock: what it reports at its end and stores in its files.

// A hand that presses 1 cm into a table from 0.2 s on; 40 x 30 pixels at 30 Hz.
std::string press(const std::string& trajectory) {
  return R"({"scenario": {"name": "camera-scene", "width": 40, "height": 30}, "renderer": {"name": "proxy"},
             "trajectory": )" +
         trajectory + "}";
}
const char* const kPress = R"({"name": "press", "press_at_s": 0.2, "depth_m": 0.01})";
const char* const kAbove = R"({"name": "waypoints", "waypoints": [[0, 0.3, 0, 0], [0, 0.2, 0, 0.5]]})";

// The pixels of the focal length 60 px see points of the table 11 mm apart, so that a ball of radius 5 mm
// falls between them.
TEST(LiveNotes, AreMadeAndStoredForWhatASessionLacks) {
  std::string sparse = press(kPress);
  sparse.insert(sparse.find("\"width\""), "\"focal_px\": 60, ");
  struct Noted {
    std::string experiment;
    double duration_s;
    const char *kind, *text;
  };
  for (const auto& [experiment, duration_s, kind, text] :
       {Noted{press(kAbove), 0.5, "no contact", "no point was touched, and no force was felt"},
        Noted{press(kPress), 0.1, "phase not reached", "before the press begins at 0.2 s"},
        Noted{sparse, 0.5, "wide spacing", "a proxy of contact radius 5 mm can fall through it"}}) {
    RecordedRun session(Experiment::from_json(experiment, "test"), duration_s);
    session.go();
    ASSERT_FALSE(session.result.report.notes.empty()) << kind;
    EXPECT_EQ(kinds_of(session.result.report.notes).back(), kind);
    EXPECT_HAS(attribute(Hdf5Reader(session.run.options.record).attributes(), "notes"), text);
  }
}

// The hand at a device of another program moves freely, so the experiment's hand and scene are not used.
TEST(LiveNotes, PhasesBelongToSimulatedPartsOnly) {
  const Experiment experiment = Experiment::from_json(press(kPress), "test");
  EXPECT_EQ(simulated_phases(experiment, "sim:", "pcd:x", scenes::kernels()).size(), 1u);
  EXPECT_TRUE(simulated_phases(experiment, "browser:", "sim:", scenes::kernels()).empty())
      << "a scene at rest";
  EXPECT_TRUE(simulated_phases(experiment, "fd:", "k4a:", scenes::kernels()).empty());
  const std::string more =
      R"(, "changes": [{"time_s": 1, "parameter": "renderer.stiffness_N_per_m", "value": 9}],
      "operator": {"presses": [[2, 0, 0.1]]}})";
  const std::string text = press(kPress);
  const Experiment both = Experiment::from_json(text.substr(0, text.size() - 1) + more, "test");
  EXPECT_EQ(simulated_phases(both, "fd:", "k4a:", scenes::kernels()).size(), 1u) << "the change";
  EXPECT_EQ(simulated_phases(both, "sim:", "k4a:", scenes::kernels()).size(), 3u);
}

RunReport report_of_counts(const CameraCounts& camera, std::int64_t contact_ticks = 1, int taken = 1) {
  LiveLog log;
  log.contact_ticks = contact_ticks;
  for (int i = 0; i < taken; ++i) log.latency_s.push_back(0.01);
  return report_of({"k4a:", SensorView{}, SensedPoints{}, camera, log, 1000, {}});
}

TEST(LiveNotes, ReportFramesThatWereNotUsedAndThatThereWereNone) {
  CameraCounts camera;
  camera.received = 95, camera.skipped = 5, camera.overtaken = 3, camera.incomplete = 2;
  EXPECT_EQ(kinds_of(report_of_counts(camera).notes), Kinds{}) << "10 of 100: single frames";
  camera.received = 94, camera.skipped = 6;
  const RunReport report = report_of_counts(camera);
  ASSERT_EQ(kinds_of(report.notes), Kinds{"frames unused"});
  EXPECT_EQ(report.notes[0].text,
            "11 of 100 frames were not used: 6 not sent, or replaced before they were processed, "
            "2 without all pixels or colours, 3 replaced before the haptic loop used them");
  EXPECT_EQ(kinds_of(report_of_counts({}, 0, 0).notes), Kinds{"no frame"});
}

// Ticks that count as late, on a simulated clock. `remote-touch jitter` reports how late this machine is.

// A rate of 3 kHz has a period of 333333 ns: after 300 ticks the loop is 0.1 us before a grid of 1 / 3000 s.
TEST(Jitter, NoTickIsLateIfAllComeInTime) {
  for (const auto& [duration_s, rate_hz, ticks] : {std::tuple{0.5, 1000, 500u}, {0.1, 3000, 300u}}) {
    SCOPED_TRACE(rate_hz);
    SimulatedClock clock;
    const Jitter jitter = measure_jitter(duration_s, rate_hz, nullptr, clock);
    ASSERT_EQ(jitter.late_s.size(), ticks);
    for (const double late_s : jitter.late_s) EXPECT_NEAR(late_s, 0, 1e-12);
    EXPECT_EQ(jitter.missed, 0);
  }
}

// Something else runs from 5.2 to 7.7 ms. The tick of 6 ms never comes, and that of 7 ms comes 0.7 ms late.
TEST(Jitter, ALateTickIsLateAndOneThatNeverCameIsMissed) {
  SimulatedClock clock;
  clock.at(0.0052, [&] { clock.sleep_s(0.0025); });
  const Jitter jitter = measure_jitter(0.01, 1000, nullptr, clock);
  ASSERT_EQ(jitter.late_s.size(), 9u);
  EXPECT_EQ(jitter.missed, 1);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(jitter.late_s[i], i == 6 ? 0.7e-3 : 0, 1e-12) << i;
}

TEST(Jitter, AStopEndsIt) {
  SimulatedClock clock;
  std::atomic<bool> stop = false;
  clock.at(0.0035, [&] { stop = true; });
  EXPECT_EQ(measure_jitter(10, 1000, &stop, clock).late_s.size(), 4u);
}

}  // namespace
}  // namespace remote_touch::live_log_test
