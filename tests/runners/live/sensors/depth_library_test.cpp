// The contract that the adapters of all depth cameras' libraries fulfil, tested with test doubles of the
// libraries on a simulated clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/doubles/depth_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch::depth_library_test {
namespace {

constexpr double kRounding_s = 1e-12;  // rounding of sums of times

class DepthLibraryContract : public testing::TestWithParam<const DepthLibrary*> {
 protected:
  static const DepthLibrary& library() { return *GetParam(); }
  static bool is_k4a() { return &library() == &kK4a; }
  static std::string address() { return is_k4a() ? "?nfov-binned" : ""; }  // the smallest images
  std::unique_ptr<DepthSource> open() { return library().open(address(), clock_); }

  void SetUp() override { look_at_a_slope(); }
  void look_at_a_slope() {
    camera_->state.normal = {0.1, -0.2, 1};
    camera_->state.distance_m = 0.6;
    if (is_k4a()) camera_->state.lens = CameraLens::distorted_k4a();
  }
  // The camera rounds its depth once, and the undistortion rounds it again if the lens distorts.
  void expect_plane_in(const SensorFrame& frame, const SensorView& view) {
    expect_plane(*camera_, frame, view, is_k4a() ? 1.1 : 0.51, 0.9);
  }

  SimulatedClock clock_;
  CameraInstalled camera_{library(), &clock_};
};

// The rows of the images have gaps.
TEST_P(DepthLibraryContract, ShowsWhatTheCameraSees) {
  camera_->state.row_gap_bytes = 46;
  const auto source = open();
  EXPECT_FALSE(source->view().has_colour);
  EXPECT_EQ(source->view().frame_rate_hz, 30);
  EXPECT_NEAR(source->view().metres_per_unit, 0.001, 1e-9);
  SensorFrame frame;
  for (int number = 1; number <= 3; ++number) {
    ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
    EXPECT_EQ(frame.number, number);
    EXPECT_TRUE(is_complete(frame, source->view()));
    expect_plane_in(frame, source->view());
  }
}

// Frame n arrives n / 30 s after the start. It is taken within a millisecond, and the stamps are even.
TEST_P(DepthLibraryContract, TimesAreOfTheCamerasClock) {
  const auto source = open();
  const double start_s = clock_.now_s();
  SensorFrame frame;
  double before_s = 0;
  for (int number = 1; number <= 30; ++number) {
    ASSERT_EQ(source->next(frame, 1), SensorState::frame);
    EXPECT_LE(frame.captured_s, clock_.now_s() + kRounding_s);
    EXPECT_NEAR(frame.captured_s, start_s + number / 30.0, 1.01e-3);
    if (number > 3) {
      EXPECT_NEAR(frame.captured_s - before_s, 1 / 30.0, 0.4e-3);
    }
    before_s = frame.captured_s;
  }
}

// Every seventh pixel is a hole, in a pattern without rows or columns. If the lens distorts, a ray gets the
// depth of its nearest pixel, so about as many rays are holes, except at the image's border.
TEST_P(DepthLibraryContract, APixelWithoutAMeasurementIsNoPoint) {
  camera_->state.hole_every = 7;
  const auto source = open();
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  const PointCloud cloud = cloud_of(frame, source->view(), RigidTransform::Identity());
  const auto missing = std::count_if(cloud.z.begin(), cloud.z.end(), [](double z) { return std::isnan(z); });
  EXPECT_EQ(missing, std::count(frame.depth.begin(), frame.depth.end(), 0));
  const CameraIntrinsics& image = source->view().camera;
  int holes = 0;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) holes += (u + 3 * v) % 7 == 0;
  EXPECT_NEAR(static_cast<double>(missing), holes, is_k4a() ? 0.05 * holes : 0);
  for (const std::uint16_t z : frame.depth) EXPECT_TRUE(z == 0 || z > 300);
}

