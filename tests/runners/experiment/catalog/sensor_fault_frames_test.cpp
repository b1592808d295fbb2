// Each fault of a sensor that concerns whole frames, faults together, and the section of an experiment.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/files/input_files.h"
#include "tests/doubles/frame_recorder.h"
#include "tests/support/scenes.h"
#include "tests/support/sensor_fault_scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sensor_fault_frames_test {
namespace {

// --- frames ---

TEST(SensorFaultFrames, RepeatedFramesShowTheOneBeforeThem) {
  SensorFaults s;
  s.repeat_probability = 0.4, s.dropout_probability = 0.1, s.flying_probability = 0.1;
  MovingShape::Settings noisy = rising_plane();
  noisy.motion.lift.rise_s = 400 / 30.0, noisy.noise_sigma_m = 0.001, noisy.grid = {8, 8, 0.002, 0, 0};
  const FaultySensor sensor = faulty(s, bare(noisy));
  double repeated = 0, chained = 0;
  bool before = false;
  for (int frame = 1; frame < 400; ++frame) {
    const bool again = same_points(sensor.cloud(frame), sensor.cloud(frame - 1));
    repeated += again, chained += again && before;
    before = again;
    EXPECT_EQ(sensor.captured_s(frame), frame / 30.0) << "its own time stamp";
  }
  expect_fraction(repeated, 399, 0.4);
  expect_fraction(chained, repeated, 0.4);
  s.dropout_probability = s.flying_probability = 0, s.repeat_probability = 1;
  EXPECT_TRUE(same_points(faulty(s, bare(noisy)).cloud(300), bare(noisy)->cloud(0)));
}

std::vector<Frame> received(const Scenario& scenario, double until_s, const Transport& transport = {}) {
  FrameStream stream(scenario, {}, transport, kKey, false);
  return received(stream, until_s);
}

TEST(SensorFaultFrames, LateFramesComeLaterAndAreOvertaken) {
  SensorFaults s;
  s.late_probability = 0.3, s.late_delay_s = 0.05;
  MovingShape::Settings plane = rising_plane();
  plane.motion.lift.rise_s = 299 / 30.0, plane.grid = {4, 4, 0.002, 0, 0};
  const FaultySensor sensor = faulty(s, bare(plane));
  // The scenario has 300 frames. The frames that the sensor adds are late as often as these.
  const auto frames = received(sensor, 13.334);
  ASSERT_GT(frames.size(), 395u);
  double late = 0;
  int overtaken = 0;
  std::set<int> came;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double delay = frames[i].arrives_s - frames[i].captured_s;
    ASSERT_TRUE(std::abs(delay) < 1e-12 || std::abs(delay - 0.05) < 1e-12) << delay;
    EXPECT_EQ(delay > 0.01, sensor.delivery(frames[i].index).leaves_sensor_s.has_value());
    late += delay > 0.01 ? 1 : 0;
    came.insert(frames[i].index);
    if (i == 0) continue;
    EXPECT_GE(frames[i].arrives_s, frames[i - 1].arrives_s);
    overtaken += frames[i].index < frames[i - 1].index ? 1 : 0;
  }
  expect_fraction(late, static_cast<double>(frames.size()), 0.3);
  EXPECT_GT(overtaken, 20);
  EXPECT_EQ(came.size(), frames.size());
}

TEST(SensorFaultFrames, FramesNeverEndIfTheirFaultsDiffer) {
  SensorFaults s;
  s.quantisation_m = 0.001;
  EXPECT_EQ(faulty(s).frame_count(), 41);
  for (double SensorFaults::*fraction :
       {&SensorFaults::repeat_probability, &SensorFaults::rolling_shutter_s,
        &SensorFaults::flying_probability, &SensorFaults::outlier_probability, &SensorFaults::hole_fraction,
        &SensorFaults::dropout_probability, &SensorFaults::late_probability}) {
    SensorFaults one;
    one.*fraction = 0.1;
    const FaultySensor sensor = faulty(one);
    EXPECT_EQ(sensor.frame_count(), std::numeric_limits<int>::max());
    EXPECT_NEAR(sensor.captured_s(60), 2, 1e-12);
    EXPECT_EQ(sensor.newest_frame(2.001), 60);
    EXPECT_EQ(sensor.cloud(60).size(), 3000u);
    EXPECT_EQ(sensor.surface_height(0, 0, 2), bare()->surface_height(0, 0, 2));
  }
}

