// The adapter of the k4a interface, with a test double: what it does beyond the contract of all adapters of
// depth libraries.
#include "runners/live/sensors/depth_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/doubles/depth_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch::k4a_camera_test {
namespace {

class K4aCamera : public testing::Test {
 protected:
  SimulatedClock clock_;
  CameraInstalled camera_{kK4a, &clock_};
};

struct ModeInWords {
  const char* address;
  int width, height;
  double rate_hz;
};

TEST_F(K4aCamera, HasItsModes) {
  for (const ModeInWords& mode :
       {ModeInWords{"", 640, 576, 30}, ModeInWords{"?nfov", 640, 576, 30},
        ModeInWords{"1?nfov-binned", 320, 288, 30}, ModeInWords{"0?wfov-binned", 512, 512, 30},
        ModeInWords{"CL2F?wfov", 1024, 1024, 15}}) {
    camera_->state.lens = {
        .fx = 0.8 * mode.width, .fy = 0.8 * mode.width, .cx = 0.5 * mode.width, .cy = 0.5 * mode.height};
    const auto source = open_k4a(mode.address, clock_);
    EXPECT_EQ(source->view().camera.width, mode.width);
    EXPECT_EQ(source->view().camera.height, mode.height);
    // The library computes in floats.
    EXPECT_NEAR(source->view().camera.fx, 0.8 * mode.width, 1e-3);
    EXPECT_NEAR(source->view().camera.cy, 0.5 * mode.height, 1e-3);
    EXPECT_EQ(source->view().frame_rate_hz, mode.rate_hz);
    SensorFrame frame;
    const double start_s = clock_.now_s();
    ASSERT_EQ(source->next(frame, 1), SensorState::frame) << mode.address << ": " << source->failure();
    EXPECT_NEAR(clock_.now_s() - start_s, 1 / mode.rate_hz, 2e-6);
  }
}

TEST_F(K4aCamera, OtherModesAreRefused) {
  for (const char* address : {"?", "?wide", "0?nfov ", "?nfov?nfov", "0?NFOV"})
    EXPECT_HAS(refusal([&] { open_k4a(address, clock_); }),
               "k4a:" + std::string(address) +
                   ": no mode of the camera: expected one of nfov, nfov-binned, wfov-binned, wfov after ?");
}

TEST_F(K4aCamera, CamerasAreNumbered) {
  EXPECT_HAS(refusal([&] { open_k4a("2", clock_); }),
             "k4a:2: no such camera: expected 0 to 1, or a serial number");
  EXPECT_HAS(refusal([&] { open_k4a("99?nfov", clock_); }), "k4a:99?nfov: no such camera: expected 0 to 1");
  for (const char* address : {"-1", "x", "1.", " 0", "100"})
    EXPECT_HAS(refusal([&] { open_k4a(address, clock_); }),
               "k4a:" + std::string(address) + ": no camera has this serial number: expected 000123, CL2F");
  camera_->state.held_by_others = 0;
  EXPECT_NO_THROW(open_k4a("1?nfov-binned", clock_));
  EXPECT_HAS(
      refusal([&] { open_k4a("x", clock_); }),
      "expected one that cannot be opened (the library says: libusb device(s) are all unavailable), CL2F");
  EXPECT_NO_THROW(open_k4a("CL2F?nfov-binned", clock_));
}

// More cameras than a machine has ports.
TEST_F(K4aCamera, RefusesInvalidCounts) {
  camera_->state.serials.assign(100000, "x");
  EXPECT_HAS(refusal([&] { open_k4a("0", clock_); }), "k4a:0: no camera is plugged in");
  EXPECT_FALSE(k4a_availability().found);
}

TEST_F(K4aCamera, RefusesSerialNumbersThatDoNotFit) {
  camera_->state.serials = {std::string(1000, '7'), "CL2F"};
  EXPECT_NO_THROW(open_k4a("CL2F?nfov-binned", clock_));
  EXPECT_HAS(refusal([&] { open_k4a("123", clock_); }), "expected one without serial number, CL2F");
}

// The reason is the library's first line. The lines after it state which call asked for it.
TEST_F(K4aCamera, TheReasonIsThatOfTheLibrarysLog) {
  camera_->state.fail_name = "k4a_device_start_cameras";
  EXPECT_HAS(
      refusal([&] { open_k4a("", clock_); }),
      "k4a: depth does not start (the library says: depth engine create failed): expected the vendor's depth engine");
  camera_->state.fail_name = "k4a_device_get_calibration";
  EXPECT_HAS(refusal([&] { open_k4a("", clock_); }),
             "k4a: does not report its calibration (the library says: no calibration)");
  camera_->state.fail_name = "";
  camera_->state.lost_after = 1;
  const auto source = open_k4a("?nfov-binned", clock_);
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  EXPECT_EQ(source->next(frame, 1), SensorState::failed);
  EXPECT_EQ(
      source->failure(),
      "k4a:?nfov-binned: was disconnected, or its depth engine has stopped (the library says: usb device gone)");
}

TEST_F(K4aCamera, RefusesUnusableCalibrations) {
  camera_->state.fail_name = "k4a_calibration_2d_to_3d";
  EXPECT_HAS(refusal([&] { open_k4a("", clock_); }), "k4a: has no calibration that can be used");
  camera_->state.fail_name = "k4a_calibration_3d_to_2d";
  EXPECT_HAS(refusal([&] { open_k4a("", clock_); }), "k4a: has a calibration that contradicts itself");
}

TEST_F(K4aCamera, RefusesFramesWithoutDepth) {
  for (const int missing : {1, 100, 320 * 288 * 2}) {
    camera_->state.missing_bytes = missing;
    const auto source = open_k4a("?nfov-binned", clock_);
    SensorFrame frame;
    EXPECT_EQ(source->next(frame, 1), SensorState::failed);
    EXPECT_HAS(source->failure(), "a frame is 320 x 288 pixels in " +
                                      std::to_string(320 * 288 * 2 - missing) +
                                      " bytes of format 4: expected");
  }
  camera_->state.missing_bytes = 0;
  camera_->state.format = 5;  // infrared
  const auto source = open_k4a("?nfov-binned", clock_);
  SensorFrame frame;
  EXPECT_EQ(source->next(frame, 1), SensorState::failed);
  EXPECT_HAS(source->failure(), " bytes of format 5: expected");
}

// The camera does not count its frames, but its stamps show how many are missing.
TEST_F(K4aCamera, NumbersFollowTheStamps) {
  camera_->state.stamp_s = [](int number) { return 100 + (number >= 3 ? number + 4 : number) / 30.0; };
  const auto source = open_k4a("?nfov-binned", clock_);
  SensorFrame frame;
  std::vector<int> numbers;
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(source->next(frame, 1), SensorState::frame);
    numbers.push_back(frame.number);
  }
  EXPECT_EQ(numbers, (std::vector<int>{1, 2, 7, 8}));
}

