// The live loop with simulated sensors and devices: its results, and the replay of a recording of it.
#include "runners/live/loop/live_run.h"

#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "analysis/storage/digest.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/doubles/depth_libraries.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_run_test {
namespace {

LiveOptions options(double duration_s) {
  LiveOptions all;
  all.kernels = &scenes::kernels();
  all.duration_s = duration_s;
  return all;
}

// A hand that follows the scene, with small images so that a slow machine keeps up.
const char* const kProxy = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "follow-surface", "from_m": [0, 0, -0.1], "to_m": [0, 0, 0.1], "depth_m": 0.003,
                 "speed_m_per_s": 0.1, "clearance_m": 0.01}})";

const char* const kTool = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120}, "depth_pipeline": {},
  "renderer": {"name": "tool", "tool_mesh": "ball"},
  "trajectory": {"name": "poses", "poses": [[0, 0.06, 0, 0, 0, 0, 0], [0, 0.01, 0, 0, 0, 0, 0.5],
                                            [0.05, 0.01, 0, 0, 0, 0, 1]]}})";

void expect_the_same_offline(const std::filesystem::path& session, const LiveResult& live) {
  ASSERT_FALSE(live.failed) << live.ended;
  ASSERT_GT(live.log.trace.length(), 100u);
  ASSERT_GT(live.log.latency_s.size(), 2u) << "frames taken";
  EXPECT_EQ(live.counts.rows_lost, 0);
  EXPECT_EQ(live.log.reversed_frames, 0);
  SimulationOptions offline;
  offline.kernels = &scenes::kernels();
  offline.hash_frames = true;
  const Trace again = simulate(Experiment::load(session.string()), offline);
  ASSERT_EQ(again.length(), live.log.trace.length());
  EXPECT_EQ(digest(again.columns()), digest(live.log.trace.columns()));
}

struct RecordedCase {
  const char* name;
  std::string experiment;  // its JSON, or its name
};
void PrintTo(const RecordedCase& recorded, std::ostream* out) {  // NOLINT(readability-identifier-naming)
  *out << recorded.name;
}

class RecordedLiveRun : public testing::TestWithParam<RecordedCase> {
 protected:
  static Experiment experiment() {
    const std::string& text = GetParam().experiment;
    if (text.front() == '{') return Experiment::from_json(text, "test");
    return Experiment::load(text, {"scenario.width=160", "scenario.height=120", "scenario.focal_px=131"});
  }
};

// A tick comes 3.7 ms late, and the numbers have a gap. They are rounded up: the last one is 2500.
TEST_P(RecordedLiveRun, GivesTheSameDigestOffline) {
  const TestFolder folder("live_run");
  SimulatedClock clock;
  SimulatedRun run(clock, experiment());
  run.options.duration_s = 2.5;
  run.record(folder / "session.h5");
  clock.at(0.7005, [&] { clock.sleep_s(0.0042); });
  const LiveResult result = run.run();
  EXPECT_EQ(result.log.missed_ticks, 4);
  EXPECT_EQ(result.log.trace.length(), 2501u - 4);
  expect_the_same_offline(run.options.record, result);
}

TEST(LiveRun, RefusesDelaysOfFramesThatItCannotSimulate) {
  for (const std::string setting : {"frame_latency_s", "frame_jitter_s", "frame_drop_probability"}) {
    const Experiment late = Experiment::from_json(kProxy, "test", {setting + "=0.25"});
    EXPECT_EQ(refusal([&] { run_live(late, options(0.1)); }),
              setting +
                  " = 0.250000: expected 0 in a live session, which uses each frame when the camera "
                  "has sent it");
  }
}

INSTANTIATE_TEST_SUITE_P(
    Renderers, RecordedLiveRun,
    testing::Values(RecordedCase{"three_dof", kProxy},
                    RecordedCase{"tracked_sheet",
                                 std::regex_replace(std::string(kProxy), std::regex("\"proxy\""),
                                                    "\"tracked-sheet\"")},
                    RecordedCase{"voxels", kTool}, RecordedCase{"sphere_tree", "fig7.4"}),
    [](const auto& tested) { return tested.param.name; });

