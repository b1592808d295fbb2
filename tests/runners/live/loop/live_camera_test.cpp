// What a live run does when its camera stops or is unplugged: OpenNI 2's own run-time library with a virtual
// camera as its driver, and a test double of Force Dimension's library for the device.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "runners/live/sensors/openni2_camera.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/runners/live/loop/background_run.h"
#include "tests/support/start_with_libraries.h"
#include "tests/support/test_files.h"
#include "tests/support/timed_tests.h"

namespace remote_touch::live_camera_test {
namespace {

constexpr double kWall_m = 0.5;

class LiveCamera : public testing::Test {
 protected:
  void SetUp() override {
    const Availability availability = openni2_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
  }
  void TearDown() override { unsetenv("VIRTUAL_CAMERA"); }

  // Pressed into the wall ahead of the camera, which then does what it is told.
  void press(const char* camera) {
    setenv("VIRTUAL_CAMERA", camera, 1);
    press_in_again();
  }
  void press_in_again() {
    const auto start = [&] {
      // OpenNI 2 cannot be waited for in a second thread of the same process.
      if (run_) throw std::runtime_error(run_->ended().ended);
      return std::make_unique<BackgroundRun>(kPress, "fd:0", "oni:any");
    };
    ASSERT_TRUE(press_in(
        run_, start, {[&] { hold(-0.03); }, [&] { hold(0.002); }, [&] { return double_->now().force(); }}))
        << "never touched";
  }
  void hold(double into_the_wall_m) {
    const Vec3 place = kForceDimension.axes * Vec3(0, 0, kWall_m + into_the_wall_m);
    double_->set([&](DeviceDouble::State& state) { Vec3::Map(state.position.data()) = place; });
  }

  // The force of a new touch lasts and grows with the depth; where the machine pauses it does not.
  bool can_be_touched() {
    press_in_again();
    std::this_thread::sleep_for(std::chrono::milliseconds(60));  // the force is whole then
    const double before_N = double_->now().force();
    if (before_N == 0) return false;
    for (const double until_s = steady_s() + 0.5; steady_s() < until_s; nap())
      if (std::abs(double_->now().force() - before_N) > 0.3 * before_N) return false;
    hold(0.1);
    return wait_until([&] { return double_->now().force() > 1.5 * before_N; }, 0.1);
  }
  // The last cloud stays, the force has its limits, and free space stays free.
  void expect_the_last_cloud_to_hold() {
    EXPECT_TRUE(wait_until([&] { return can_be_touched(); }));
    for (const DeviceDouble::Event& event : double_->events())
      ASSERT_LE(event.force(), SafetyLimits{}.max_force_N * (1 + 1e-9));
    hold(-0.03);
    EXPECT_TRUE(wait_until([&] { return double_->now().force() == 0; }));
  }

  DoubleInstalled double_{kForceDimension};
  std::unique_ptr<BackgroundRun> run_;
};

TEST_F(LiveCamera, ThatSendsNothingMoreLeavesItsLastCloud) {
  press("flat=500,stop_after=45");
  ASSERT_TRUE(wait_until([&] { return run_->told().find("no frame for 0.2 s") != std::string::npos; }))
      << run_->told();
  EXPECT_HAS(run_->told(), "no frame for 0.2 s: the last cloud stays");
  expect_the_last_cloud_to_hold();
  const LiveResult& result = run_->ended_by_stop();
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_GT(result.log.stale_ticks, 300);
}

TEST_F(LiveCamera, ThatIsUnpluggedLeavesItsLastCloudAndAFailure) {
  press("flat=500,lose_after=45");
  ASSERT_TRUE(wait_until([&] { return run_->told().find("no more frames") != std::string::npos; }));
  EXPECT_HAS(run_->told(), "no more frames (openni2: was disconnected): the last cloud stays");
  expect_the_last_cloud_to_hold();
  EXPECT_TRUE(run_->ended_by_stop().failed);
}

}  // namespace
}  // namespace remote_touch::live_camera_test

int main(int argc, char** argv) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  remote_touch::start_with_libraries(REMOTE_TOUCH_VIRTUAL_OPENNI2, argv);
#endif
  return remote_touch::run_timed_tests(argc, argv);
}
