// The adapter of librealsense, with a test double: what it does beyond the contract of all adapters of depth
// libraries.
#include "runners/live/sensors/depth_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/doubles/depth_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch::realsense_camera_test {
namespace {

class RealSenseCamera : public testing::Test {
 protected:
  void distort(int model) {
    camera_->state.lens.k = {-0.1, 0.02, 0.003, 0, 0, 0};
    camera_->state.lens.p1 = 1e-3, camera_->state.lens.p2 = -2e-3;
    camera_->state.model = model;
  }
  std::string refused() {
    return refusal([&] { open_realsense("", clock_); });
  }
  SimulatedClock clock_;
  CameraInstalled camera_{kRealSense, &clock_};
};

// A library refuses to work for another major version or a newer minor one.
TEST_F(RealSenseCamera, AcceptsTheVersionsOfTheLibrary) {
  for (const int version : {20000, 20203, 25000, 25605, 29999}) {
    camera_->state.version = version;
    EXPECT_NO_THROW(open_realsense("", clock_)) << version;
  }
  for (const auto& [version, text] :
       {std::pair(10900, "1.9.0"), std::pair(30001, "3.0.1"), std::pair(0, "0.0.0")}) {
    camera_->state.version = version;
    EXPECT_HAS(refused(), std::string(kRealSense.double_file) + ": is version " + text +
                              " of its interface: expected 2.x");
    EXPECT_HAS(realsense_availability().detail, "expected 2.x");
  }
}

TEST_F(RealSenseCamera, KeepsAPinholeCamera) {
  const auto source = open_realsense("", clock_);
  EXPECT_EQ(source->view().camera.width, 640);
  EXPECT_EQ(source->view().camera.height, 480);
  EXPECT_EQ(source->view().camera.fx, 500);
  EXPECT_EQ(source->view().camera.fy, 502);
  EXPECT_EQ(source->view().camera.cx, 321.3f);
  EXPECT_EQ(source->view().camera.cy, 238.6f);
}

// The L515 has a unit of a quarter of a millimetre, the D405 one of a tenth.
TEST_F(RealSenseCamera, UsesTheUnitOfTheCamera) {
  camera_->state.distance_m = 0.8;
  for (const double unit_m : {0.001, 0.00025, 0.0001}) {
    camera_->state.metres_per_unit = unit_m;
    const auto source = open_realsense("", clock_);
    EXPECT_NEAR(source->view().metres_per_unit, unit_m, 1e-9);
    SensorFrame frame;
    ASSERT_EQ(source->next(frame, 1), SensorState::frame);
    for (const std::uint16_t z : frame.depth)
      ASSERT_NEAR(z * source->view().metres_per_unit, 0.8, 0.51 * unit_m);
  }
}

TEST_F(RealSenseCamera, RefusesInvalidUnits) {
  for (const double unit_m : {0.0, -0.001, 2.0, static_cast<double>(NAN), HUGE_VAL}) {
    camera_->state.metres_per_unit = unit_m;
    EXPECT_HAS(refused(), "realsense: reports depth in units of ");
  }
}

TEST_F(RealSenseCamera, UndistortsLenses) {
  for (const int model : {2, 4}) {
    camera_->reset();
    distort(model);
    camera_->state.normal = {0.3, -0.1, 1};
    const auto source = open_realsense("", clock_);
    SensorFrame frame;
    ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
    const CameraIntrinsics& pinhole = source->view().camera;
    EXPECT_GT(std::abs(pinhole.fx - 500), 1);
    int present = 0;
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 640; ++u) {
        const std::uint16_t z = frame.depth[static_cast<std::size_t>(v * 640 + u)];
        if (z == 0) continue;
        ++present;
        const Eigen::Vector3d ray((u - pinhole.cx) / pinhole.fx, (v - pinhole.cy) / pinhole.fy, 1);
        ASSERT_NEAR(z, 500 / camera_->state.normal.dot(ray), 1.1) << u << " " << v;
      }
    EXPECT_GT(present, 640 * 480 * 9 / 10);
  }
}

TEST_F(RealSenseCamera, RefusesUnknownLensModels) {
  for (const int model : {1, 3, 5, 77, -1}) {
    distort(model);
    EXPECT_HAS(refused(), "realsense: has a lens of model " + std::to_string(model) + ": expected ");
  }
  distort(0);  // the coefficients have no meaning
  EXPECT_EQ(open_realsense("", clock_)->view().camera.fx, 500);
}