// Someone moves sliders, one of them in a tick that comes late.
TEST_P(RecordedLiveRun, ChangesOfParametersAreRecordedAndReplayed) {
  const TestFolder folder("live_run");
  SimulatedClock clock;
  SimulatedRun run(clock, experiment());
  run.options.duration_s = 2.5;
  run.record(folder / "session.h5");
  run.options.controls =
      std::make_shared<LiveControls>(experiment(), scenes::kernels(), LiveControls::Camera::simulated);
  std::size_t requested = 0;
  // Changes the wanted parameters together. A switch gets the other value. Parameters that the renderer does
  // not have are left out.
  const auto change = [&](const std::vector<std::pair<std::string, double>>& wanted) {
    const auto& all = run.options.controls->parameters();
    ParameterChanges changes;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const auto& [name, factor] : wanted)
        if (all[i].name == name) {
          const double now = run.options.controls->values()[i];
          changes.list[changes.count++] = {static_cast<std::int32_t>(i),
                                           all[i].is_switch ? 1 - now : factor * now};
        }
    if (changes.count > 0) {
      EXPECT_EQ(run.options.controls->change(changes), "");
    }
    requested += changes.count;
  };
  clock.at(0.7005, [&] {
    change({{"renderer.stiffness_N_per_m", 1.5}});
    clock.sleep_s(0.0042);
  });
  clock.at(1.2, [&] { change({{"renderer.r1_m", 1.3}, {"renderer.r2_m", 1.3}, {"renderer.r3_m", 1.3}}); });
  clock.at(1.4, [&] { change({{"renderer.velocity_estimate", 0}}); });
  clock.at(1.5, [&] { change({{"renderer.stiffness_N_per_m", 0.5}}); });
  clock.at(1.6, [&] { change({{"scenario.noise_per_m", 3}}); });
  clock.at(1.7, [&] { change({{"renderer.velocity_estimate", 0}}); });
  const LiveResult result = run.run();
  expect_the_same_offline(run.options.record, result);
  const SessionReader session(run.options.record);
  ASSERT_GE(requested, 3u);
  ASSERT_EQ(session.changes().size(), requested);
  EXPECT_GE(session.changes()[0].tick, 701u);
  EXPECT_LE(session.changes()[0].tick, 706u);
  // The changes matter: the forces differ without them.
  nlohmann::json without = nlohmann::json::parse(Experiment::load(run.options.record.string()).to_json());
  ASSERT_EQ(without["changes"].size(), requested - 1) << "the noise is in the frames";
  without.erase("changes");
  const Trace unchanged = simulate(Experiment::from_json(without.dump(), "without"));
  EXPECT_NE(unchanged.force_N, result.log.trace.force_N);
}

// Scenes that no camera sees: the sensor sends clouds, one of them with normals.
const char* const kLift = R"({
  "scenario": {"name": "moving-lift", "columns": 60, "rows": 60, "acceleration_m_per_s2": 0.1},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints", "waypoints": [[0, 0.03, 0, 0], [0, -0.01, 0, 0.06]]}})";
const char* const kSheet = R"({
  "scenario": {"name": "panel"}, "renderer": {"name": "tool", "tool_mesh": "ball"},
  "trajectory": {"name": "poses", "poses": [[0, 0.04, 0, 0, 0, 0, 0], [0, -0.01, 0, 0, 0, 0, 0.6]]}})";

TEST(LiveRun, ARecordingOfCloudsGivesTheSameDigestOffline) {
  for (const char* const scene : {kLift, kSheet}) {
    const TestFolder folder("live_run");
    SimulatedClock clock;
    SimulatedRun run(clock, Experiment::from_json(scene, "test"));
    run.options.duration_s = 1;
    run.record(folder / "session.h5");
    const LiveResult result = run.run();
    expect_the_same_offline(run.options.record, result);
    double max_force_N = 0;
    for (const Vec3& force : result.log.trace.force_N) max_force_N = std::max(max_force_N, force.norm());
    EXPECT_GT(max_force_N, 0.1) << "it did not touch";
  }
}

// The run uses threads, and lasts as long as a busy machine needs to receive some frames.
TEST(LiveRun, ARecordingInRealTimeGivesTheSameDigestOffline) {
  const TestFolder folder("live_run");
  const Experiment experiment = Experiment::from_json(kProxy, "test");
  LiveOptions live = options(2.5);
  live.record = folder / "session.h5";
  live.provenance = {{"config", experiment.to_json()}};
  expect_the_same_offline(live.record, run_live(experiment, live));
}

TEST(LiveRun, FollowsItsDurationAndCountsEveryTick) {
  SimulatedClock clock;
  SimulatedRun run(clock, Experiment::from_json(kProxy, "test"));
  run.options.duration_s = 0.5;
  const LiveResult result = run.run();
  EXPECT_EQ(result.ended, "its duration has elapsed");
  ASSERT_EQ(result.log.trace.length(), 500u);
  EXPECT_EQ(result.log.missed_ticks, 0);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(result.log.trace.time_s[i], static_cast<double>(i) / 1000);
}

// A frame arrives in the first tick at or after its time, and rendering takes no time here.
TEST(LiveRun, MeasuresHowLongAFrameTook) {
  SimulatedClock clock;
  SimulatedRun run(clock, Experiment::from_json(kProxy, "test"));
  run.options.duration_s = 1;
  const LiveResult result = run.run();
  ASSERT_EQ(result.log.latency_s.size(), 30u);
  for (std::size_t i = 1; i < 30; ++i) {
    const double captured_ms = static_cast<double>(i) * 1000 / 30;
    EXPECT_NEAR(result.log.latency_s[i], 1e-3 * (std::ceil(captured_ms) - captured_ms), 1.1e-3) << i;
  }
  for (const double interval_s : result.log.interval_s.kept()) EXPECT_NEAR(interval_s, 1e-3, 1e-9);
  EXPECT_EQ(result.counts.stalls, 0);
}