TEST_P(DepthLibraryContract, LateReaderGetsTheNewestFrame) {
  const auto source = open();
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  clock_.sleep_s(0.42);
  ASSERT_EQ(source->next(frame, 0), SensorState::frame);
  EXPECT_EQ(frame.number, 13);
  EXPECT_EQ(source->next(frame, 0), SensorState::waiting);
}

TEST_P(DepthLibraryContract, ACameraThatStopsSendingIsWaitedForAndNoFailure) {
  camera_->state.silent_after = 2;
  const auto source = open();
  SensorFrame frame;
  for (int i = 0; i < 2; ++i) ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  const double start_s = clock_.now_s();
  EXPECT_EQ(source->next(frame, 0.5), SensorState::waiting);
  EXPECT_NEAR(clock_.now_s() - start_s, 0.5, 2e-3);
  EXPECT_EQ(source->next(frame, 0), SensorState::waiting);
  EXPECT_NEAR(clock_.now_s() - start_s, 0.5, 2e-3);
  EXPECT_EQ(source->failure(), "");
}

TEST_P(DepthLibraryContract, AnUnpluggedCameraIsReported) {
  camera_->state.lost_after = 2;
  const auto source = open();
  SensorFrame frame;
  for (int i = 0; i < 2; ++i) ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  const double start_s = clock_.now_s();
  EXPECT_EQ(source->next(frame, 60), SensorState::failed);
  EXPECT_LT(clock_.now_s() - start_s, 0.2);
  EXPECT_HAS(source->failure(), "was disconnected");
  EXPECT_EQ(source->next(frame, 60), SensorState::failed);
  EXPECT_LT(clock_.now_s() - start_s, 0.2);
}

TEST_P(DepthLibraryContract, ImagesOfAnotherSizeAreRefused) {
  camera_->state.missing_rows = 2;
  const auto source = open();
  SensorFrame frame;
  EXPECT_EQ(source->next(frame, 1), SensorState::failed);
  EXPECT_HAS(source->failure(), is_k4a() ? " is 320 x 286 pixels in " : " is 640 x 478 pixels in ");
  EXPECT_HAS(source->failure(), ": expected those of the camera's mode");
}

// A frame that the camera sends twice is dropped. Frames continue when the camera's clock begins anew.
TEST_P(DepthLibraryContract, RepeatedFramesAreDroppedAndAClockMayBeginAnew) {
  camera_->state.stamp_s = [](int number) {
    return number == 3 ? 5 + 2 / 30.0 : (number < 6 ? 5 : -0.1) + number / 30.0;
  };
  camera_->state.reported_number = [](int number) {
    return number == 3 ? 2 : number < 6 ? number : number - 5;
  };
  const auto source = open();
  SensorFrame frame;
  std::vector<int> numbers;
  std::vector<double> taken_s;
  double before_s = -1;
  for (int i = 0; i < 7; ++i) {
    ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
    numbers.push_back(frame.number);
    taken_s.push_back(clock_.now_s());
    EXPECT_GT(frame.captured_s, before_s);
    EXPECT_LE(frame.captured_s, clock_.now_s() + kRounding_s);
    before_s = frame.captured_s;
  }
  EXPECT_EQ(numbers, (std::vector<int>{1, 2, 4, 5, 6, 7, 8}));
  for (int i = 0; i < 7; ++i)
    EXPECT_NEAR(taken_s[static_cast<std::size_t>(i)] - taken_s[0], (i < 2 ? i : i + 1) / 30.0, 1.1e-3);
}

TEST_P(DepthLibraryContract, FramesWithoutDepthArePassedOver) {
  camera_->state.has_depth = [](int number) { return number != 2; };
  const auto source = open();
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
  EXPECT_EQ(frame.number, 3);
}

