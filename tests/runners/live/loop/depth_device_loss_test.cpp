// A live run whose depth pipeline runs on an OpenCL device that fails or hangs, with a test double of the
// library. The test is a program of its own, because a process loads a library only once.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "tests/doubles/opencl_double.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::depth_device_loss_test {
namespace {

// A hand in front of the valves, which are forbidden by their colours. The hash of each frame, its points,
// radii and stiffness, is in the trace.
Experiment at_the_valves(const std::string& device) {
  return Experiment::from_json(R"({
  "scenario": {"name": "valve-tank", "width": 80, "height": 60, "focal_px": 66},
  "depth_pipeline": {"filter_window": 3, "normal_window": 5},
  "fixtures": [{"name": "hue-range", "from_deg": 340, "to_deg": 20, "radius_m": 0.04},
               {"name": "hue-range", "from_deg": 35, "to_deg": 80, "radius_m": 0.03, "stiffness_N_per_m": 200}],
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "poses", "poses": [[0, 0.02, 0.33, 0, 0, 0, 0], [-0.105, 0.006, 0.2, 0, 0, 0, 1]]}})",
                               "test", {"depth_pipeline.device=" + device});
}

constexpr const char* kTakeover = "; the CPU processes this frame and all later ones";

class DepthDeviceLoss : public testing::Test {
 protected:
  void SetUp() override {
    setenv("REMOTE_TOUCH_LIBOPENCL", REMOTE_TOUCH_DOUBLE_OPENCL, 1);
    library().reset();
  }
  // Runs for a second on a simulated clock.
  void run(RecordedRun& recorded) {
    recorded.run.options.on_frame = [this](const Frame&) { kernel_runs_.push_back(library().kernel_runs); };
    recorded.go();
  }
  static std::string stored_device(const RecordedRun& recorded) {
    return attribute(Hdf5Reader(recorded.run.options.record).attributes(), "depth_device");
  }
  static void fail_in(const char* function) {
    library().calls = 0, library().failing_call = 1, library().failing = function;
  }

  std::vector<int> kernel_runs_;  // number of kernel runs until each frame was processed
};

// The frame in which a call fails is processed by the CPU, no frame is missing, and the hand feels no
// difference. opencl_double_test.cpp has each function that can fail.
TEST_F(DepthDeviceLoss, TheCpuTakesOverWithinTheFrame) {
  RecordedRun on_cpu(at_the_valves("cpu"), 1), on_device(at_the_valves("opencl"), 1);
  run(on_cpu);
  EXPECT_TRUE(on_cpu.lines().empty());
  EXPECT_EQ(stored_device(on_cpu), "");
  const std::size_t frames = kernel_runs_.size();
  kernel_runs_.clear();
  on_device.clock.at(0.5, [] { fail_in("clFinish"); });
  run(on_device);
  EXPECT_GT(library().calls, 0) << "was not called";
  const LiveResult& result = on_device.result;
  EXPECT_EQ(digest(result.log.trace.columns()), digest(on_cpu.result.log.trace.columns()));
  EXPECT_EQ(result.log.missed_ticks, 0);
  EXPECT_FALSE(result.failed) << result.ended;
  ASSERT_EQ(on_device.run.reported().size(), 1u);
  const auto& [at_ns, line] = on_device.run.reported()[0];
  EXPECT_EQ(line, std::string("depth_pipeline.device = opencl:0:0 (double, double) failed: clFinish: "
                              "CL_OUT_OF_RESOURCES (-5)") +
                      kTakeover);
  // The first frame after the failure is that of 0.5 s, and the next check for messages is 10 ms later at
  // most.
  EXPECT_GE(at_ns, ms(500));
  EXPECT_LE(at_ns, ms(550));
  // The device did all the work before: from the sensor's numbers to the columns of fixtures.
  ASSERT_EQ(kernel_runs_.size(), frames);
  EXPECT_EQ(kernel_runs_[1], kernel_runs_[0] + 6);
  EXPECT_EQ(kernel_runs_[frames - 1], kernel_runs_[frames - 2]);
}

// Frames from the disk come as clouds. They go another way through the device, and have the same bits.
TEST_F(DepthDeviceLoss, TheSessionNamesTheDeviceAndIsReplayedOnIt) {
  RecordedRun live(at_the_valves("opencl"), 1);
  run(live);
  EXPECT_TRUE(live.lines().empty());
  EXPECT_EQ(stored_device(live), "opencl:0:0 (double, double)");
  const int before = library().kernel_runs;
  EXPECT_EQ(digest(live.again().columns()), digest(live.result.log.trace.columns()));
  EXPECT_GT(library().kernel_runs, before);
}

// The run is in real time, with the threads of a live run. The camera's thread waits 2 s for the driver, but
// the haptic loop does not wait. The driver hangs in the eleventh frame, and the CPU continues with the
// twelfth.
TEST_F(DepthDeviceLoss, NoTickWaitsForADriverThatHangs) {
  const Experiment experiment = at_the_valves("opencl");
  std::vector<std::string> reported;
  std::vector<double> captured_s;
  std::atomic<bool> stop = false;
  LiveOptions options;
  options.kernels = &scenes::kernels();
  options.stop = &stop;
  options.report_line = [&](const std::string& line) { reported.push_back(line); };
  options.on_frame = [&](const Frame& frame) {
    captured_s.push_back(frame.captured_s);
    if (captured_s.size() == 10) library().hangs = true, fail_in("clFinish");
    if (captured_s.size() == 12) stop = true;
  };
  const LiveResult result = run_live(experiment, options);
  EXPECT_FALSE(result.failed) << result.ended;
  ASSERT_GE(captured_s.size(), 12u);
  EXPECT_GT(result.counts.camera.max_pause_s, 1.9);  // the time for which the hand had no frames
  const auto takeovers = std::count_if(reported.begin(), reported.end(), [](const std::string& line) {
    return line.find(kTakeover) != std::string::npos;
  });
  EXPECT_EQ(takeovers, 1);
  // There is time for 1700 ticks. A busy machine leaves many of them out. A loop that waits for the driver
  // would leave out all.
  const auto ticks = std::count_if(
      result.log.trace.time_s.begin(), result.log.trace.time_s.end(),
      [&](double time_s) { return time_s > captured_s[10] + 0.1 && time_s < captured_s[11] - 0.1; });
  EXPECT_GT(ticks, 20);
  library().is_released = true;
  EXPECT_TRUE(wait_until([] { return library().objects == 0; }));
}

}  // namespace
}  // namespace remote_touch::depth_device_loss_test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