// Some versions of the library interpreted a lens model differently for points and for pixels.
TEST_F(RealSenseCamera, RefusesALensThatContradictsItself) {
  distort(2);
  camera_->state.fail_name = "rs2_deproject_pixel_to_point";
  EXPECT_HAS(refused(), "realsense: has a calibration that contradicts itself");
}

TEST_F(RealSenseCamera, AnOldLibraryWithoutLensesIsRefusedIfTheLensDistorts) {
  SimulatedClock clock;
  CameraInstalled old(kOldRealSense, &clock);
  old->state.version = 22700;
  old->state.lens.k[0] = 0.1;
  EXPECT_HAS(refusal([&] { open_realsense("", clock); }),
             "realsense: has a lens with distortion: expected librealsense 2.46 or newer");
}

TEST_F(RealSenseCamera, RefusesInvalidImages) {
  for (const auto& [fx, cx] :
       {std::pair(0.0, 320.0), std::pair(-500.0, 320.0), std::pair(static_cast<double>(NAN), 320.0),
        std::pair(HUGE_VAL, 320.0), std::pair(500.0, HUGE_VAL)}) {
    camera_->state.lens.fx = fx, camera_->state.lens.cx = cx;
    EXPECT_HAS(refused(), "realsense: reports no usable intrinsics: expected");
  }
}

TEST_F(RealSenseCamera, RefusesCamerasWithoutDepth) {
  camera_->state.sends_depth = false;
  EXPECT_HAS(refused(), "realsense: sends no depth in 16 bits");
  camera_->state.sends_depth = true, camera_->state.has_depth_sensor = false;
  EXPECT_HAS(refused(), "realsense: has no depth sensor");
}

TEST_F(RealSenseCamera, AcceptsDepthThatComesAlone) {
  camera_->state.is_alone = true;
  const auto source = open_realsense("", clock_);
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
  EXPECT_EQ(frame.depth[0], 500);
}

TEST_F(RealSenseCamera, RefusesFramesThatAreTooShort) {
  camera_->state.missing_bytes = 1;
  const auto source = open_realsense("", clock_);
  SensorFrame frame;
  EXPECT_EQ(source->next(frame, 1), SensorState::failed);
  EXPECT_EQ(source->failure(),
            "realsense: a frame is 640 x 480 pixels in 614399 bytes: expected those of the camera's mode");
}

TEST_F(RealSenseCamera, RefusesInvalidStamps) {
  for (const double stamp_s : {static_cast<double>(NAN), HUGE_VAL}) {
    camera_->state.stamp_s = [stamp_s](int) { return stamp_s; };
    const auto source = open_realsense("", clock_);
    SensorFrame frame;
    EXPECT_EQ(source->next(frame, 1), SensorState::failed);
    EXPECT_EQ(source->failure(), "realsense: a frame has no time stamp");
  }
}

// Frames are numbered by the camera's own count, even if it jumps by more than an int holds.
TEST_F(RealSenseCamera, NumbersFollowTheCount) {
  camera_->state.reported_number = [](int number) {
    return number == 1 ? 7 : number == 2 ? 8 : number == 3 ? 12 : 2000000000 + number;
  };
  const auto source = open_realsense("", clock_);
  SensorFrame frame;
  std::vector<int> numbers;
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(source->next(frame, 1), SensorState::frame);
    numbers.push_back(frame.number);
  }
  EXPECT_EQ(numbers, (std::vector<int>{1, 2, 6, 7, 8}));
}

// A camera in recovery mode reports no serial number.
TEST_F(RealSenseCamera, AcceptsACameraWithoutSerialNumber) {
  camera_->state.serials = {"", "CL2F"};
  EXPECT_HAS(realsense_availability().detail, ": unknown, CL2F");
  EXPECT_NO_THROW(open_realsense("CL2F", clock_));
}

// The adapter does not check whether the camera is there while frames come. It checks ten times a second
// otherwise.
TEST_F(RealSenseCamera, ChecksForItsCameraWhenNoFrameComes) {
  camera_->state.silent_after = 5;
  const auto source = open_realsense("", clock_);
  SensorFrame frame;
  for (int i = 0; i < 5; ++i) ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  EXPECT_EQ(camera_->count("rs2_device_hub_is_device_connected"), 0);
  EXPECT_EQ(source->next(frame, 1.05), SensorState::waiting);
  EXPECT_EQ(camera_->count("rs2_device_hub_is_device_connected"), 10);
}

}  // namespace
}  // namespace remote_touch::realsense_camera_test
