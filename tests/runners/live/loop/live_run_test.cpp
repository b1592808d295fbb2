// The live loop with simulated sensors and devices: its results, and the replay of a recording of it.
#include "runners/live/loop/live_run.h"

#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "analysis/storage/digest.h"
#include "tests/runners/live/loop/simulated_run.h"

namespace remote_touch::live_run_test {
namespace {

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

// Scenes that no camera sees: the sensor sends clouds, one of them with normals.
const char* const kLift = R"({
  "scenario": {"name": "moving-lift", "columns": 60, "rows": 60, "acceleration_m_per_s2": 0.1},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints", "waypoints": [[0, 0.03, 0, 0], [0, -0.01, 0, 0.06]]}})";
const char* const kSheet = R"({
  "scenario": {"name": "panel"}, "renderer": {"name": "tool", "tool_mesh": "ball"},
  "trajectory": {"name": "poses", "poses": [[0, 0.04, 0, 0, 0, 0, 0], [0, -0.01, 0, 0, 0, 0, 0.6]]}})";

Experiment experiment(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return Experiment::from_json(text, "test", overrides);
}
std::string replaced(const char* text, const char* part, const char* by) {
  return std::regex_replace(std::string(text), std::regex(part), by);
}

void expect_the_same_offline(const RecordedRun& recorded) {
  const LiveResult& live = recorded.result;
  ASSERT_FALSE(live.failed) << live.ended;
  ASSERT_GT(live.log.trace.length(), 100u);
  ASSERT_GT(live.log.latency_s.size(), 2u) << "frames taken";
  EXPECT_EQ(live.counts.rows_lost, 0);
  EXPECT_EQ(live.log.reversed_frames, 0);
  EXPECT_EQ(digest(recorded.again().columns()), digest(live.log.trace.columns()));
}

struct RecordedCase {
  const char* name;
  std::string experiment;  // its JSON, or its name
};
class RecordedLiveRun : public testing::TestWithParam<RecordedCase> {
 protected:
  static Experiment loaded() {
    const std::string& text = GetParam().experiment;
    if (text.front() == '{') return experiment(text);
    return Experiment::load(text, {"scenario.width=160", "scenario.height=120", "scenario.focal_px=131"});
  }
};
INSTANTIATE_TEST_SUITE_P(
    Renderers, RecordedLiveRun,
    testing::Values(RecordedCase{"three_dof", kProxy},
                    RecordedCase{"tracked_sheet", replaced(kProxy, "\"proxy\"", "\"tracked-sheet\"")},
                    RecordedCase{"voxels", kTool}, RecordedCase{"sphere_tree", "fig7.4"}),
    [](const auto& tested) { return std::string(tested.param.name); });

