// Threads for calls of libraries, and the bits of a real OpenCL device compared with those of the CPU.
// Debian's pocl provides a device on every processor.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/libraries/depth_device.h"
#include "runners/libraries/opencl_devices.h"
#include "runners/libraries/shared_library.h"
#include "scenarios/recordings/recording.h"
#include "tests/core/dissertation/depth/depth_cases.h"
#include "tests/runners/libraries/coloured_frames.h"
#include "tests/support/recorded_data.h"

namespace remote_touch::libraries_test {
namespace {

using namespace depth_cases;

class DeviceBits : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("REMOTE_TOUCH_LIBOPENCL");
    try {
      devices_ = opencl_devices(opencl_library());
    } catch (const InputError&) {
    }
    if (devices_.empty()) GTEST_SKIP() << "no OpenCL device: scripts/install tests has pocl";
  }
  // Checks that device and CPU give the same bits for one frame, as an image and as a cloud.
  void expect_same(const Settings& settings, const scenes::DepthScene& scene, const RigidTransform& X_WC) {
    for (const OpenClDevice& device : devices_) {
      if (!device.inexact_because.empty() || !device.unfit_because.empty()) continue;
      // The limit must not end a frame on a busy machine.
      DevicePipeline on_device(
          device, settings, best(), [](const std::string& line) { FAIL() << line; }, std::chrono::hours(1));
      DepthPipeline on_cpu(settings, best());
      EXPECT_TRUE(same_bits(on_device.process(scene.depth, scene.camera, X_WC),
                            on_cpu.process(scene.depth, scene.camera, X_WC)));
      PointCloud a = cloud_from_depth(scene.depth, scene.camera, X_WC), b = a;
      on_device.process(a), on_cpu.process(b);
      EXPECT_TRUE(same_bits(a, b));
      EXPECT_EQ(coloured_frames::differs(on_device, settings, scene, X_WC), "");
      EXPECT_TRUE(on_device.uses_device());
    }
  }
  std::vector<OpenClDevice> devices_;
};

scenes::DepthScene with_holes(int width, int height) {
  scenes::DepthScene scene = noisy_waves(width, height);
  scenes::add_holes(scene.depth, 0.1, 3, kNoDepth);
  return scene;
}

// The device's compiler takes seconds for each window. opencl_double_test.cpp has the other windows.
TEST_F(DeviceBits, AreThoseOfTheCpuForOddSizesHolesAndOtherWindows) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 48}, {65, 5}, {161, 121}})
    expect_same({}, with_holes(width, height), some_pose());
  Settings without_filter, narrow, wide;
  without_filter.filter = false;
  narrow.filter_window = 5, narrow.normal_window = 11, wide.filter_window = 11, wide.normal_window = 5;
  narrow.sigma_f_m = wide.sigma_f_m = 0.006;
  for (const Settings& settings : {without_filter, narrow, wide})
    expect_same(settings, with_holes(83, 37), some_pose());
  expect_same(without_filter, with_holes(83, 37), kIdentity);
}

// The device behaves like one whose single-precision divisions and roots are not rounded correctly.
TEST_F(DeviceBits, AreThoseOfTheCpuWithDivisionsInDouble) {
  for (OpenClDevice& device : devices_) device.rounds_division = false;
  expect_same({}, with_holes(161, 121), some_pose());
}

TEST_F(DeviceBits, AreThoseOfTheCpuOnRecordedFrames) {
  for (const char* name : {"visp_organ_table", "sr305_hand_flex", "pcd_single/mosd_boxes_learn3.pcd"}) {
    const std::filesystem::path path = data_root() / "rgbd" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "recorded data are missing: " << path;
    const PointCloud cloud = read_frame(index_recording(path), 0, kInfinity);
    const CameraIntrinsics& camera = cloud.image->camera;
    expect_same({}, {camera, {camera.width, camera.height, cloud.z}, {}}, some_pose());
  }
}

// The threads begin at once, as those of a sweep do with its first runs: each lists, opens and computes.
// Until listings were made one after another, the loader found no driver in some threads, or crashed.
TEST(DeviceThreads, BeginAtOnceAndHaveTheBitsOfTheCpu) {
  unsetenv("REMOTE_TOUCH_LIBOPENCL");
  const scenes::DepthScene scene = with_holes(70, 30);
  const PointCloud expected = processed(scene, {}, some_pose());
  std::atomic<int> refused = 0, same = 0;
  std::string why;
  std::mutex mutex;
  const auto process = [&] {
    DepthDeviceSettings settings;
    settings.device = "opencl";
    try {
      const auto processor = make_depth_processor(settings, best(), nullptr);
      for (int frame = 0; frame < 5; ++frame)
        same += same_bits(processor->process(scene.depth, scene.camera, some_pose()), expected) ? 1 : 0;
    } catch (const InputError& error) {
      const std::lock_guard lock(mutex);
      ++refused, why = error.what();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back(process);
  }
  if (refused == 4) GTEST_SKIP() << why;
  EXPECT_EQ(refused, 0) << why;
  EXPECT_EQ(same, 4 * 5);
  EXPECT_NE(depth_device_of({{}, "opencl"}), "");
}

// Threads for calls of others' libraries.

std::thread::id id_of(LastingThread& thread) {
  std::thread::id id;
  thread.run([&] { id = std::this_thread::get_id(); });
  return id;
}

TEST(LastingThread, DoesAllThatItIsGivenInOneThreadOfItsOwn) {
  const auto thread = lasting_thread();
  const std::thread::id first = id_of(*thread);
  EXPECT_NE(first, std::this_thread::get_id());
  for (int i = 0; i < 100; ++i) EXPECT_EQ(id_of(*thread), first);
}

TEST(LastingThread, ThrowsWhatTheWorkThrowsAndContinues) {
  const auto thread = lasting_thread();
  EXPECT_THROW(thread->run([] { throw std::out_of_range("far"); }), std::out_of_range);
  int done = 0;
  thread->run([&] { done = 1; });
  EXPECT_EQ(done, 1);
}

// Threads that were given back are used again, and none ends.
TEST(LastingThread, FreeThreadsAreUsedAgain) {
  std::set<std::thread::id> used;
  for (int round = 0; round < 10; ++round) {
    const std::vector three = {lasting_thread(), lasting_thread(), lasting_thread()};
    std::set<std::thread::id> now;
    for (const auto& thread : three) now.insert(id_of(*thread));
    EXPECT_EQ(now.size(), 3u);
    used.merge(now);
  }
  EXPECT_EQ(used.size(), 3u);
}

}  // namespace
}  // namespace remote_touch::libraries_test
