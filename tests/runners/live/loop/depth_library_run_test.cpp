// Whole live runs with the adapters of depth cameras' libraries, with test doubles of the libraries, on a
// simulated clock.
#include <gtest/gtest.h>

#include "tests/doubles/depth_libraries.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"

namespace remote_touch::depth_library_run_test {
namespace {

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
}  // namespace remote_touch::depth_library_run_test