// A tick comes 3.7 ms late, and the numbers have a gap. They are rounded up: the last one is 2500. Someone
// moves sliders, one of them in that tick.
TEST_P(RecordedLiveRun, ChangesOfParametersAreRecordedAndReplayed) {
  RecordedRun recorded(loaded(), 2.5);
  SimulatedClock& clock = recorded.clock;
  const auto controls =
      std::make_shared<LiveControls>(loaded(), scenes::kernels(), LiveControls::Camera::simulated);
  recorded.run.options.controls = controls;
  std::size_t requested = 0;
  // Changes the wanted parameters together. A switch gets the other value. Parameters that the renderer does
  // not have are left out.
  const auto change = [&](const std::vector<std::pair<std::string, double>>& wanted) {
    ParameterChanges changes;
    for (std::size_t i = 0; i < controls->parameters().size(); ++i)
      for (const auto& [name, factor] : wanted) {
        const LiveParameter& parameter = controls->parameters()[i];
        const double now = controls->values()[i];
        if (parameter.name == name)
          changes.list[changes.count++] = {static_cast<std::int32_t>(i),
                                           parameter.is_switch ? 1 - now : factor * now};
      }
    if (changes.count > 0) {
      EXPECT_EQ(controls->change(changes), "");
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
  recorded.go();
  EXPECT_EQ(recorded.result.log.missed_ticks, 4);
  EXPECT_EQ(recorded.result.log.trace.length(), 2501u - 4);
  expect_the_same_offline(recorded);
  const std::string file = recorded.run.options.record.string();
  const SessionReader session(file);
  ASSERT_GE(requested, 3u);
  ASSERT_EQ(session.changes().size(), requested);
  EXPECT_GE(session.changes()[0].tick, 701u);
  EXPECT_LE(session.changes()[0].tick, 706u);
  // The changes matter: the forces differ without them.
  nlohmann::json without = nlohmann::json::parse(Experiment::load(file).to_json());
  ASSERT_EQ(without["changes"].size(), requested - 1) << "the noise is in the frames";
  without.erase("changes");
  EXPECT_NE(simulate(experiment(without.dump())).force_N, recorded.result.log.trace.force_N);
}

TEST(LiveRun, ARecordingOfCloudsGivesTheSameDigestOffline) {
  for (const char* const scene : {kLift, kSheet}) {
    RecordedRun recorded(experiment(scene), 1);
    recorded.go();
    expect_the_same_offline(recorded);
    double max_force_N = 0;
    for (const Vec3& force : recorded.result.log.trace.force_N)
      max_force_N = std::max(max_force_N, force.norm());
    EXPECT_GT(max_force_N, 0.1) << "it did not touch";
  }
}

// The run uses threads, and lasts as long as a busy machine needs to receive some frames.
TEST(LiveRun, ARecordingInRealTimeGivesTheSameDigestOffline) {
  RecordedRun recorded(experiment(kProxy), 2.5);
  recorded.result = run_live(experiment(kProxy), recorded.run.options);
  expect_the_same_offline(recorded);
}

// A frame arrives in the first tick at or after its time, and rendering takes no time here.
TEST(LiveRun, MeasuresHowLongAFrameTook) {
  RecordedRun recorded(experiment(kProxy), 1);
  recorded.go();
  const LiveResult& result = recorded.result;
  ASSERT_EQ(result.log.latency_s.size(), 30u);
  for (std::size_t i = 1; i < 30; ++i) {
    const double captured_ms = static_cast<double>(i) * 1000 / 30;
    EXPECT_NEAR(result.log.latency_s[i], 1e-3 * (std::ceil(captured_ms) - captured_ms), 1.1e-3) << i;
  }
  for (const double interval_s : result.log.interval_s.kept()) EXPECT_NEAR(interval_s, 1e-3, 1e-9);
  EXPECT_EQ(result.counts.stalls, 0);
}

// The last two refusals come from what the sensor reports before its first frame.
TEST(LiveRun, RefusesWhatItCannotDoBeforeItStarts) {
  struct Refused {
    std::string experiment, setting, device, message;
  };
  const char* const delay =
      " = 0.250000: expected 0 in a live session, which uses each frame when the camera has sent it";
  const std::string no_normals = replaced(kTool, R"("depth_pipeline": \{\},)", "");
  const Refused all[] = {
      {kProxy, "frame_latency_s", "sim:", std::string("frame_latency_s") + delay},
      {kProxy, "frame_jitter_s", "sim:", std::string("frame_jitter_s") + delay},
      {kProxy, "frame_drop_probability", "sim:", std::string("frame_drop_probability") + delay},
      {kProxy, "", "falcon:0", "--device falcon:0: expected sim:"},
      {no_normals, "", "sim:",
       "renderer.name = \"tool\": needs normals, and the points of the frames have none: add depth_pipeline"},
      {replaced(kLift, "\"proxy\"", R"("tool", "tool_mesh": "ball")"), "",
       "sim:", "expected a scenario with normals"}};
  for (const Refused& each : all) {
    LiveOptions options;
    options.kernels = &scenes::kernels(), options.duration_s = 0.1, options.device = each.device;
    const std::vector<std::string> settings(each.setting.empty() ? 0 : 1, each.setting + "=0.25");
    EXPECT_HAS(refusal([&] { run_live(experiment(each.experiment, settings), options); }), each.message);
  }
}

}  // namespace
}  // namespace remote_touch::live_run_test
