// A device that fails, hangs or computes other bits, with a test double of the OpenCL library. A program of
// its own: a library is loaded once for a process.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "core/parameters/parameter.h"
#include "runners/libraries/depth_device.h"
#include "runners/libraries/opencl_devices.h"
#include "tests/core/dissertation/depth/depth_cases.h"
#include "tests/doubles/opencl_double.h"
#include "tests/runners/libraries/coloured_frames.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::opencl_double_test {
namespace {

using namespace depth_cases;

class OpenClDoubleTest : public testing::Test {
 protected:
  void SetUp() override {
    setenv("REMOTE_TOUCH_LIBOPENCL", REMOTE_TOUCH_DOUBLE_OPENCL, 1);
    begin_anew();
  }
  void TearDown() override {
    begin_anew();
    EXPECT_TRUE(everything_is_released());
  }
  // A device that failed is cleaned up by a thread for which no other thread waits.
  static bool everything_is_released() {
    return wait_until([] { return library().objects == 0; });
  }
  // Restores the state of a new process: no settings, trials or kernels.
  static void begin_anew() {
    library().reset();
    for (const OpenClDevice& device : opencl_devices(opencl_library()))
      forget_trials(device), static_cast<void>(forget_kernels(device.id));
  }
  // A busy machine may stop a test for seconds, so that only the test of a limit has one.
  static constexpr std::chrono::minutes kNoLimit{10};
  std::unique_ptr<DevicePipeline> open_pipeline(std::chrono::milliseconds frame_limit = kNoLimit) {
    return std::make_unique<DevicePipeline>(
        opencl_devices(opencl_library()).at(0), Settings{}, best(),
        [this](const std::string& line) { reported_.push_back(line); }, frame_limit);
  }
  std::string refusal(const std::string& device, bool exact = true) {
    DepthDeviceSettings settings;
    settings.device = device, settings.exact = exact;
    try {
      make_depth_processor(settings, best(), nullptr);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  PointCloud processed_by(DepthProcessor& processor) {
    return processor.process(scene_.depth, scene_.camera, some_pose());
  }
  const scenes::DepthScene scene_ = noisy_waves(70, 30);
  const PointCloud expected_ = processed(scene_, {}, some_pose());
  std::vector<std::string> reported_;
};

// The double compiles the source of the device's kernels as C++.
TEST_F(OpenClDoubleTest, TheKernelsHaveTheBitsOfTheCpuForEveryWindow) {
  scenes::DepthScene scene = noisy_waves(83, 37);
  scenes::add_holes(scene.depth, 0.1, 3, kNoDepth);
  for (int window = 3; window <= 15; window += 2)
    for (const bool filter : {true, false}) {
      Settings settings{filter, window, 0.006, 18 - window, 0.014};
      DevicePipeline pipeline(opencl_devices(opencl_library()).at(0), settings, best(), nullptr, kNoLimit);
      EXPECT_TRUE(same_bits(pipeline.process(scene.depth, scene.camera, some_pose()),
                            processed(scene, settings, some_pose())));
      EXPECT_EQ(coloured_frames::differs(pipeline, settings, scene, some_pose()), "");
      EXPECT_TRUE(pipeline.uses_device());
    }
}

// Each function that a frame calls fails, from its first or from a later call of the frame on.
TEST_F(OpenClDoubleTest, TheCpuTakesOverInTheFrameInWhichACallFails) {
  std::vector<const char*> functions(std::begin(kFrameFunctions), std::end(kFrameFunctions));
  functions.insert(functions.end(), {"clCreateBuffer", "clEnqueueWriteBufferRect"});
  for (const char* function : functions)
    for (const int call : {1, 3}) {
      SCOPED_TRACE(std::string(function) + " " + std::to_string(call));
      begin_anew(), reported_.clear();
      const auto pipeline = open_pipeline();
      library().failing = function, library().failing_call = call, library().code = CL_OUT_OF_RESOURCES;
      for (int frame = 0; frame < 4; ++frame) EXPECT_TRUE(same_bits(processed_by(*pipeline), expected_));
      EXPECT_FALSE(pipeline->uses_device());
      ASSERT_EQ(reported_.size(), 1u);
      EXPECT_EQ(reported_[0], std::string(function) + ": CL_OUT_OF_RESOURCES (-5)");
    }
}

TEST_F(OpenClDoubleTest, CloudsThatCannotBeProcessedAtOnceAreUnchanged) {
  const auto pipeline = open_pipeline();
  const FixtureAssignment fixtures = coloured_frames::rules_by_hue();
  const HueSteps steps = fixtures.hue_steps(0, 0).value();
  const PointCloud measured = cloud_from_depth(scene_.depth, scene_.camera, some_pose());
  const auto expect_left = [&](PointCloud cloud) {
    const PointCloud before = cloud;
    EXPECT_FALSE(pipeline->process_all(cloud, steps));
    EXPECT_TRUE(coloured_frames::same_columns(cloud, before));
  };
  expect_left(measured);  // no colours
  PointCloud coloured = measured;
  coloured.colour = coloured_frames::colours(measured.size());
  PointCloud with_radius = coloured, with_stiffness = coloured;
  with_radius.fixture_radius_m.assign(measured.size(), 0.01);
  with_stiffness.stiffness_N_per_m.assign(measured.size(), 100);
  expect_left(with_radius), expect_left(with_stiffness);
  EXPECT_TRUE(pipeline->uses_device());
  library().failing = "clEnqueueMapBuffer", library().failing_call = 1;
  expect_left(coloured);
  EXPECT_EQ(reported_.size(), 1u);
  expect_left(coloured);
}

TEST_F(OpenClDoubleTest, TheCpuTakesOverFromADriverThatHangs) {
  EXPECT_TRUE(DevicePipeline::kFrameLimit == std::chrono::seconds(2));
  for (const auto& [limit_ms, answer] :
       {std::pair(2000, "no answer within 2 s"), std::pair(50, "no answer within 0.05 s")}) {
    begin_anew(), reported_.clear();
    const std::chrono::milliseconds limit(limit_ms);
    auto pipeline = open_pipeline(limit);
    library().failing = "clFinish", library().failing_call = 1, library().hangs = true;
    const double begin_s = steady_clock().now_s();
    EXPECT_TRUE(same_bits(processed_by(*pipeline), expected_));  // while the driver hangs
    EXPECT_GE(steady_clock().now_s() - begin_s, 1e-3 * limit_ms);
    EXPECT_TRUE(same_bits(processed_by(*pipeline), expected_));
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_HAS(reported_[0], answer);
    pipeline.reset();  // does not wait for the driver
    library().is_released = true;
    EXPECT_TRUE(everything_is_released());  // its thread tidies up when the driver returns
  }
}

// A sweep of short runs: the second run uses what the first one built and tried. Kernels that were built for
// a lost device are of no use when it is there again.
TEST_F(OpenClDoubleTest, KernelsAreBuiltAndTriedOnceInAProcessAndAnewAfterAFailure) {
  DepthDeviceSettings settings;
  settings.device = "opencl", settings.filter_window = 5;
  const auto calls_while_made = [&](const char* function, std::unique_ptr<DepthProcessor>& made) {
    library().failing = function, library().failing_call = 1000, library().calls = 0;
    made = make_depth_processor(settings, best(), nullptr);
    return library().calls.load();
  };
  std::unique_ptr<DepthProcessor> first, second, other, again;
  EXPECT_EQ(calls_while_made("clBuildProgram", first), 1);
  // The small first frame runs four kernels; there is no trial.
  EXPECT_EQ(calls_while_made("clEnqueueNDRangeKernel", second), 4);
  for (const auto& processor : {first.get(), second.get()})
    EXPECT_TRUE(same_bits(processed_by(*processor), processed(scene_, settings, some_pose())));
  settings.filter_window = 7;
  EXPECT_EQ(calls_while_made("clBuildProgram", other), 1) << "another window, other kernels";
  library().failing = "clFinish", library().failing_call = 1;
  EXPECT_TRUE(same_bits(processed_by(*other), processed(scene_, settings, some_pose())));
  first.reset(), second.reset(), other.reset();
  EXPECT_TRUE(everything_is_released());
  EXPECT_EQ(calls_while_made("clBuildProgram", again), 1);
}

TEST_F(OpenClDoubleTest, TheNameOfTheDeviceIsKnownForTheProvenance) {
  DepthDeviceSettings settings;
  EXPECT_EQ(depth_device_of(settings), "");
  settings.device = "opencl", settings.sigma_f_m = 0.02;
  EXPECT_EQ(depth_device_of(settings), "");
  const auto processor = make_depth_processor(settings, best(), nullptr);
  EXPECT_EQ(depth_device_of(settings), "opencl:0:0 (double, double)");
  library().failing = "clFinish", library().failing_call = 1;
  processed_by(*processor);
  EXPECT_EQ(depth_device_of(settings), "opencl:0:0 (double, double), which failed: then the CPU");
  settings.sigma_f_m = 0.03;
  EXPECT_EQ(depth_device_of(settings), "");  // no device has these settings
}

TEST_F(OpenClDoubleTest, ListingOfDevicesTimesOutIfDriversHang) {
  library().failing = "clGetPlatformIDs", library().failing_call = 1, library().hangs = true;
  EXPECT_THROW(listed_devices(std::chrono::milliseconds(50)), OpenClTimeout);
  // The call throws at once while they still hang. ctest would not wait 10 hours for a test.
  EXPECT_THROW(listed_devices(std::chrono::hours(10)), OpenClTimeout);
  EXPECT_HAS(refusal("opencl"), "did not list their devices");
  EXPECT_TRUE(refusal("auto").empty());
  library().is_released = true;
  std::vector<OpenClDevice> again;
  EXPECT_TRUE(wait_until([&] {
    library().failing = "";
    try {
      again = listed_devices();
    } catch (const OpenClTimeout&) {
    }
    return !again.empty();
  }));
  EXPECT_EQ(again.size(), 1u);
}

TEST_F(OpenClDoubleTest, ADeviceThatCannotBeOpenedIsRefusedWithTheReason) {
  for (const char* function : {"clGetPlatformIDs", "clGetPlatformInfo", "clGetDeviceIDs", "clGetDeviceInfo",
                               "clCreateContext", "clCreateCommandQueue", "clCreateProgramWithSource",
                               "clBuildProgram", "clCreateKernel", "clFinish"}) {
    begin_anew();
    library().failing = function, library().failing_call = 1;
    EXPECT_HAS(refusal("opencl"), std::string(function) + ": CL_OUT_OF_RESOURCES");
    EXPECT_TRUE(refusal("auto").empty());  // then the CPU does it
  }
  begin_anew();
  library().failing = "clBuildProgram", library().code = CL_BUILD_PROGRAM_FAILURE;
  EXPECT_HAS(refusal("opencl"), "clBuildProgram: error: of the double");
}

TEST_F(OpenClDoubleTest, NormalsThatOnlyTheCpuComputesAreRefusedForADevice) {
  for (const auto& [step, fit] :
       {std::pair{2, NormalFit::total_least_squares}, {1, NormalFit::inverse_depth}}) {
    DepthDeviceSettings settings;
    settings.normal_step = step, settings.normal_fit = fit;
    for (const char* device : {"cpu", "auto"}) {
      settings.device = device;
      EXPECT_EQ(validate(settings), "") << device;
    }
    settings.device = "opencl";
    EXPECT_EQ(validate(settings),
              "device = opencl: expected cpu with normal_step > 1 or normal_fit = inverse-depth");
  }
}

TEST_F(OpenClDoubleTest, AutoReportsOnceWhyTheCpuIsUsed) {
  std::vector<std::string> lines;
  DepthDeviceSettings settings;
  settings.device = "auto";
  library().is_wrong = true;
  for (int i = 0; i < 2; ++i)
    make_depth_processor(settings, best(), [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(lines, std::vector<std::string>{
                       "depth_pipeline.device = auto: the CPU processes the frames: opencl:0:0 (double, "
                       "double) gave other bits than the CPU in a trial frame"});
}

TEST_F(OpenClDoubleTest, ADeviceWithOtherBitsIsRefusedUnlessItIsAllowed) {
  library().is_imprecise = true;
  EXPECT_HAS(refusal("opencl:0:0"), "flushes subnormal numbers to zero in single precision");
  EXPECT_TRUE(refusal("opencl:0:0", false).empty());
  begin_anew();
  library().is_wrong = true;
  const std::string told = refusal("opencl");
  EXPECT_HAS(told, "gave other bits than the CPU in a trial frame");
  EXPECT_HAS(told, "exact = false allows it");
  EXPECT_TRUE(refusal("opencl", false).empty());
  EXPECT_HAS(refusal("opencl:0:1"), "there is no such device");
}

}  // namespace
}  // namespace remote_touch::opencl_double_test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
