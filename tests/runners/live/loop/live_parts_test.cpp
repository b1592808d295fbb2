#include "runners/live/loop/live_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/trace/contact_measures.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/note_kinds.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_parts_test {
namespace {

// A simulated slave behind the hand of a live session: what it touches, what the device exerts, and the
// replay of the recording.

// A surface that moves up and down by 1 cm. The hand ends 2 cm below its middle.
std::string shaken(const std::string& more) {
  return R"({"scenario": {"name": "moving-shape", "columns": 40, "rows": 40, "shake_amplitude_m": 0.01,
                          "shake_hz": 1, "truth": "moving"},
             "renderer": {"name": "proxy"}, "slave": {"natural_frequency_hz": 4},
             "trajectory": {"name": "waypoints", "waypoints": [[0, 0.04, 0, 0], [0, -0.02, 0, 0.1]]},
             "command_link": {"delay_s": 0.02, "jitter_s": 0.01, "loss_probability": 0.1},
             "force_link": {"delay_s": 0.03}, "safety": {"ramp_s": 0.01})" +
         more + "}";
}

std::string felt(const char* force) {
  return R"(, "feedback": {"force": ")" + std::string(force) + "\"}";
}

Experiment experiment(const std::string& text) {
  return Experiment::from_json(text, "test");
}

// pause_s: how long a tick comes late. depth: the address that the session has for its camera.
struct Session : RecordedRun {
  Session(const std::string& text, double duration_s, double pause_s = 0, const std::string& depth = "sim:")
      : RecordedRun(experiment(text), duration_s) {
    run.options.depth = depth;
    run.options.on_tick = [&](const LiveTick& tick) { ticks.push_back(tick); };
    if (pause_s > 0) clock.at(0.7005, [this, pause_s] { clock.sleep_s(pause_s); });
    go();
  }
  std::vector<LiveTick> ticks;
};

// The replay builds the scene that the slave touched, and leaves out the same ticks.
TEST(LiveSlave, ARecordingGivesTheSameSlaveOffline) {
  for (const char* force : {"rendered", "none", "slave-force", "passive-slave-force"})
    for (const double pause_s : {0.0, 0.0042, 0.5}) {
      SCOPED_TRACE(std::string(force) + ", a pause of " + std::to_string(pause_s) + " s");
      const Session s(shaken(felt(force)), 1.5, pause_s);
      ASSERT_FALSE(s.result.failed) << s.result.ended;
      EXPECT_EQ(s.result.log.missed_ticks > 0, pause_s > 0);
      const Trace& trace = s.result.log.trace;
      ASSERT_TRUE(trace.has_slave());
      EXPECT_GT(max_slave_force_N(trace), 1) << "it did not touch";
      EXPECT_EQ(digest(s.again().columns()), digest(trace.columns()));
      if (pause_s > 0.1) continue;  // the device was released
      EXPECT_EQ(s.lines(), std::vector<std::string>{});
      EXPECT_EQ(kinds_of(s.result.report.notes), Kinds{});
    }
}

// The offline run of the same experiment decides without threads. Its hand and slave are the same up to a
// tick.
TEST(LiveSlave, TheDeadBandOfFramesDecidesAsOffline) {
  const std::string band = felt("none") + R"(, "frame_link": {"least_motion_m": 0.002}, "duration_s": 2.49)";
  const std::int32_t sent_offline = simulate(experiment(shaken(band))).frame_packets.back();
  for (const double pause_s : {0.0, 0.5}) {
    const Session s(shaken(band), 2.49, pause_s);
    const Trace& trace = s.result.log.trace;
    ASSERT_FALSE(s.result.failed) << s.result.ended;
    const std::int32_t sent = trace.frame_packets.back(), captured = s.result.counts.camera.received;
    EXPECT_EQ(sent + s.result.counts.camera.held_back + s.result.counts.camera.overtaken, captured);
    EXPECT_GT(captured, 70) << pause_s;
    EXPECT_LT(sent, 0.7 * captured) << pause_s;
    EXPECT_EQ(digest(s.again().columns()), digest(trace.columns())) << pause_s;
    if (pause_s > 0) continue;
    EXPECT_NEAR(sent, sent_offline, 1);
    EXPECT_GT(sent, 20);
    EXPECT_EQ(s.lines(), std::vector<std::string>{}) << "a frame that is held back is no stalled camera";
    EXPECT_EQ(kinds_of(s.result.report.notes), Kinds{});
  }
}

// A plane at a height, 4 mm between the points.
Frame plane(double captured_s, double height_m) {
  PointCloud cloud;
  for (int i = -10; i < 10; ++i)
    for (int k = -10; k < 10; ++k)
      cloud.x.push_back(0.004 * i), cloud.y.push_back(height_m), cloud.z.push_back(0.004 * k);
  Frame frame;
  frame.captured_s = captured_s, frame.points = make_search(std::move(cloud));
  return frame;
}