// --- rows that are read one after the other ---

TEST(SensorFaultFrames, ShearShowsARisingPlaneAsItWas) {
  SensorFaults s;
  s.rolling_shutter_s = 0.02;
  const FaultySensor sensor = faulty(s);
  const PointCloud before = bare()->cloud(20), after = sensor.cloud(20);
  const double low = rising_plane().grid.z(0), high = rising_plane().grid.z(49);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double fraction = (before.z[i] - low) / (high - low);
    ASSERT_NEAR(after.y[i], before.y[i] - 0.3 * (1 - fraction) * 0.02, 1e-12);
    ASSERT_NEAR(after.x[i], before.x[i], 1e-12);
    ASSERT_NEAR(after.z[i], before.z[i], 1e-12);
  }
}

TEST(SensorFaultFrames, ShearMovesAlongTheNormalOfATiltedPlane) {
  MovingShape::Settings tilted = rising_plane();
  tilted.motion.tilt_deg = 30;
  SensorFaults s;
  s.rolling_shutter_s = 0.02;
  const PointCloud before = bare(tilted)->cloud(20), after = faulty(s, bare(tilted)).cloud(20);
  const Vec3 normal(-0.5, std::sqrt(0.75), 0);
  // The first row was read 20 ms earlier. Its ends are left out, because the plane ended elsewhere then.
  for (std::size_t i = 2; i < 58; ++i) {
    const Vec3 displacement = after.point(i) - before.point(i);
    // The plane rises at 0.3 m/s, which is 0.3 m/s times the cosine of the tilt along its normal.
    EXPECT_LT((displacement + 0.3 * 0.02 * std::sqrt(0.75) * normal).norm(), 1e-9);
  }
}

TEST(SensorFaultFrames, FramesAreNotShearedIfTheTruthIsUnknownOrAtRest) {
  SensorFaults s;
  s.rolling_shutter_s = 0.02;
  MovingShape::Settings rests = rising_plane();
  rests.motion = {};
  EXPECT_TRUE(same_points(faulty(s, bare(rests)).cloud(3), bare(rests)->cloud(0)));
  const TestFolder folder("sensor_faults_test");
  folder.write_depth("depth/0000.png", 500), folder.write_depth("depth/0001.png", 600);
  folder.write("camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 10, "cx": 1, "cy": 0.5,
                                  "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  const auto built = [&](const std::string& faults) {
    const std::string text = R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
                             R"("}, "faults": )" + faults +
                             R"(, "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}})";
    return Experiment::from_json(text, "recorded").build_scenario(scenes::kernels());
  };
  const auto plain = built("{}"), sheared = built(R"({"rolling_shutter_s": 0.02})");
  EXPECT_TRUE(same_points(sheared->cloud(1), plain->cloud(1)));
  EXPECT_TRUE(std::isnan(plain->signed_distance(Vec3::Zero(), 0)));
  EXPECT_EQ(measured(built(R"({"dropout_probability": 1})")->cloud(1)), 0u) << "recordings can wear faults";
}

// A plane approaches the camera. The points that its pixels saw earlier lie on the same rays.
TEST(SensorFaultFrames, ShearMovesThePointsOfAnImageAlongTheirRays) {
  class Wall final : public Scenario {
   public:
    double frame_rate_hz() const override { return 30; }
    int frame_count() const override { return 100; }
    PointCloud cloud(int frame) const override {
      PointCloud cloud;
      cloud.image = ImageLayout{{9, 5, 10, 10, 4, 2}, RigidTransform::Identity(), 0};
      for (int i = 0; i < 45; ++i)
        cloud.append(unproject(cloud.image->camera, i % 9, i / 9, depth(captured_s(frame))));
      return cloud;
    }
    double signed_distance(const Vec3& p_W, double time_s) const override { return depth(time_s) - p_W.z(); }
    static double depth(double time_s) { return 2 - 0.4 * time_s; }
  };
  SensorFaults s;
  s.rolling_shutter_s = 0.1;
  const PointCloud cloud = faulty(s, std::make_unique<Wall>()).cloud(30);
  for (int i = 0; i < 45; ++i) {
    const double then_s = 1 - (1 - (i / 9) / 4.0) * 0.1;
    const Vec3 expected = unproject(cloud.image->camera, i % 9, i / 9, Wall::depth(then_s));
    EXPECT_LT((cloud.point(static_cast<std::size_t>(i)) - expected).norm(), 1e-9);
  }
}