TEST(LiveRun, AnUnknownDeviceIsRefusedWithThoseThereAre) {
  LiveOptions wrong = options(0.1);
  wrong.device = "falcon:0";
  EXPECT_HAS(refusal([&] { run_live(Experiment::from_json(kProxy, "test"), wrong); }),
             "--device falcon:0: expected sim:");
  wrong.device = "sim";
  EXPECT_HAS(refusal([&] { run_live(Experiment::from_json(kProxy, "test"), wrong); }),
             "--device sim: expected SCHEME");
}

// The refusal comes from what the sensor reports before its first frame.
TEST(LiveRun, AToolWithoutNormalsIsRefusedBeforeItStarts) {
  const auto line = [](const std::string& experiment) {
    return refusal([&] { run_live(Experiment::from_json(experiment, "test"), options(0.1)); });
  };
  EXPECT_HAS(line(std::regex_replace(std::string(kTool), std::regex(R"("depth_pipeline": \{\},)"), "")),
             "renderer.name = \"tool\": needs normals, and the points of the frames have none: add "
             "depth_pipeline");
  EXPECT_HAS(
      line(std::regex_replace(std::string(kLift), std::regex("\"proxy\""), R"("tool", "tool_mesh": "ball")")),
      "expected a scenario with normals");
}

TEST(LiveRun, AStopEndsItAtOnce) {
  const std::atomic<bool> stop = true;
  LiveOptions stopped = options(0);
  stopped.stop = &stop;
  EXPECT_EQ(run_live(Experiment::from_json(kProxy, "test"), stopped).ended, "stopped by a signal");
}

// Whole live runs with the adapters of depth cameras' libraries, with test doubles of the libraries, on a
// simulated clock.

// The camera is at the origin and faces along z a wall across its axis.
constexpr double kWall_m = 0.5;

class DepthLibraryRun : public testing::TestWithParam<const DepthLibrary*> {
 protected:
  void SetUp() override {
    camera_->state.distance_m = kWall_m;
    // The double of the Azure Kinect has a lens that distorts.
    if (GetParam() == &kK4a)
      camera_->state.lens = {
          .fx = 250, .fy = 251, .cx = 160.2, .cy = 143.1, .k = {-0.1, 0.01, 0, 0, 0, 0}, .p1 = 1e-3};
  }
  // The hand is in front of the wall until kPressed_s, then behind it.
  LiveResult run(double duration_s) {
    hold(kAbove_m);
    clock_.at(kPressed_s, [&] { hold(kBelow_m); });
    SimulatedRun run(
        clock_, press_experiment(),
        [](const Experiment&, Clock& clock) { return kForceDimension.open("", clock); },
        [](const Experiment&, Clock& clock) {
          return GetParam()->open(GetParam() == &kK4a ? "?nfov-binned" : "", clock);
        });
    run.options.duration_s = duration_s;
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  void hold(double above_m) { put(*device_, kForceDimension, {0, 0, kWall_m - above_m}); }
  ForceOverTime force() const { return force_of(*device_); }

  SimulatedClock clock_;
  CameraInstalled camera_{*GetParam(), &clock_};
  DoubleInstalled device_{kForceDimension, &clock_};
  std::vector<SimulatedRun::ReportedLine> reported_;
};

// There is no force in front of the wall. The spring pushes the hand out behind it.
TEST_P(DepthLibraryRun, TheHandFeelsWhatTheCameraSees) {
  const LiveResult result = run(0.79);
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_TRUE(reported_.empty()) << reported_[0].line;
  EXPECT_EQ(result.counts.camera.received, 23);  // 30 a second
  EXPECT_EQ(result.counts.camera.skipped, 0);
  EXPECT_EQ(result.counts.camera.reversed, 0);
  EXPECT_EQ(result.counts.camera.incomplete, 0);
  EXPECT_EQ(force().at(ms(190)), 0);
  EXPECT_GT(force().at(ms(700)), 1);
}

TEST_P(DepthLibraryRun, UnpluggedCameraLeavesItsLastCloudAndAFailure) {
  camera_->state.lost_after = 15;
  const LiveResult result = run(1.2);
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.counts.camera.received, 15);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_HAS(reported_[0].line, "no more frames (" + std::string(GetParam()->name));
  EXPECT_HAS(reported_[0].line, "was disconnected");
  EXPECT_HAS(reported_[0].line, ": the last cloud is still rendered");
  EXPECT_LE(reported_[0].at_ns, ms(700));  // the frame that did not come was due at 533 ms
  EXPECT_NEAR(force().at(ms(1150)), force().at(ms(520)), 0.02 * force().at(ms(520)));
}

TEST_P(DepthLibraryRun, SilentCameraLeavesItsLastCloud) {
  camera_->state.silent_after = 15;
  const LiveResult result = run(1.2);
  EXPECT_FALSE(result.failed) << result.ended;
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no frame for 0.2 s: the last cloud is still rendered");
  EXPECT_GT(force().at(ms(1150)), 1);
}

INSTANTIATE_TEST_SUITE_P(All, DepthLibraryRun, testing::Values(&kK4a, &kRealSense),
                         [](const auto& given) { return std::string(given.param->name); });

}  // namespace
}  // namespace remote_touch::live_run_test