TEST(LiveSlave, SendsFramesWhileItDoesNotKnowWhereTheSlaveIs) {
  LiveSlave slave(experiment(shaken(R"(, "frame_link": {"least_motion_m": 0.002})")),
                  "sim:", scenes::kernels());
  ASSERT_TRUE(slave.places());
  const auto stay = [&](std::size_t from, std::size_t ticks) {
    for (std::size_t i = from; i < from + ticks; ++i) {
      SlavePlace* const place = slave.places()->next_slot();
      if (!place) return;
      *place = {0.001 * static_cast<double>(i), Vec3(0, 0.01, 0)};
      slave.places()->push();
    }
  };
  EXPECT_TRUE(slave.sends(plane(0, 0)));
  EXPECT_TRUE(slave.sends(plane(0.01, 0))) << "it has no position yet";
  stay(10, 100);
  EXPECT_FALSE(slave.sends(plane(0.05, 0.001)));
  EXPECT_FALSE(slave.sends(plane(0.1, -0.001)));
  EXPECT_TRUE(slave.sends(plane(0.105, 0.003)));
  stay(110, 2 * LiveSlave::kMostPlaces);
  EXPECT_TRUE(slave.sends(plane(9, 0.003))) << "positions were lost";
  EXPECT_TRUE(slave.sends(plane(9.01, 0.003)));
  stay(9020, 10);
  EXPECT_FALSE(slave.sends(plane(9.03, 0.003)));
  EXPECT_FALSE(LiveSlave(experiment(shaken("")), "sim:", scenes::kernels()).places());
}

double max_written_N(const Session& s) {
  double max_N = 0;
  for (const LiveTick& tick : s.ticks) max_N = std::max(max_N, tick.written.force_N.norm());
  return max_N;
}

// The command passes the gate, which ramps it and limits it.
TEST(LiveSlave, TheDeviceExertsTheForceOfTheFeedback) {
  EXPECT_EQ(max_written_N(Session(shaken(felt("none")), 1)), 0);
  const Session free(shaken(felt("slave-force")), 1);
  double max_N = 0;
  std::size_t engaged = 0;
  for (const LiveTick& tick : free.ticks) {
    max_N = std::max(max_N, tick.command.force_N.norm());
    if (tick.gate != GateState::engaged || !(tick.command.force_N.norm() < 0.1)) continue;
    EXPECT_LE((tick.written.force_N - tick.command.force_N).norm(), 3);
    ++engaged;
  }
  EXPECT_GT(engaged, 10u);
  EXPECT_GT(max_N, 3);
  EXPECT_GT(max_written_N(free), 1);
  EXPECT_LE(max_written_N(Session(shaken(R"(, "feedback": {"force": "slave-force", "gain": 20})"), 1)),
            SafetyLimits{}.max_force_N + 1e-9);
}

TEST(LiveSlave, WithoutATrueSurfaceItMovesButTouchesNothing) {
  const Session s(shaken(felt("slave-force")), 1, 0, "k4a:0");
  const Trace& trace = s.result.log.trace;
  EXPECT_EQ(s.lines(),
            std::vector<std::string>{"slave without surface: the camera k4a:0 has no true surface, "
                                     "so the slave moves but cannot touch anything"});
  EXPECT_EQ(max_slave_force_N(trace), 0);
  EXPECT_LT(trace.slave_position_m.back().y(), 0);
  EXPECT_TRUE(std::isnan(trace.slave_clearance_m.back()));
  EXPECT_EQ(kinds_of(s.result.report.notes).back(), "slave without surface");
  EXPECT_EQ(digest(s.again().columns()), digest(trace.columns()));
  const auto why = [](const Experiment& experiment) {
    return LiveSlave(experiment, "sim:", scenes::kernels()).why_untouching();
  };
  EXPECT_HAS(why(Experiment::load("fig5.5", {"slave={}"})), "slave without surface: this scenario");
  EXPECT_EQ(why(Experiment::load("fig5.5")), "");
  EXPECT_EQ(why(experiment(shaken(""))), "");
}

// The session of a session touches the same scene.
TEST(LiveSlave, ASessionOfASessionHasTheSceneOfTheFirst) {
  const TestFolder folder("live_slave");
  std::string file;
  for (const char* name : {"first.h5", "second.h5"}) {
    SimulatedClock clock;
    SimulatedRun run(clock, file.empty() ? experiment(shaken(felt("none"))) : Experiment::load(file));
    run.options.duration_s = 1;
    file = (folder / name).string();
    run.record(file);
    const LiveResult result = run.run();
    EXPECT_GT(max_slave_force_N(result.log.trace), 1) << name;
  }
  const Experiment again = Experiment::load(file);
  EXPECT_GT(max_slave_force_N(simulate(again)), 1);
  std::vector<std::string> inputs;
  for (const InputPart& part : again.inputs()) inputs.push_back(part.path);
  EXPECT_EQ(inputs, (std::vector<std::string>{file, file, (folder / "first.h5").string()}));
}

