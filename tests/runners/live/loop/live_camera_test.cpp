// The messages of a live run whose camera stops or is unplugged: OpenNI 2's own run-time library with a
// virtual camera as its driver, in real time. camera_feed_test.cpp tests the force at the hand meanwhile.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <string>

#include "runners/live/loop/live_run.h"
#include "runners/live/sensors/depth_source.h"
#include "tests/doubles/virtual_openni2/virtual_camera.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/start_with_libraries.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::live_camera_test {
namespace {

using virtual_camera::sent_frames;
using virtual_camera::unplug;

class LiveCamera : public testing::Test {
 protected:
  void SetUp() override {
    const Availability availability = openni2_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
  }
  void TearDown() override { unsetenv("VIRTUAL_CAMERA"); }

  // Runs until is_over(), which is called in every tick.
  LiveResult run(const char* camera, const std::function<bool()>& is_over) {
    setenv("VIRTUAL_CAMERA", camera, 1);
    std::atomic<bool> stop = false;
    LiveOptions options;
    options.kernels = &scenes::kernels();
    options.depth = "oni:any";
    options.duration_s = kPatience_s;
    options.stop = &stop;
    options.report_line = [&](const std::string& line) {
      const std::lock_guard lock(mutex_);
      if (line.find("frame") != std::string::npos) reported_ = line;
    };
    options.on_frame = [&](const Frame&) { has_frame_ = true; };
    options.on_tick = [&](const LiveTick&) {
      if (is_over()) stop = true;
    };
    return run_live(press_experiment(), options);
  }
  // Returns the last message about frames. A busy machine may cause more messages about the loop.
  std::string reported() {
    const std::lock_guard lock(mutex_);
    return reported_;
  }

  std::mutex mutex_;
  std::string reported_;
  std::atomic<bool> has_frame_ = false;
};

TEST_F(LiveCamera, RunContinuesIfTheCameraStopsSending) {
  const std::string expected = "no frame for 0.2 s: the last cloud is still rendered";
  int ticks_without = 0;
  const LiveResult result = run("flat=500,stop_after=10", [&] {
    if (has_frame_ && sent_frames() == 10 && reported() == expected) ++ticks_without;
    return ticks_without > 300;
  });
  EXPECT_EQ(reported(), expected);
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_GT(result.counts.camera.received, 0);
  EXPECT_LE(result.counts.camera.received, 10);
  EXPECT_GT(result.log.stale_ticks, 0);
}

TEST_F(LiveCamera, RunContinuesAndFailsIfTheCameraIsUnplugged) {
  const std::string expected = "no more frames (openni2: was disconnected): the last cloud is still rendered";
  const LiveResult result = run("flat=500", [&] {
    if (has_frame_) unplug();
    return reported() == expected;
  });
  EXPECT_EQ(reported(), expected);
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