// The wide mode: the lens does not see the corners, and the pinhole image keeps the field of view.
TEST_F(K4aCamera, UndistortsAWideLens) {
  camera_->state.lens = {512,  512,   252, 252.3, 258.6, 257.4, {0.52, 0.16, 0.008, 0.86, 0.26, 0.04},
                         1e-4, -2e-4, 1.7};
  camera_->state.normal = {0.2, 0.1, 1};
  camera_->state.distance_m = 1.5;
  const auto source = open_k4a("?wfov-binned", clock_);
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
  const CameraIntrinsics& pinhole = source->view().camera;
  EXPECT_LT(pinhole.fx, 252);
  int present = 0;
  for (int v = 0; v < 512; ++v)
    for (int u = 0; u < 512; ++u) {
      const std::uint16_t z = frame.depth[static_cast<std::size_t>(v * 512 + u)];
      if (z == 0) continue;
      ++present;
      const Eigen::Vector3d ray((u - pinhole.cx) / pinhole.fx, (v - pinhole.cy) / pinhole.fy, 1);
      const double from_axis = ray.head<2>().norm();
      ASSERT_LT(from_axis, 1.71);
      if (from_axis > 1.65) continue;  // rim: the nearest pixel counts
      ASSERT_NEAR(z, 1500 / camera_->state.normal.dot(ray), 1.1) << u << " " << v;
    }
  EXPECT_GT(present, 512 * 512 / 2);
  EXPECT_EQ(frame.depth[0], 0);
}

}  // namespace
}  // namespace remote_touch::k4a_camera_test
