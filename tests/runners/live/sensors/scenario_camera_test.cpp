// A scenario as a sensor in real time, on a simulated clock.
#include "runners/live/sensors/scenario_camera.h"

#include <gtest/gtest.h>

#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/sensors/replaceable_scenario.h"
#include "scenarios/camera/sensor_faults.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"

namespace remote_touch::scenario_camera_test {
namespace {

// A recording of a host that was slow to start and got fewer frames than the sensor's rate.
class SlowRecording : public Scenario {
 public:
  static constexpr double kFirst_s = 0.12, kPeriod_s = 0.05;

  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 8; }
  double captured_s(int frame) const override { return kFirst_s + kPeriod_s * frame; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override { return scene_->points(frame); }
  PointCloud cloud(int frame) const override { return scene_->cloud(frame); }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scene_->signed_distance(p_W, time_s);
  }

 private:
  const std::unique_ptr<Scenario> scene_ =
      Experiment::from_json(R"({"scenario": {"name": "camera-scene", "width": 16, "height": 12},
                                "renderer": {"name": "proxy"}, "trajectory": {"name": "follow-surface"}})",
                            "test")
          .build_scenario(scenes::kernels());
};

// The camera repeats its last frame at 30 Hz.
TEST(ScenarioCamera, FramesComeAtTheTimesAtWhichTheyWereCaptured) {
  SimulatedClock clock;
  clock.sleep_s(5);
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  SensorFrame frame;
  for (int number = 0; number < 20; ++number) {
    while (camera.next(frame, 0.02) == SensorState::waiting) continue;
    const double after_s = SlowRecording::kFirst_s + SlowRecording::kPeriod_s * std::min(number, 7) +
                           std::max(0, number - 7) / 30.0;
    EXPECT_EQ(frame.number, number);
    EXPECT_NEAR(frame.captured_s, 5 + after_s, 1e-9);
    EXPECT_NEAR(clock.now_s(), 5 + after_s, 1e-9);
  }
}

// What was set up between the start of the run and the first frame moves no frame in time.
TEST(ScenarioCamera, CountsFromTheStartOfTheRun) {
  SimulatedClock clock;
  clock.sleep_s(5);
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  camera.start_at(clock.now_ns());
  clock.sleep_s(SlowRecording::kFirst_s + 1.5 * SlowRecording::kPeriod_s);
  SensorFrame frame;
  ASSERT_EQ(camera.next(frame, 1), SensorState::frame);
  EXPECT_EQ(frame.number, 1);
  EXPECT_NEAR(frame.captured_s, 5 + SlowRecording::kFirst_s + SlowRecording::kPeriod_s, 1e-9);
}

class PosedRecording final : public SlowRecording {
 public:
  std::optional<RigidTransform> sensor_pose() const override {
    return RigidTransform(Eigen::Translation3d(0, 0, 2));
  }
};

// A sensor with faults still reports its pose.
TEST(ReplaceableScenario, ReportsThePoseOfASensorWithFaults) {
  const auto sensor = std::make_shared<const FaultySensor>(std::make_unique<PosedRecording>(), SensorFaults{},
                                                           NoiseKey{1}, scenes::kernels());
  const ReplaceableScenario scenario(std::make_shared<const ShownScenario>(sensor));
  ASSERT_TRUE(scenario.sensor_pose());
  EXPECT_EQ(scenario.sensor_pose()->translation(), Vec3(0, 0, 2));
}

// Depths are rounded to 0.1 mm, and lie on the ray of their pixel. The points of clouds are rounded to
// floats.
TEST(ScenarioCamera, ShowsEveryScenarioOfTheCatalog) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto factory = entry.make();
    if (!factory->inputs().empty()) continue;  // it reads files and is tested with those
    const auto scenario = factory->build(NoiseKey{7}, scenes::kernels());
    const PointCloud truth = scenario->cloud(0);
    SimulatedClock clock;
    ScenarioCamera camera(factory->build(NoiseKey{7}, scenes::kernels()), clock);
    EXPECT_EQ(camera.view().cloud.has_value(), !truth.image) << entry.name;
    SensorFrame frame;
    ASSERT_EQ(camera.next(frame, 1), SensorState::frame) << entry.name;
    ASSERT_TRUE(is_complete(frame, camera.view())) << entry.name;
    const PointCloud seen = cloud_of(frame, camera.view(), camera.view().X_WC);
    ASSERT_EQ(seen.size(), truth.size()) << entry.name;
    EXPECT_EQ(seen.columns(), truth.columns()) << entry.name;
    EXPECT_EQ(seen.has_normals(), truth.has_normals() && !truth.image) << entry.name;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_EQ(seen.is_measured(i), truth.is_measured(i)) << entry.name << ", point " << i;
      if (!truth.is_measured(i)) continue;
      ASSERT_LT((seen.point(i) - truth.point(i)).norm(), truth.image ? 2e-4 : 1e-6) << entry.name;
      if (truth.image || !truth.has_normals() || !truth.normal(i).allFinite()) continue;
      ASSERT_LT((seen.normal(i) - truth.normal(i)).norm(), 1e-6) << entry.name;
      ASSERT_NEAR(seen.normal(i).norm(), 1, 1e-12) << entry.name;
    }
  }
}

TEST(ScenarioCamera, WaitsNoLongerThanTheGivenTime) {
  SimulatedClock clock;
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  SensorFrame frame;
  EXPECT_EQ(camera.next(frame, 0), SensorState::waiting);
  EXPECT_EQ(clock.now_ns(), 0);
  EXPECT_EQ(camera.next(frame, 0.1), SensorState::waiting);
  EXPECT_EQ(clock.now_ns(), 100'000'000);
  EXPECT_EQ(camera.next(frame, 0.1), SensorState::frame);
  EXPECT_EQ(clock.now_ns(), 120'000'000);
}

TEST(ScenarioCamera, ALateReaderGetsTheNewestFrame) {
  SimulatedClock clock;
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  SensorFrame frame;
  EXPECT_EQ(camera.next(frame, 0), SensorState::waiting);
  clock.sleep_s(SlowRecording::kFirst_s + 3.5 * SlowRecording::kPeriod_s);
  ASSERT_EQ(camera.next(frame, 0), SensorState::frame);
  EXPECT_EQ(frame.number, 3);
  EXPECT_EQ(camera.next(frame, 0), SensorState::waiting);
}

}  // namespace
}  // namespace remote_touch::scenario_camera_test
