// A live run whose depth pipeline runs on an OpenCL device that fails or hangs, with a test double of the
// library. The test is a program of its own, because a process loads a library only once.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/doubles/loaded_opencl_double.h"
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

constexpr double kFails_s = 0.5;
constexpr const char* kTakeover = "; the CPU processes this frame and all later ones";

class DepthDeviceLoss : public testing::Test {
 protected:
  void SetUp() override {
    setenv("REMOTE_TOUCH_LIBOPENCL", REMOTE_TOUCH_DOUBLE_OPENCL, 1);
    library().reset();
  }
  // One second on a simulated clock; fail() happens in the middle.
  LiveResult run(
      const std::string& device, const std::function<void()>& fail = [] {}) {
    SimulatedClock clock;
    SimulatedRun run(clock, at_the_valves(device));
    run.options.duration_s = 1;
    run.record(folder_ / (device + ".h5"));
    run.options.on_frame = [&](const Frame& frame) {
      frames_.push_back({clock.now_ns(), frame.index, kernel_runs()});
    };
    clock.at(kFails_s, fail);
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  static int kernel_runs() { return library().kernel_runs; }
  static void fail_in(const char* function, int call = 1) {
    library().calls = 0, library().failing_call = call, library().failing = function;
  }

  struct SeenFrame {
    std::int64_t at_ns;
    int index, kernel_runs;
  };
  const TestFolder folder_{"depth_device_loss"};
  std::vector<SimulatedRun::ReportedLine> reported_;
  std::vector<SeenFrame> frames_;
};

// The frame in which the call fails is processed by the CPU, no frame is missing, and the hand feels no
// difference.
TEST_F(DepthDeviceLoss, TheCpuTakesOverWithinTheFrameWhicheverCallFails) {
  const LiveResult on_cpu = run("cpu");
  EXPECT_TRUE(reported_.empty());
  const std::size_t frames = frames_.size();
  const std::string expected = digest(on_cpu.log.trace.columns());
  for (const char* function : kFrameFunctions) {
    SCOPED_TRACE(function);
    library().reset(), frames_.clear();
    const LiveResult result = run("opencl", [&] { fail_in(function); });
    EXPECT_GT(library().calls, 0) << "was not called";
    EXPECT_EQ(digest(result.log.trace.columns()), expected);
    EXPECT_EQ(result.log.missed_ticks, 0);
    EXPECT_FALSE(result.failed) << result.ended;
    ASSERT_EQ(frames_.size(), frames);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0].line, "depth_pipeline.device = opencl:0:0 (double, double) failed: " +
                                     std::string(function) + ": CL_OUT_OF_RESOURCES (-5)" + kTakeover);
    // The first frame after the failure is that of 0.5 s, and the next check for messages is 10 ms later at
    // most.
    EXPECT_GE(reported_[0].at_ns, ms(500));
    EXPECT_LE(reported_[0].at_ns, ms(550));
    // The device did all the work before: from the sensor's numbers to the columns of fixtures.
    EXPECT_EQ(frames_[1].kernel_runs, frames_[0].kernel_runs + 6);
    EXPECT_EQ(frames_[frames - 1].kernel_runs, frames_[frames - 2].kernel_runs);
  }
}

TEST_F(DepthDeviceLoss, TheSessionNamesTheDeviceAndIsReplayedOnIt) {
  const LiveResult live = run("opencl");
  EXPECT_TRUE(reported_.empty());
  // Frames from the disk come as clouds. They go another way through the device, and have the same bits.
  SimulationOptions offline;
  offline.kernels = &scenes::kernels(), offline.hash_frames = true;
  const int before = kernel_runs();
  const Trace again = simulate(Experiment::load((folder_ / "opencl.h5").string()), offline);
  EXPECT_GT(kernel_runs(), before);
  EXPECT_EQ(digest(again.columns()), digest(live.log.trace.columns()));
  EXPECT_EQ(attribute(Hdf5Reader(folder_ / "opencl.h5").attributes(), "depth_device"),
            "opencl:0:0 (double, double)");
  run("cpu");
  EXPECT_EQ(attribute(Hdf5Reader(folder_ / "cpu.h5").attributes(), "depth_device"), "");
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
