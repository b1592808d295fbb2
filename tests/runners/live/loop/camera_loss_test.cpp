// A live run whose camera stops or is unplugged, on a simulated clock.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"

namespace remote_touch::camera_loss_test {
namespace {

// The experiment's camera until so many frames were sent. Then it returns the given state.
class CameraThatStops final : public DepthSource {
 public:
  CameraThatStops(std::unique_ptr<DepthSource> camera, int frames, SensorState then)
      : camera_(std::move(camera)), left_(frames), then_(then) {
    view_ = camera_->view();
    failure_ = "it was pulled out";
  }
  SensorState next(SensorFrame& frame, double timeout_s) override {
    if (left_ == 0) return then_;
    const SensorState state = camera_->next(frame, timeout_s);
    left_ -= state == SensorState::frame ? 1 : 0;
    return state;
  }

 private:
  const std::unique_ptr<DepthSource> camera_;
  int left_;
  const SensorState then_;
};

class CameraLoss : public testing::Test {
 protected:
  // Thirty frames, the last of them at 967 ms. The hand is lifted at 1.6 s and presses to another depth at
  // 1.7 s.
  LiveResult run_with_loss(SensorState then, int frames = 30) {
    hold(kAbove_m);
    clock_.at(kPressed_s, [&] { hold(kBelow_m); });
    clock_.at(1.6, [&] { hold(kAbove_m); });
    clock_.at(1.7, [&] { hold(2 * kBelow_m); });
    SimulatedRun run(
        clock_, press_experiment(),
        [](const Experiment&, Clock& clock) { return kForceDimension.open("", clock); },
        [=](const Experiment& experiment, Clock& clock) {
          return std::make_unique<CameraThatStops>(SimulatedRun::scenario_camera(experiment, clock), frames,
                                                   then);
        });
    run.options.duration_s = 2;
    run.options.on_trouble = [this](const LiveTrouble& trouble) { troubles_.push_back(trouble); };
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  void hold(double above_m) { put(*double_, kForceDimension, {0, height_m_ + above_m, 0}); }
  // Checks that the last cloud stays: the force is as before, there is none in free space, and another one at
  // another depth.
  void expect_the_last_cloud_to_hold() const {
    const ForceOverTime force = force_of(*double_);
    const double pressed_N = force.at(ms(900));
    EXPECT_GT(pressed_N, 1);
    EXPECT_NEAR(force.at(ms(1500)), pressed_N, 0.02 * pressed_N);
    EXPECT_EQ(force.at(ms(1690)), 0);
    EXPECT_NEAR(force.at(ms(1900)), pressed_N - 600 * kBelow_m, 0.02 * pressed_N) << "600 N/m and 2 mm";
  }

  SimulatedClock clock_;
  DoubleInstalled double_{kForceDimension, &clock_};
  const double height_m_ = table_height_m();
  std::vector<SimulatedRun::ReportedLine> reported_;
  std::vector<LiveTrouble> troubles_;
};

// The frame of 29 / 30 s arrives at 967 ms. It is older than 0.2 s from 1167 ms on, and the next check is at
// 1170 ms.
TEST_F(CameraLoss, ACameraThatStopsSendingLeavesItsLastCloud) {
  const LiveResult result = run_with_loss(SensorState::waiting);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no frame for 0.2 s: the last cloud is still rendered");
  EXPECT_EQ(reported_[0].at_ns, ms(1170));
  expect_the_last_cloud_to_hold();
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_EQ(result.counts.camera.received, 30);
  EXPECT_EQ(result.log.stale_ticks, 2000 - 1168);
  ASSERT_EQ(troubles_.size(), 1u) << "a page gets what the terminal gets";
  EXPECT_EQ(troubles_[0].camera, reported_[0].line);
  EXPECT_EQ(troubles_[0].force, "");
}

// There is no last cloud that could stay.
TEST_F(CameraLoss, ACameraThatNeverSendsLeavesNothingToTouch) {
  run_with_loss(SensorState::waiting, 0);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no frame has arrived yet: there is nothing to touch");
}

TEST_F(CameraLoss, AFailureBeforeTheFirstFrameLeavesNothingToTouch) {
  run_with_loss(SensorState::failed, 0);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no more frames (it was pulled out): there is nothing to touch");
}

TEST_F(CameraLoss, AnUnpluggedCameraLeavesItsLastCloudAndAFailure) {
  const LiveResult result = run_with_loss(SensorState::failed);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no more frames (it was pulled out): the last cloud is still rendered");
  EXPECT_EQ(reported_[0].at_ns, ms(970));
  expect_the_last_cloud_to_hold();
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.ended, "its duration has elapsed");
}

TEST_F(CameraLoss, TheEndOfARecordingIsNoFailure) {
  const LiveResult result = run_with_loss(SensorState::ended);
  EXPECT_FALSE(result.failed);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, "no more frames (the recording has ended): the last cloud is still rendered");
  expect_the_last_cloud_to_hold();
}

}  // namespace
}  // namespace remote_touch::camera_loss_test
