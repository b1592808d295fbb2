// What the adapters of the k4a interface and of librealsense do beyond the contract of all adapters of depth
// libraries, with test doubles.
#include "runners/live/sensors/depth_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/doubles/depth_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch::depth_cameras_test {
namespace {

template <const DepthLibrary& library>
class CameraTest : public testing::Test {
 protected:
  std::unique_ptr<DepthSource> open(const std::string& address = "") { return library.open(address, clock_); }
  std::string refused(const std::string& address = "") {
    return refusal([&] { open(address); });
  }
  // Checks that the first frame is refused with this text.
  void expect_failure(const std::string& address, const std::string& text) {
    const auto source = open(address);
    SensorFrame frame;
    EXPECT_EQ(source->next(frame, 1), SensorState::failed);
    EXPECT_HAS(source->failure(), text);
  }
  std::vector<int> numbers(const std::string& address, int count) {
    const auto source = open(address);
    std::vector<int> numbers;
    for (SensorFrame frame; static_cast<int>(numbers.size()) < count; numbers.push_back(frame.number))
      if (source->next(frame, 1) != SensorState::frame) break;
    return numbers;
  }

  SimulatedClock clock_;
  CameraInstalled camera_{library, &clock_};
};

using K4aCamera = CameraTest<kK4a>;
using RealSenseCamera = CameraTest<kRealSense>;

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
    const auto source = open(mode.address);
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

TEST_F(K4aCamera, RefusesOtherModesAndNumbers) {
  for (const char* address : {"?", "?wide", "0?nfov ", "?nfov?nfov", "0?NFOV"})
    EXPECT_HAS(refused(address),
               "k4a:" + std::string(address) +
                   ": no mode of the camera: expected one of nfov, nfov-binned, wfov-binned, wfov after ?");
  EXPECT_HAS(refused("2"), "k4a:2: no such camera: expected 0 to 1, or a serial number");
  EXPECT_HAS(refused("99?nfov"), "k4a:99?nfov: no such camera: expected 0 to 1");
  for (const char* address : {"-1", "x", "1.", " 0", "100"})
    EXPECT_HAS(refused(address),
               "k4a:" + std::string(address) + ": no camera has this serial number: expected 000123, CL2F");
  camera_->state.held_by_others = 0;
  EXPECT_NO_THROW(open("1?nfov-binned"));
  EXPECT_HAS(
      refused("x"),
      "expected one that cannot be opened (the library says: libusb device(s) are all unavailable), CL2F");
  EXPECT_NO_THROW(open("CL2F?nfov-binned"));
}

// The machine has more cameras than ports, or a serial number does not fit.
TEST_F(K4aCamera, RefusesInvalidCountsAndSerialNumbers) {
  camera_->state.serials.assign(100000, "x");
  EXPECT_HAS(refused("0"), "k4a:0: no camera is plugged in");
  EXPECT_FALSE(k4a_availability().found);
  camera_->state.serials = {std::string(1000, '7'), "CL2F"};
  EXPECT_NO_THROW(open("CL2F?nfov-binned"));
  EXPECT_HAS(refused("123"), "expected one without serial number, CL2F");
}

// The reason is the library's first line. The lines after it state which call asked for it.
TEST_F(K4aCamera, RefusesWithTheReasonOfTheLibrarysLog) {
  for (const auto& [function, message] :
       {std::pair("k4a_device_start_cameras",
                  "k4a: depth does not start (the library says: depth engine create failed): expected the "
                  "vendor's depth engine"),
        std::pair("k4a_device_get_calibration",
                  "k4a: does not report its calibration (the library says: no calibration)"),
        std::pair("k4a_calibration_2d_to_3d", "k4a: has no calibration that can be used"),
        std::pair("k4a_calibration_3d_to_2d", "k4a: has a calibration that contradicts itself")}) {
    camera_->state.fail_name = function;
    EXPECT_HAS(refused(), message);
  }
  camera_->state.fail_name = "";
  camera_->state.lost_after = 1;
  const auto source = open("?nfov-binned");
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  EXPECT_EQ(source->next(frame, 1), SensorState::failed);
  EXPECT_EQ(source->failure(),
            "k4a:?nfov-binned: was disconnected, or its depth engine has stopped (the library says: usb "
            "device gone)");
}

TEST_F(K4aCamera, RefusesFramesWithoutDepth) {
  for (const int missing : {1, 100, 320 * 288 * 2}) {
    camera_->state.missing_bytes = missing;
    expect_failure("?nfov-binned", "a frame is 320 x 288 pixels in " +
                                       std::to_string(320 * 288 * 2 - missing) +
                                       " bytes of format 4: expected");
  }
  camera_->state.missing_bytes = 0;
  camera_->state.format = 5;  // infrared
  expect_failure("?nfov-binned", " bytes of format 5: expected");
}

// The camera does not count its frames, but its stamps show how many are missing.
TEST_F(K4aCamera, NumbersFollowTheStamps) {
  camera_->state.stamp_s = [](int number) { return 100 + (number >= 3 ? number + 4 : number) / 30.0; };
  EXPECT_EQ(numbers("?nfov-binned", 4), (std::vector<int>{1, 2, 7, 8}));
}

// The wide mode: the lens does not see the corners, and the pinhole image keeps the field of view. At the rim
// the nearest pixel counts.
TEST_F(K4aCamera, UndistortsAWideLens) {
  camera_->state.lens = {512,  512,   252, 252.3, 258.6, 257.4, {0.52, 0.16, 0.008, 0.86, 0.26, 0.04},
                         1e-4, -2e-4, 1.7};
  camera_->state.normal = {0.2, 0.1, 1};
  camera_->state.distance_m = 1.5;
  const auto source = open("?wfov-binned");
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
  EXPECT_LT(source->view().camera.fx, 252);
  expect_plane(*camera_, frame, source->view(), 1.1, 0.5, 1.65);
  EXPECT_EQ(frame.depth[0], 0);
}

// A library refuses to work for another major version or a newer minor one.
TEST_F(RealSenseCamera, AcceptsTheVersionsOfTheLibrary) {
  for (const int version : {20000, 20203, 25000, 25605, 29999}) {
    camera_->state.version = version;
    EXPECT_NO_THROW(open()) << version;
  }
  for (const auto& [version, text] :
       {std::pair(10900, "1.9.0"), std::pair(30001, "3.0.1"), std::pair(0, "0.0.0")}) {
    camera_->state.version = version;
    EXPECT_HAS(refused(), std::string(kRealSense.double_file) + ": is version " + text +
                              " of its interface: expected 2.x");
    EXPECT_HAS(realsense_availability().detail, "expected 2.x");
  }
}

// The L515 has a unit of a quarter of a millimetre, the D405 one of a tenth. The depth comes alone here, not
// with other streams.
TEST_F(RealSenseCamera, KeepsAPinholeCameraAndUsesItsUnit) {
  camera_->state.distance_m = 0.8;
  camera_->state.is_alone = true;
  for (const double unit_m : {0.001, 0.00025, 0.0001}) {
    camera_->state.metres_per_unit = unit_m;
    const auto source = open();
    const CameraIntrinsics& camera = source->view().camera;
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    EXPECT_EQ(camera.fx, 500);
    EXPECT_EQ(camera.fy, 502);
    EXPECT_EQ(camera.cx, 321.3f);
    EXPECT_EQ(camera.cy, 238.6f);
    EXPECT_NEAR(source->view().metres_per_unit, unit_m, 1e-9);
    SensorFrame frame;
    ASSERT_EQ(source->next(frame, 1), SensorState::frame);
    expect_plane(*camera_, frame, source->view(), 0.51, 0.999);
  }
}

TEST_F(RealSenseCamera, UndistortsLensesOfBrownAndConrady) {
  for (const int model : {2, 4}) {
    camera_->reset();
    camera_->state.lens.k = {-0.1, 0.02, 0.003, 0, 0, 0};
    camera_->state.lens.p1 = 1e-3, camera_->state.lens.p2 = -2e-3;
    camera_->state.model = model;
    camera_->state.normal = {0.3, -0.1, 1};
    const auto source = open();
    SensorFrame frame;
    ASSERT_EQ(source->next(frame, 1), SensorState::frame) << source->failure();
    EXPECT_GT(std::abs(source->view().camera.fx - 500), 1);
    expect_plane(*camera_, frame, source->view(), 1.1, 0.9);
  }
  camera_->state.model = 0;  // the coefficients have no meaning
  EXPECT_EQ(open()->view().camera.fx, 500);
}

// Some versions of the library interpreted a lens model differently for points and for pixels.
TEST_F(RealSenseCamera, RefusesUnusableCameras) {
  using State = CameraDouble::State;
  const auto with_model = [](int model) {
    return [model](State& state) { state.lens.k[0] = -0.1, state.model = model; };
  };
  const double none = std::nan("");
  std::vector<std::pair<std::function<void(State&)>, std::string>> all = {
      {[](State& state) { state.lens.k[0] = 0.1, state.fail_name = "rs2_deproject_pixel_to_point"; },
       "has a calibration that contradicts itself"},
      {[](State& state) { state.sends_depth = false; }, "sends no depth in 16 bits"},
      {[](State& state) { state.has_depth_sensor = false; }, "has no depth sensor"}};
  for (const int model : {1, 3, 5, 77, -1})
    all.emplace_back(with_model(model), "has a lens of model " + std::to_string(model) + ": expected ");
  for (const double unit_m : {0.0, -0.001, 2.0, none, HUGE_VAL})
    all.emplace_back([=](State& state) { state.metres_per_unit = unit_m; }, "reports depth in units of ");
  for (const auto& [fx, cx] : {std::pair(0.0, 320.0), std::pair(-500.0, 320.0), std::pair(none, 320.0),
                               std::pair(HUGE_VAL, 320.0), std::pair(500.0, HUGE_VAL)})
    all.emplace_back([fx = fx, cx = cx](State& state) { state.lens.fx = fx, state.lens.cx = cx; },
                     "reports no usable intrinsics: expected");
  for (const auto& [change, message] : all) {
    camera_->reset();
    change(camera_->state);
    EXPECT_HAS(refused(), "realsense: " + message);
  }
}

TEST_F(RealSenseCamera, AnOldLibraryWithoutLensesIsRefusedIfTheLensDistorts) {
  CameraInstalled old(kOldRealSense, &clock_);
  old->state.version = 22700;
  old->state.lens.k[0] = 0.1;
  EXPECT_HAS(refused(), "realsense: has a lens with distortion: expected librealsense 2.46 or newer");
}

TEST_F(RealSenseCamera, RefusesFramesThatAreTooShortOrHaveNoStamp) {
  camera_->state.missing_bytes = 1;
  expect_failure(
      "", "realsense: a frame is 640 x 480 pixels in 614399 bytes: expected those of the camera's mode");
  camera_->state.missing_bytes = 0;
  for (const double stamp_s : {std::nan(""), HUGE_VAL}) {
    camera_->state.stamp_s = [stamp_s](int) { return stamp_s; };
    expect_failure("", "realsense: a frame has no time stamp");
  }
}

// Frames are numbered by the camera's own count, even if it jumps by more than an int holds.
TEST_F(RealSenseCamera, NumbersFollowTheCount) {
  camera_->state.reported_number = [](int number) {
    return number == 1 ? 7 : number == 2 ? 8 : number == 3 ? 12 : 2000000000 + number;
  };
  EXPECT_EQ(numbers("", 5), (std::vector<int>{1, 2, 6, 7, 8}));
}

// A camera in recovery mode reports no serial number.
TEST_F(RealSenseCamera, AcceptsACameraWithoutSerialNumber) {
  camera_->state.serials = {"", "CL2F"};
  EXPECT_HAS(realsense_availability().detail, ": unknown, CL2F");
  EXPECT_NO_THROW(open("CL2F"));
}

// The adapter does not check whether the camera is there while frames come. It checks ten times a second
// otherwise.
TEST_F(RealSenseCamera, ChecksForItsCameraWhenNoFrameComes) {
  camera_->state.silent_after = 5;
  const auto source = open();
  SensorFrame frame;
  for (int i = 0; i < 5; ++i) ASSERT_EQ(source->next(frame, 1), SensorState::frame);
  EXPECT_EQ(camera_->count("rs2_device_hub_is_device_connected"), 0);
  EXPECT_EQ(source->next(frame, 1.05), SensorState::waiting);
  EXPECT_EQ(camera_->count("rs2_device_hub_is_device_connected"), 10);
}

}  // namespace
}  // namespace remote_touch::depth_cameras_test
