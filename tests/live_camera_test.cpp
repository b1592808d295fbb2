// What a live run does when its camera stops or is unplugged: OpenNI 2's own run-time library with a virtual
// camera as its driver, and a test double of Force Dimension's library for the device.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "runners/sensors/openni2_camera.h"
#include "tests/background_run.h"
#include "tests/start_with_libraries.h"
#include "tests/test_files.h"
#include "tests/vendor_devices.h"

namespace remote_touch {
namespace {

constexpr double kWall_m = 0.5;

class LiveCamera : public testing::Test {
 protected:
  void SetUp() override {
    const Availability availability = openni2_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
  }
  void TearDown() override { unsetenv("VIRTUAL_CAMERA"); }

  // Pressed into the wall ahead of the camera, which then does what the word says.
  void press(const char* word) {
    setenv("VIRTUAL_CAMERA", (std::string("flat=500,") + word).c_str(), 1);
    hold(-0.03);
    run_ = std::make_unique<BackgroundRun>(kPress, "fd:0", "oni:any");
    ASSERT_TRUE(wait_until([&] { return double_->events().size() > 300; }));
    hold(0.002);
    ASSERT_TRUE(wait_until([&] { return double_->now().force() > 0.4; })) << "never touched";
  }
  void hold(double into_the_wall_m) {
    const Vec3 place = kForceDimension.axes * Vec3(0, 0, kWall_m + into_the_wall_m);
    double_->set([&](DeviceDouble::State& state) { Vec3::Map(state.position.data()) = place; });
  }

  // The last cloud stays: there is a force for half a second, and it has its limits.
  void expect_the_last_cloud_to_hold() {
    const double before_N = double_->now().force();
    for (const double until_s = steady_s() + 0.5; steady_s() < until_s; nap()) {
      ASSERT_NEAR(double_->now().force(), before_N, 0.3 * before_N);
    }
    hold(0.1);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_GT(double_->now().force(), before_N);
    for (const DeviceDouble::Event& event : double_->events())
      ASSERT_LE(event.force(), SafetyLimits{}.largest_force_N * (1 + 1e-9));
    hold(-0.03);
    EXPECT_TRUE(wait_until([&] { return double_->now().force() == 0; })) << "free space stays free";
  }

  DoubleInstalled double_{kForceDimension};
  std::unique_ptr<BackgroundRun> run_;
};

TEST_F(LiveCamera, ThatSendsNothingMoreLeavesItsLastCloud) {
  press("stop_after=45");
  ASSERT_TRUE(wait_until([&] { return run_->told().find("no frame for 0.2 s") != std::string::npos; }))
      << run_->told();
  EXPECT_HAS(run_->told(), "no frame for 0.2 s: the last cloud stays");
  expect_the_last_cloud_to_hold();
  const LiveResult& result = run_->ended_by_stop();
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_GT(result.log.stale_ticks, 300);
}

TEST_F(LiveCamera, ThatIsUnpluggedLeavesItsLastCloudAndAFailure) {
  press("lose_after=45");
  ASSERT_TRUE(wait_until([&] { return run_->told().find("no more frames") != std::string::npos; }));
  EXPECT_HAS(run_->told(), "no more frames (openni2: was disconnected): the last cloud stays");
  expect_the_last_cloud_to_hold();
  EXPECT_TRUE(run_->ended_by_stop().failed);
}

}  // namespace
}  // namespace remote_touch

int main(int argc, char** argv) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  remote_touch::start_with_libraries(REMOTE_TOUCH_VIRTUAL_OPENNI2, argv);
#endif
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
