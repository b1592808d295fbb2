// The live loop against simulated sensors and devices: what it leaves, what a recording of it gives again,
// and what the device feels when something fails.
#include "runners/live/loop/live_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>

#include "analysis/storage/digest.h"
#include "runners/simulation/simulation.h"
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

// A hand that follows the scene, with small images so that a machine with little to spare keeps up.
const char* const kProxy = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "follow-surface", "from_m": [0, 0, -0.1], "to_m": [0, 0, 0.1], "depth_m": 0.003,
                 "speed_m_per_s": 0.1, "clearance_m": 0.01}})";

const char* const kTool = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120}, "depth_pipeline": {},
  "renderer": {"name": "tool", "tool_mesh": "ball"},
  "trajectory": {"name": "poses", "poses": [[0, 0.06, 0, 0, 0, 0, 0], [0, 0.01, 0, 0, 0, 0, 0.5],
                                            [0.05, 0.01, 0, 0, 0, 0, 1]]}})";

TEST(LiveRun, ARecordingGivesTheSameDigestOffline) {
  const std::string tracked =
      std::regex_replace(std::string(kProxy), std::regex("\"proxy\""), "\"tracked-sheet\"");
  const struct {
    const char* name;
    std::string experiment;
  } cases[] = {
      {"3-DOF", kProxy}, {"tracked sheet", tracked}, {"6-DOF voxels", kTool}, {"sphere tree", "fig7.4"}};
  for (const auto& [name, experiment] : cases) {
    const TestFolder folder("live_run");
    const std::filesystem::path file = folder / "session.h5";
    LiveOptions live = options(2.5);
    live.record = file;
    const Experiment run = experiment.front() == '{'
                               ? Experiment::from_json(experiment, name)
                               : Experiment::load(experiment, {"scenario.width=160", "scenario.height=120",
                                                               "scenario.focal_px=131"});
    live.provenance = {{"config", run.to_json()}};
    const LiveResult result = run_live(run, live);
    ASSERT_FALSE(result.failed) << name << ": " << result.ended;
    ASSERT_GT(result.log.trace.length(), 100u) << name;
    ASSERT_GT(result.log.latency_s.size(), 2u) << name << ": frames taken";
    EXPECT_EQ(result.counts.rows_lost, 0) << name;
    EXPECT_EQ(result.log.reversed_frames, 0) << name;

    SimulationOptions offline;
    offline.kernels = &scenes::kernels();
    offline.hash_frames = true;
    const Trace again = simulate(Experiment::load(file.string()), offline);
    ASSERT_EQ(again.length(), result.log.trace.length()) << name;
    EXPECT_EQ(digest(again.columns()), digest(result.log.trace.columns())) << name;
  }
}

TEST(LiveRun, FollowsItsDurationAndCountsEveryTick) {
  const LiveResult result = run_live(Experiment::from_json(kProxy, "test"), options(0.5));
  EXPECT_EQ(result.ended, "its duration is over");
  const auto ticks = static_cast<std::int64_t>(result.log.trace.length());
  EXPECT_NEAR(static_cast<double>(ticks + result.log.missed_ticks), 500, 60);
  for (std::size_t i = 1; i < result.log.trace.length(); ++i)
    ASSERT_GT(result.log.trace.time_s[i], result.log.trace.time_s[i - 1]);
}

TEST(LiveRun, AScenarioWithoutDepthImagesIsRefused) {
  EXPECT_HAS(refusal([] { run_live(Experiment::load("fig4.11"), options(0.1)); }), "--depth sim:");
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

TEST(LiveRun, AStopEndsItAtOnce) {
  const std::atomic<bool> stop = true;
  LiveOptions stopped = options(0);
  stopped.stop = &stop;
  EXPECT_EQ(run_live(Experiment::from_json(kProxy, "test"), stopped).ended, "stopped by a signal");
}

}  // namespace
}  // namespace remote_touch::live_run_test
