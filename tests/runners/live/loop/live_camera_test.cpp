// What a live run says when its camera stops or is unplugged: OpenNI 2's own run-time library with a virtual
// camera as its driver, in real time. What the hand feels meanwhile is in camera_loss_test.cpp.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <vector>

#include "runners/live/loop/live_run.h"
#include "runners/live/sensors/openni2_camera.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/start_with_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_camera_test {
namespace {

class LiveCamera : public testing::Test {
 protected:
  void SetUp() override {
    const Availability availability = openni2_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
  }
  void TearDown() override { unsetenv("VIRTUAL_CAMERA"); }

  // For so long, or until it says that.
  LiveResult run(const char* camera, double duration_s, const std::string& until = "never") {
    setenv("VIRTUAL_CAMERA", camera, 1);
    std::atomic<bool> stop = false;
    LiveOptions options;
    options.kernels = &scenes::kernels();
    options.depth = "oni:any";
    options.duration_s = duration_s;
    options.stop = &stop;
    options.report_line = [&](const std::string& line) {
      told_.push_back(line);
      stop = line.find(until) != std::string::npos;
    };
    return run_live(press_experiment(), options);
  }

  std::vector<std::string> told_;
};

TEST_F(LiveCamera, ThatSendsNothingMore) {
  const LiveResult result = run("flat=500,stop_after=10", 5);
  ASSERT_FALSE(told_.empty());
  EXPECT_EQ(told_.back(), "no frame for 0.2 s: the last cloud stays");
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_EQ(result.ended, "its duration is over");
  EXPECT_GT(result.counts.camera.received, 0);
  EXPECT_LE(result.counts.camera.received, 10);
  EXPECT_GT(result.log.stale_ticks, 0);
}

TEST_F(LiveCamera, ThatIsUnplugged) {
  const LiveResult result = run("flat=500,lose_after=10", 60, "no more frames");
  ASSERT_FALSE(told_.empty());
  EXPECT_EQ(told_.back(), "no more frames (openni2: was disconnected): the last cloud stays");
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_TRUE(result.failed);
}

}  // namespace
}  // namespace remote_touch::live_camera_test

int main(int argc, char** argv) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  remote_touch::start_with_libraries(REMOTE_TOUCH_VIRTUAL_OPENNI2, argv);
#endif
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
