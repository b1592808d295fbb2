// The end of a live run by an input that cannot be used: a frame of the sensor, or a file that has changed.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/sessions/session_file.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_refusal_test {
namespace {

constexpr int kMoved = 6;  // captured at 200 ms

// The camera of an experiment moves by 200 mm along its axis with frame kMoved. The points are right in the
// world.
class MovingCamera final : public Scenario {
 public:
  explicit MovingCamera(std::unique_ptr<const Scenario> scene) : scene_(std::move(scene)) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 100; }
  PointCloud cloud(int frame) const override {
    PointCloud cloud = scene_->cloud(0);
    if (frame < kMoved) return cloud;
    const RigidTransform X_WC = cloud.image->X_WC, moved = X_WC * Eigen::Translation3d(0, 0, 0.2);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p_W = moved * (X_WC.inverse() * cloud.point(i));
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
    }
    cloud.image->X_WC = moved;
    return cloud;
  }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scene_->signed_distance(p_W, time_s);
  }

 private:
  const std::unique_ptr<const Scenario> scene_;
};

class RefusedRun : public testing::Test {
 protected:
  LiveResult run(bool moves) {
    SimulatedRun run(clock_, press_experiment(), SimulatedRun::simulated_device,
                     [=](const Experiment& experiment, Clock& clock) -> std::unique_ptr<DepthSource> {
                       if (!moves) return SimulatedRun::scenario_camera(experiment, clock);
                       return std::make_unique<ScenarioCamera>(
                           std::make_unique<MovingCamera>(experiment.build_scenario(scenes::kernels())),
                           clock, FrameEncoder::Settings{.name = "./scene"});
                     });
    run.options.duration_s = 1;
    run.record(session());
    run.options.check_inputs = check_inputs_;
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  std::filesystem::path session() const { return folder_ / "session.h5"; }

  const TestFolder folder_{"live_refusal"};
  SimulatedClock clock_;
  std::function<void()> check_inputs_;
  std::vector<SimulatedRun::ReportedLine> reported_;
};

// The user's part checks every 10 ms.
TEST_F(RefusedRun, AFrameFromAnotherPlaceEndsTheRun) {
  const LiveResult result = run(true);
  EXPECT_HAS(result.refused, "./scene: frame 6 was captured from another pose (0.2 m and 0 deg");
  EXPECT_EQ(result.ended, result.refused);
  EXPECT_LE(clock_.now_ns(), 211'000'000);
  EXPECT_TRUE(reported_.empty()) << reported_[0].line;
  EXPECT_EQ(result.counts.camera.received, kMoved);
  const SessionReader recorded(session());
  EXPECT_EQ(recorded.frame_count(), static_cast<std::size_t>(kMoved)) << "the hand is kept until then";
  EXPECT_EQ(recorded.ended(), result.refused);
}

TEST_F(RefusedRun, AFileThatHasChangedIsAnInputError) {
  check_inputs_ = [] { throw InputError("./scene", "changed while it was read"); };
  const LiveResult result = run(false);
  EXPECT_EQ(result.refused, "./scene: changed while it was read");
  EXPECT_EQ(result.ended, "its duration has elapsed; ./scene: changed while it was read");
  EXPECT_EQ(SessionReader(session()).ended(), result.ended);
}

TEST_F(RefusedRun, OtherFailuresAreNoRefusal) {
  int checks = 0;
  check_inputs_ = [&] { ++checks; };
  const LiveResult result = run(false);
  EXPECT_EQ(checks, 1);
  EXPECT_EQ(result.refused, "");
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_EQ(SessionReader(session()).ended(), "its duration has elapsed");
}

}  // namespace
}  // namespace remote_touch::live_refusal_test