// Scenes of panels make a list of them for each distance, so they are not here. A ball is pressed onto each
// other simulated scene, with lost packets and ticks that are missing.
TEST(LiveSlave, ATickAllocatesNothingInAnySimulatedScene) {
  std::size_t tried = 0;
  for (const char* scene : {"flat-grid", "moving-lift", "moving-plane", "moving-shape", "camera-scene",
                            "beating-heart", "valve-tank", "mesh-scene", "triangle-wave", "plates"}) {
    const std::string text = R"({"scenario": {"name": ")" + std::string(scene) +
                             R"("}, "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"},
        "slave": {}, "command_link": {"delay_s": 0.02, "jitter_s": 0.05, "reorders": true},
        "force_link": {"delay_s": 0.1}, "feedback": {"force": "passive-slave-force"}})";
    LiveSlave slave(experiment(text), "sim:", scenes::kernels());
    if (slave.why_untouching() != "") continue;
    const PointCloud seen = experiment(text).build_scenario(scenes::kernels())->cloud(0);
    std::size_t middle = seen.size() / 2;
    while (middle < seen.size() && !seen.is_measured(middle)) ++middle;
    ASSERT_LT(middle, seen.size()) << scene;
    double max_N = 0;
    const std::size_t before = allocation_count();
    for (int i = 0; i < 600; ++i) {
      if (i % 100 > 90) continue;
      DeviceState hand;
      hand.position_W = seen.point(middle) + Vec3(1e-6 * i, 0, 0);
      slave.remote()->tick(hand, {}, 0.001 * i);
      max_N = std::max(max_N, slave.remote()->state().peak_force_N);
    }
    EXPECT_EQ(allocation_count(), before) << scene;
    EXPECT_GT(max_N, 0) << scene;
    ++tried;
  }
  EXPECT_GE(tried, 8u);
}

// The memory that a live run reserves for the points of its camera, and its end if a frame cannot be used.

// An image in which every pixel is measured gives the most tiles that a renderer keeps.
TEST(ExpectedPoints, EveryImageAndCloudHasRoom) {
  for (const int width : {1, 7, 8, 17, 64, 100, 641})
    for (const int height : {1, 9, 16, 31, 97}) {
      PointCloud cloud;
      cloud.image = ImageLayout{{}, RigidTransform::Identity()};
      cloud.image->camera.width = width, cloud.image->camera.height = height;
      cloud.image->camera.fx = cloud.image->camera.fy = 500;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) cloud.append(Vec3(0.002 * u, 0.002 * v, 1));
      TiledCloud tiled;
      tiled.assign(cloud);
      SensorView view;
      view.camera = cloud.image->camera;
      EXPECT_GE(expected_points(view), tiled.padded_size()) << width << " x " << height;
    }
  SensorView view;
  view.cloud.emplace();
  view.cloud->expected_points = 1000;
  EXPECT_GE(expected_points(view), 2000u) << "a cloud may grow to twice its size";
}

// The simulated hand follows the recording, whose fourth image has another size.
TEST(LiveParts, ReportTheFrameThatTheSimulatedHandCannotUse) {
  const TestFolder folder("live_size_changes");
  folder.write("camera.json", R"({"width": 80, "height": 60, "fx": 75, "fy": 75, "cx": 39.5, "cy": 29.5,
    "depth_scale_m": 0.001, "frame_rate_hz": 30})");
  for (int i = 0; i < 6; ++i) {
    const int width = i == 3 ? 40 : 80;
    const std::vector<std::uint16_t> samples(static_cast<std::size_t>(width) * 60, 500);
    folder.write_png("depth/" + std::to_string(i) + ".png", width, 60, PNG_FORMAT_LINEAR_Y, samples.data());
  }
  const std::string text = R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
                           R"("}, "renderer": {"name": "proxy"}, "trajectory": {"name": "image-press",
                           "margin_m": 0.02}})";
  for (const double duration_s : {0.05, 0.3}) {
    SimulatedClock clock;
    // The camera of the run sees another scene, so that only the hand reads the recording.
    SimulatedRun run(clock, Experiment::from_json(text, "test"), SimulatedRun::simulated_device,
                     [](const Experiment&, Clock& with) {
                       return SimulatedRun::scenario_camera(press_experiment(), with);
                     });
    run.options.duration_s = duration_s;
    const LiveResult result = run.run();
    EXPECT_EQ(result.failed, duration_s > 0.1);
    if (!result.failed) {
      EXPECT_EQ(result.refused, "");
    } else {
      EXPECT_HAS(result.refused, "depth/3.png");
      EXPECT_HAS(result.ended, "the device failed: " + result.refused);
    }
  }
}

}  // namespace
}  // namespace remote_touch::live_parts_test
