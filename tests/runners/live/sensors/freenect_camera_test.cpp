// The adapter on fakenect, the library that libfreenect ships to play recordings instead of a Kinect.
#include "runners/live/sensors/depth_source.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>

#include "runners/live/devices/clock.h"
#include "tests/support/start_with_libraries.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::freenect_camera_test {
namespace {

constexpr int kWidth = 640, kHeight = 480, kFrames = 12;
constexpr double kStampPeriod_s = 4294967296.0 / 60e6;  // period after which the stamps begin anew

// The value that the sensor measures: 11 bits, 2047 if it measures nothing. The first pixel encodes the
// frame's number.
int shift_at(int number, int u, int v) {
  if (u == 0 && v == 0) return 600 + 20 * number;
  return (7 * u + 13 * v + 31 * number) % 2048;
}

// The metres of http://openkinect.org/wiki/Imaging_Information are a fit. The reference is the triangulation
// that they fit.
constexpr double kStep_mm = 1.042 / 4, kBase_mm = 75, kReference_mm = 1200;
double triangulated_mm(int shift) {
  return kReference_mm * kBase_mm / (kBase_mm - (shift - 800 - 4 * 0.375) * kStep_mm);
}
int depth_of(int shift) {
  const double z_mm = triangulated_mm(shift);
  return shift >= 2047 || z_mm <= 0 || z_mm >= 10000 ? 0 : static_cast<int>(z_mm);
}

bool shows(const SensorFrame& frame, int number) {
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u)
      if (frame.depth[static_cast<std::size_t>(v * kWidth + u)] != depth_of(shift_at(number, u, v)))
        return false;
  return true;
}

int number_in(const SensorFrame& frame) {
  for (int number = 0; number < kFrames; ++number)
    if (frame.depth[0] == depth_of(shift_at(number, 0, 0))) return number;
  return -1;
}

// Time of a frame. The program fakenect-record writes it into the name of the file, together with the
// sensor's stamp. The stamps overflow before frame 3, and a second passes before the last frame.
double taken_s(int number) {
  return 100 + number / 30.0 + (number == kFrames - 1 ? 1 : 0);
}
void write_recording(const TestFolder& folder) {
  std::string index;
  for (int number = 0; number < kFrames; ++number) {
    const double stamp = std::fmod(kStampPeriod_s - 0.09 + taken_s(number) - 100, kStampPeriod_s) * 60e6;
    char name[64];
    std::snprintf(name, sizeof name, "d-%.6f-%u.pgm", taken_s(number), static_cast<unsigned>(stamp));
    std::string bytes = "P5 640 480 65535\n";
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) bytes += raw(static_cast<std::uint16_t>(shift_at(number, u, v)));
    folder.write(name, bytes);
    index += std::string(name) + "\n";
  }
  folder.write("INDEX.txt", index);
}

// A clock that reports the times at which frames arrive. The adapter reads it once per frame, and fakenect
// skips none, so all frames are as punctual as in the recording.
class ArrivalClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return std::llround(1e9 * taken_s(asked_++)); }
  void sleep_until_ns(std::int64_t) noexcept override {}

 private:
  mutable std::atomic<int> asked_ = 0;
};

class FreenectCamera : public testing::Test {
 protected:
  void SetUp() override {
    const Availability availability = freenect_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
    ASSERT_EQ(availability.detail, "1 Kinect");
  }
};

TEST_F(FreenectCamera, ComputesTheDepths) {
  EXPECT_EQ(depth_of(2047), 0);
  EXPECT_EQ(depth_of(1100), 0);
  // The depths from 0.7 to 1.8 m agree within one step of the shift, to which the readings of a fit are
  // rounded.
  for (int shift = 600; shift <= 900; shift += 50) {
    const double z_mm = triangulated_mm(shift), step_mm = z_mm * z_mm * kStep_mm / (kReference_mm * kBase_mm);
    EXPECT_NEAR(z_mm, 123.6 * std::tan(shift / 2842.5 + 1.1863), step_mm) << shift;
  }
}

// This is one test because fakenect keeps its file open until the program ends, and a second camera continues
// where the first one was closed.
TEST_F(FreenectCamera, PlaysARecording) {
  const TestFolder folder("freenect_camera_test");
  write_recording(folder);
  setenv("FAKENECT_PATH", folder.path().c_str(), 1);

  ArrivalClock arrivals;
  SensorFrame frame;
  {
    const auto closed_early = open_freenect("0", arrivals);
    ASSERT_EQ(closed_early->next(frame, kPatience_s), SensorState::frame);
    EXPECT_TRUE(shows(frame, number_in(frame)));
  }
  int last = number_in(frame);
  const auto source = open_freenect("", arrivals);
  const CameraIntrinsics& camera = source->view().camera;
  EXPECT_EQ(camera.width, kWidth);
  EXPECT_EQ(camera.height, kHeight);
  EXPECT_EQ(camera.fx, 575.8);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_FALSE(source->view().has_colour);  // depth is not registered here

  double last_s = 0;
  int seen = 0, waited = 0;
  SensorState state = SensorState::frame;
  while (state == SensorState::frame || state == SensorState::waiting) {
    state = source->next(frame, 0.01);
    if (state == SensorState::waiting) ++waited;
    if (state != SensorState::frame) continue;
    const int number = number_in(frame);
    EXPECT_GT(number, last);
    EXPECT_TRUE(shows(frame, number)) << number;
    if (seen++ > 0) {
      EXPECT_NEAR(frame.captured_s - last_s, taken_s(number) - taken_s(last), 1e-6);
    }
    last = number, last_s = frame.captured_s;
  }
  EXPECT_EQ(last, kFrames - 1);
  EXPECT_GE(seen, 2);    // a late reader receives the newest
  EXPECT_GE(waited, 1);  // waits for the last frame about a hundred times
  EXPECT_EQ(state, SensorState::failed);
  EXPECT_HAS(source->failure(), "freenect:0: no more frames (error -1 of the library): ");
  EXPECT_HAS(source->failure(), "a recording of fakenect has ended");
  EXPECT_EQ(source->next(frame, kPatience_s), SensorState::failed);
}

TEST_F(FreenectCamera, OtherNumbersAreRefused) {
  EXPECT_HAS(refusal([] { open_freenect("1", steady_clock()); }),
             "freenect:1: 1 Kinects are plugged in, numbered from 0: expected ");
  for (const char* address : {"-1", "x", "0x", " 0", "99999999999"})
    EXPECT_HAS(refusal([&] { open_freenect(address, steady_clock()); }),
               "freenect:" + std::string(address) + ": no camera has this number: expected 0, 1, ...");
}

}  // namespace
}  // namespace remote_touch::freenect_camera_test

int main(int argc, char** argv) {
#ifdef REMOTE_TOUCH_FAKENECT
  remote_touch::start_with_libraries(REMOTE_TOUCH_FAKENECT, argv);
#endif
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