TEST_P(DepthLibraryContract, FindsCamerasBySerialNumber) {
  for (const char* serial : {"000123", "CL2F"}) {
    const auto source = library().open(serial + address(), clock_);
    SensorFrame frame;
    EXPECT_EQ(source->next(frame, 1), SensorState::frame);
  }
  EXPECT_HAS(refusal([&] { library().open("123" + address(), clock_); }),
             "no camera has this serial number: expected 000123, CL2F");
}

TEST_P(DepthLibraryContract, NamesTheCamerasAndRefusesThoseThatCannotBeOpened) {
  EXPECT_TRUE(library().availability().found);
  EXPECT_HAS(library().availability().detail, std::string(library().double_file));
  EXPECT_HAS(library().availability().detail, is_k4a() ? ": 2 cameras" : " (2.56.5): 000123, CL2F");
  camera_->state.held_by_others = 0;
  EXPECT_HAS(refusal([&] { open(); }), "another program may ");
  camera_->state.serials.clear();
  EXPECT_HAS(refusal([&] { open(); }), ": no camera is plugged in: expected one ");
  EXPECT_FALSE(library().availability().found);
  EXPECT_HAS(library().availability().detail, ": no camera is plugged in");
}

TEST_P(DepthLibraryContract, AbsentLibraryIsNamedWithTheVariable) {
  expect_absent_library_is_named(library(), [&] { open(); });
}

TEST_P(DepthLibraryContract, AnotherLibraryIsRefused) {
  const DepthLibrary& other = is_k4a() ? kRealSense : kK4a;
  setenv(library().variable, other.double_file, 1);
  const std::string message = refusal([&] { open(); });
  EXPECT_HAS(message, std::string(other.double_file) + ": has no function " + (is_k4a() ? "k4a_" : "rs2_"));
  EXPECT_HAS(message, library().variable);
  EXPECT_EQ(library().availability().detail, message);
}

// Calls that cannot fail, or whose failure costs a frame but not the camera.
bool may_be_silent(const std::string& call) {
  for (const char* part : {"delete_", "release", "_stop", "_close"})
    if (call.find(part) != std::string::npos) return true;
  return call == "k4a_device_get_capture" || call == "k4a_capture_get_depth_image" ||
         call == "k4a_image_get_device_timestamp_usec";
}

// Opens the camera, takes three frames and closes it. Returns the first problem that is reported.
std::string problem_of_a_run(const DepthLibrary& library, const std::string& address, SimulatedClock& clock) {
  try {
    const auto source = library.open(address, clock);
    SensorFrame frame;
    for (int i = 0; i < 3; ++i)
      if (source->next(frame, 0.2) == SensorState::failed) {
        EXPECT_EQ(source->next(frame, 0.2), SensorState::failed);
        return source->failure();
      }
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST_P(DepthLibraryContract, EveryCallFailsOnce) {
  EXPECT_EQ(problem_of_a_run(library(), address(), clock_), "");
  const std::vector<std::string> calls = camera_->calls();
  EXPECT_GT(calls.size(), 20u);
  for (std::size_t n = 1; n <= calls.size(); ++n) {
    camera_->reset();
    look_at_a_slope();
    camera_->state.fail_at = static_cast<int>(n);
    const std::string problem = problem_of_a_run(library(), address(), clock_);
    const std::string& call = camera_->calls()[n - 1];
    EXPECT_EQ(call, calls[n - 1]);
    if (!may_be_silent(call)) {
      EXPECT_NE(problem, "") << call;
    }
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
    if (!is_k4a() && !problem.empty()) {
      EXPECT_HAS(problem, " (the library says: " + call + ": the double's text for " + call + ")");
    }
    camera_.expect_all_given_back();
  }
}

INSTANTIATE_TEST_SUITE_P(All, DepthLibraryContract, testing::Values(&kK4a, &kRealSense, &kOldRealSense),
                         [](const auto& given) { return std::string(given.param->name); });

}  // namespace
}  // namespace remote_touch::depth_library_test
