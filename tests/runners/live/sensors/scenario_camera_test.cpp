// A scenario as a sensor in real time.
#include "runners/live/sensors/scenario_camera.h"

#include <gtest/gtest.h>

#include "runners/experiment/experiment.h"
#include "runners/live/timing/steady_clock.h"
#include "tests/support/scenes.h"

namespace remote_touch::scenario_camera_test {
namespace {

// Recorded by a host that was slow to start and got fewer frames than the sensor's rate.
class SlowRecording final : public Scenario {
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

TEST(ScenarioCamera, FramesComeAtTheTimesAtWhichTheyWereCaptured) {
  ScenarioCamera camera(std::make_unique<SlowRecording>());
  SensorFrame frame;
  std::vector<SensorFrame> frames;
  const double start_s = steady_s();
  while (steady_s() - start_s < 1)
    if (camera.next(frame, 0.02) == SensorState::frame) frames.push_back(frame);
  // All eight, and then the last again and again at 30 Hz; a busy machine may lose some.
  ASSERT_GE(frames.size(), 10u);
  EXPECT_LE(frames.size(), 8u + 30);
  EXPECT_NEAR(frames[0].captured_s - start_s,
              SlowRecording::kFirst_s + SlowRecording::kPeriod_s * frames[0].number, 0.01);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].number, frames[i - 1].number);
    if (frames[i].number < 8) {
      EXPECT_NEAR(frames[i].captured_s - frames[i - 1].captured_s,
                  SlowRecording::kPeriod_s * (frames[i].number - frames[i - 1].number), 1e-9);
    }
  }
}

}  // namespace
}  // namespace remote_touch::scenario_camera_test