// --- together ---

SensorFaults everything() {
  SensorFaults s;
  s.repeat_probability = 0.2, s.rolling_shutter_s = 0.01, s.flying_probability = 0.1,
  s.outlier_probability = 0.05;
  s.quantisation_m = 0.002, s.hole_fraction = 0.2, s.dropout_probability = 0.1, s.late_probability = 0.2;
  return s;
}

TEST(SensorFaultFrames, FramesArePure) {
  const FaultySensor one = faulty(everything()), other = faulty(everything());
  one.cloud(30);
  for (const int frame : {7, 0, 41, 100}) {
    EXPECT_TRUE(same_points(one.cloud(frame), other.cloud(frame)));
    EXPECT_EQ(one.delivery(frame).leaves_sensor_s, other.delivery(frame).leaves_sensor_s);
  }
  EXPECT_FALSE(same_points(one.cloud(7), faulty(everything(), bare(), {6, 2, 3}).cloud(7)));
}

// The path of the hand is planned on the images without faults.
TEST(SensorFaultFrames, TheHandIsThatOfTheBareScenario) {
  for (const char* name : {"fig4.12", "fig4.16"}) {
    const Experiment plain = Experiment::load(name),
                     blind = Experiment::load(
                         name, {"faults.dropout_probability=1", "faults.repeat_probability=1"});
    const auto scene = plain.build_scenario(scenes::kernels());
    const auto dark = blind.build_scenario(scenes::kernels());
    const auto hand = plain.build_trajectory(*scene), same = blind.build_trajectory(*dark);
    EXPECT_EQ(hand->duration_s(), same->duration_s());
    for (int tick = 0; tick < 900; tick += 50)
      EXPECT_EQ(hand->at(0.001 * tick).position_W, same->at(0.001 * tick).position_W) << name;
  }
}

// --- the section of an experiment ---

// The recorded frames have the faults already. Faults that are requested for the replay are added to them,
// and the session still ends.
TEST(SensorFaultFrames, AReplayedLiveSessionHasNoFaults) {
  const TestFolder folder("sensor_faults_test");
  const std::string file = (folder / "session.h5").string();
  const SensorView view{{64, 2, 60, 60, 31.5, 0.5}, 0.001, 30, false, RigidTransform::Identity()};
  SessionWriter session(
      file, view, RigidTransform::Identity(),
      {{"config", Experiment::load("fig4.16", {"faults.dropout_probability=0.5"}).to_json()}});
  SensorFrame frame;
  frame.depth.assign(128, 500);
  session.append(frame, 0, 0);
  SessionTick tick;
  tick.taken = 0;
  session.append(tick);
  session.finish();

  const Experiment again = Experiment::load(file);
  EXPECT_FALSE(Json::parse(again.to_json()).contains("faults"));
  EXPECT_EQ(measured(again.build_scenario(scenes::kernels())->cloud(0)), 128u);
  const auto worse =
      Experiment::load(file, {"faults.dropout_probability=1"}).build_scenario(scenes::kernels());
  EXPECT_EQ(measured(worse->cloud(0)), 0u);
  EXPECT_EQ(worse->frame_count(), 1);
  EXPECT_TRUE(worse->ends());
  EXPECT_EQ(worse->delivery(0).leaves_sensor_s, 0);
}

TEST(SensorFaultFrames, AViewOfNoLengthIsRefused) {
  SensorFaults blind;
  blind.view_direction.setZero();
  EXPECT_THROW(faulty(blind), std::invalid_argument);
}

}  // namespace
}  // namespace remote_touch::sensor_fault_frames_test
