// The adapter on the real run-time library of OpenNI 2, its recorder and its player. Only the camera is a
// double: a driver (tests/doubles/virtual_openni2) that the library loads like any other.
#include "runners/live/sensors/depth_source.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <latch>
#include <thread>
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
#include <OpenNI.h>
#endif

#include "runners/live/devices/clock.h"
#include "tests/doubles/virtual_openni2/virtual_camera.h"
#include "tests/support/start_with_libraries.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::openni2_camera_test {
namespace {

namespace fs = std::filesystem;
using namespace virtual_camera;

void set_camera(const char* words) {
  setenv("VIRTUAL_CAMERA", words, 1);
}

class Openni2Camera : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("VIRTUAL_CAMERA");
    const Availability availability = openni2_availability();
    if (!availability.compiled_in) GTEST_SKIP() << availability.detail;
    ASSERT_EQ(availability.detail, "Virtual camera (virtual-camera)");
  }
  void TearDown() override { unsetenv("VIRTUAL_CAMERA"); }
};

int number_in(const SensorFrame& frame) {
  return frame.depth.empty() ? -1 : frame.depth[0];
}

// Images are compared as a whole, because the message of a mismatch would be long. A frame may lack its
// colour if the reader came between colour and depth of a later one.
void expect_pattern(const SensorFrame& frame) {
  EXPECT_TRUE(frame.depth == depth_image(number_in(frame))) << "depth of frame " << number_in(frame);
  if (frame.colour.empty()) return;
  const int colour_number = static_cast<int>(frame.colour[0]);
  EXPECT_LE(std::abs(colour_number - number_in(frame)), 1);
  EXPECT_TRUE(frame.colour == colour_image(colour_number)) << "colour of frame " << colour_number;
}

// Takes frames until there are no more or the wanted number is reached. Each must be later than the one
// before.
SensorState take(DepthSource& source, int max, std::vector<SensorFrame>& frames) {
  while (static_cast<int>(frames.size()) < max) {
    SensorFrame frame;
    const SensorState state = source.next(frame, kPatience_s);
    if (state != SensorState::frame) return state;
    EXPECT_LE(frame.captured_s, steady_clock().now_s());
    if (!frames.empty()) {
      EXPECT_GT(frame.number, frames.back().number);
      EXPECT_GT(frame.captured_s, frames.back().captured_s);
    }
    frames.push_back(frame);
  }
  return SensorState::frame;
}

void expect_camera(const CameraIntrinsics& camera, double across_rad, double down_rad) {
  EXPECT_EQ(camera.width, kWidth);
  EXPECT_EQ(camera.height, kHeight);
  EXPECT_NEAR(camera.fx, kWidth / 2 / std::tan(across_rad / 2), 1e-4);
  EXPECT_NEAR(camera.fy, kHeight / 2 / std::tan(down_rad / 2), 1e-4);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
}

TEST_F(Openni2Camera, ShowsWhatTheCameraSees) {
  for (const char* address : {"any", "", "virtual-camera"}) {
    const double opened_s = steady_clock().now_s();
    const auto source = open_openni2(address, steady_clock());
    expect_camera(source->view().camera, kColourAcross_rad, kColourDown_rad);
    EXPECT_EQ(source->view().metres_per_unit, 0.001);
    EXPECT_EQ(source->view().frame_rate_hz, 30);
    EXPECT_TRUE(source->view().has_colour);
    std::vector<SensorFrame> frames;
    ASSERT_EQ(take(*source, 20, frames), SensorState::frame) << source->failure();
    int without_colour = 0;
    for (const SensorFrame& frame : frames) {
      EXPECT_EQ(frame.number, number_in(frame));
      expect_pattern(frame);
      if (frame.colour.empty()) ++without_colour;
      // The camera sends frame n no earlier, and take() has compared with the arrival.
      EXPECT_GT(frame.captured_s, opened_s + frame.number / 30.0 - 1e-3);
    }
    EXPECT_LT(without_colour, 20);  // CameraThatSendsNothingMore has a frame that must have its colour
    // The stamps are as even as the sensor's, apart from frames before the first punctual one, which seem too
    // late.
    const SensorFrame &a = frames[18], &b = frames[19];
    EXPECT_LT(b.captured_s - a.captured_s, (b.number - a.number) / 30.0 + 1e-3);
  }
}

// A mirrored image is turned round, and there is no colour if depth is not registered to it.
TEST_F(Openni2Camera, ShowsAlsoMirroredAndUnregisteredImages) {
  for (const std::string words : {"stays_mirrored", "unregistered"}) {
    set_camera(words.c_str());
    const auto source = open_openni2("any", steady_clock());
    EXPECT_EQ(source->view().has_colour, words == "stays_mirrored");
    if (words == "unregistered") expect_camera(source->view().camera, kDepthAcross_rad, kDepthDown_rad);
    std::vector<SensorFrame> frames;
    ASSERT_EQ(take(*source, 5, frames), SensorState::frame) << source->failure();
    for (const SensorFrame& frame : frames) {
      expect_pattern(frame);
      EXPECT_TRUE(frame.colour.empty() || words == "stays_mirrored");
    }
  }
}

// A reader that comes late finds the newest frame, not the oldest.
TEST_F(Openni2Camera, LateReaderGetsTheNewestFrame) {
  const auto source = open_openni2("any", steady_clock());
  std::vector<SensorFrame> frames;
  ASSERT_EQ(take(*source, 3, frames), SensorState::frame);
  ASSERT_TRUE(wait_until([&] { return sent_frames() >= frames[2].number + 12; }));
  ASSERT_EQ(take(*source, 4, frames), SensorState::frame);
  EXPECT_GE(frames[3].number, frames[2].number + 12);
  expect_pattern(frames[3]);
}

TEST_F(Openni2Camera, ACameraThatStopsSendingTimesOut) {
  set_camera("stop_after=20");
  const auto source = open_openni2("any", steady_clock());
  ASSERT_TRUE(wait_until([] { return sent_frames() == 20; }));
  SensorFrame frame;
  ASSERT_EQ(source->next(frame, kPatience_s), SensorState::frame) << source->failure();
  EXPECT_EQ(number_in(frame), 20);
  EXPECT_FALSE(frame.colour.empty());
  expect_pattern(frame);
  const double start_s = steady_clock().now_s();
  EXPECT_EQ(source->next(frame, 0.3), SensorState::waiting);
  EXPECT_GE(steady_clock().now_s() - start_s, 0.29);
  EXPECT_EQ(source->next(frame, 0), SensorState::waiting);
  EXPECT_EQ(source->failure(), "");
}

TEST_F(Openni2Camera, AnUnpluggedCameraIsReported) {
  const auto source = open_openni2("any", steady_clock());
  std::vector<SensorFrame> frames;
  ASSERT_EQ(take(*source, 5, frames), SensorState::frame) << source->failure();
  unplug();
  EXPECT_EQ(take(*source, 100, frames), SensorState::failed);  // reported, not timed out
  EXPECT_EQ(source->failure(), "openni2: was disconnected");
  SensorFrame frame;
  EXPECT_EQ(source->next(frame, kPatience_s), SensorState::failed);
}

TEST_F(Openni2Camera, AFrameOfAnotherSizeIsRefused) {
  set_camera("small_after=20");
  const auto source = open_openni2("any", steady_clock());
  std::vector<SensorFrame> frames;
  EXPECT_EQ(take(*source, 100, frames), SensorState::failed);
  EXPECT_LE(frames.size(), 20u);
  EXPECT_HAS(source->failure(), " is 640 x 240 pixels in 307200 bytes: expected those of the camera's mode");
}

// The library remembers every thread that ever called it, and crashes if the memory of one that has ended was
// freed. The system keeps the stacks of about five threads that have ended; those of more are freed.
TEST_F(Openni2Camera, MayBeUsedByThreadsThatEnd) {
  for (int i = 0; i < 4; ++i) {
    const auto source = open_openni2("any", steady_clock());
    std::vector<SensorFrame> frames;
    std::jthread([&] {
      EXPECT_EQ(take(*source, 3, frames), SensorState::frame) << source->failure();
    }).join();
    std::latch all_have_begun(17);
    std::vector<std::jthread> others;
    for (int k = 0; k < 16; ++k) others.emplace_back([&] { all_have_begun.arrive_and_wait(); });
    all_have_begun.arrive_and_wait();
  }
}

TEST_F(Openni2Camera, AbsentCamerasAreRefused) {
  const auto refused = [](const std::string& address) {
    return refusal([&] { open_openni2(address, steady_clock()); });
  };
  for (const std::string address : {"1d27/0601@1/5", "Dummy", "missing.oni", "/tmp"})
    EXPECT_HAS(refused(address), address + ": neither a file nor a camera that a driver in ");
  EXPECT_HAS(refused("Dummy"), "/OpenNI2/Drivers knows: expected any, virtual-camera");
  set_camera("absent");
  EXPECT_FALSE(openni2_availability().found);
  EXPECT_HAS(openni2_availability().detail, "no camera that a driver in ");
  EXPECT_HAS(refused("any"), "openni2: no camera that a driver in ");
  EXPECT_HAS(refused("any"), "/OpenNI2/Drivers knows: expected one that is plugged in");
}

// Records depth of the virtual camera with the library's own recorder until so many frames were seen,
// mirrored as the camera is at first. Returns true if it succeeds.
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
bool record(const std::string& file, int frames) {
  const auto is_ok = [](openni::Status status) { return status == openni::STATUS_OK; };
  openni::Device device;
  openni::VideoStream depth;
  openni::VideoMode mode;
  openni::Recorder recorder;
  mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
  mode.setResolution(kWidth, kHeight), mode.setFps(kRate_hz);
  bool is_good = is_ok(device.open("virtual-camera")) && is_ok(depth.create(device, openni::SENSOR_DEPTH)) &&
                 is_ok(depth.setVideoMode(mode)) && is_ok(recorder.create(file.c_str())) &&
                 is_ok(recorder.attach(depth)) && is_ok(recorder.start()) && is_ok(depth.start());
  for (int i = 0; i < frames && is_good; ++i) {
    openni::VideoFrameRef frame;
    is_good = is_ok(depth.readFrame(&frame));
  }
  // The stream stops first, because the library's recorder and a frame that comes while it ends can wait for
  // each other for ever.
  depth.stop();
  recorder.stop();
  return is_good;
}
bool has_recorded(const std::string& file) {
  if (openni::OpenNI::initialize() != openni::STATUS_OK) return false;
  const bool is_good = record(file, 20);
  openni::OpenNI::shutdown();
  return is_good;
}
#else
bool has_recorded(const std::string&) {
  return false;
}
#endif

class Openni2Recording : public Openni2Camera {
 protected:
  void SetUp() override {
    Openni2Camera::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    file_ = (folder_ / "recorded.oni").string();
    ASSERT_TRUE(has_recorded(file_));
  }

  TestFolder folder_{"openni2_camera_test"};
  std::string file_;
};

// The camera shows a mirrored image until the mirroring is turned off, and the recorder does not turn it off.
TEST_F(Openni2Recording, PlaysWhatWasRecordedOnce) {
  const double start_s = steady_clock().now_s();
  const auto source = open_openni2(file_, steady_clock());
  EXPECT_FALSE(source->view().has_colour);
  expect_camera(source->view().camera, kDepthAcross_rad, kDepthDown_rad);
  std::vector<SensorFrame> frames;
  EXPECT_EQ(take(*source, 100, frames), SensorState::ended) << source->failure();
  // The recorder may lose frames at both ends, and a slow machine some on the way.
  ASSERT_GE(frames.size(), 8u);
  EXPECT_LE(frames.front().number, 5);
  EXPECT_GE(frames.back().number, 15);
  EXPECT_GT(steady_clock().now_s() - start_s, 0.8 * (frames.back().number - 1) / kRate_hz);
  for (const SensorFrame& frame : frames) {
    expect_pattern(frame);
    EXPECT_TRUE(frame.colour.empty());
    EXPECT_GE(number_in(frame), frame.number);  // the recorder counts from 1
  }
  SensorFrame frame;
  EXPECT_EQ(source->next(frame, kPatience_s), SensorState::ended);
}

TEST_F(Openni2Recording, IsNoCamera) {
  const auto source = open_openni2(file_, steady_clock());
  EXPECT_EQ(openni2_availability().detail, "Virtual camera (virtual-camera)");
  set_camera("absent");
  EXPECT_HAS(refusal([] { open_openni2("missing", steady_clock()); }),
             "missing: neither a file nor a camera");
}

TEST_F(Openni2Recording, CanBeClosedInTheMiddle) {
  for (int i = 0; i < 10; ++i) {
    const auto source = open_openni2(file_, steady_clock());
    std::vector<SensorFrame> frames;
    ASSERT_EQ(take(*source, i % 4, frames), SensorState::frame) << source->failure();
  }
}

TEST_F(Openni2Recording, DamagedFilesAreRefused) {
  const std::string whole = bytes_of(file_);
  std::string garbage(100000, ' ');
  for (std::size_t i = 0; i < garbage.size(); ++i) garbage[i] = static_cast<char>(i * i / 7);
  // The recorder leaves zeros behind its last record, so more than half must be removed.
  for (const std::string& bytes :
       {std::string(), std::string("NI10"), garbage, whole.substr(0, 4) + garbage, whole.substr(0, 100),
        whole.substr(0, 1000), whole.substr(0, whole.size() / 3)}) {
    const std::string file = folder_.write("damaged.oni", bytes).string();
    const std::string message = refusal([&] { open_openni2(file, steady_clock()); });
    EXPECT_HAS(message, file + ": ");
    EXPECT_HAS(message, "expected ") << bytes.size() << " bytes";
  }
}

// Plays the recording in a process of its own, prints why it ended, and closes it.
[[noreturn]] void play_zeroed_frames(const std::string& file) {
  auto source = open_openni2(file, steady_clock());
  std::vector<SensorFrame> frames;
  const bool has_failed = take(*source, 100, frames) == SensorState::failed;
  if (has_failed && frames.size() <= 1 && !testing::Test::HasFailure())
    std::fputs(source->failure().c_str(), stderr);
  std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would end the process in another way
  fs::remove_all(fs::path(file).parent_path());
  source.reset();
  ::_exit(0);
}

// The library frees a stream that is closed while the thread of its player may still search for it in the
// list of streams. That thread searches all the time here, and about one close in a hundred on a busy machine
// crashes in libOniFile.
bool has_ended_or_crashed_at_the_close(int status) {
  return testing::ExitedWithCode(0)(status) || testing::KilledBySignal(SIGSEGV)(status);
}

// The player itself would search for the next frame for ever, or begin anew.
TEST_F(Openni2Recording, ZeroedFramesEndThePlayback) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::string bytes = bytes_of(file_);
  const std::size_t table = bytes.rfind(std::string("NIR\0\x0e", 5));  // the table of where each frame begins
  ASSERT_NE(table, std::string::npos);
  std::fill(bytes.begin() + 5000, bytes.begin() + static_cast<std::ptrdiff_t>(table), '\0');
  const std::string file = folder_.write("zeroed.oni", bytes).string();
  EXPECT_EXIT(play_zeroed_frames(file), has_ended_or_crashed_at_the_close,
              "zeroed.oni: cannot be played beyond frame ");
}

}  // namespace
}  // namespace remote_touch::openni2_camera_test

#ifdef __SANITIZE_ADDRESS__
// The library and its player leak. Drivers are unloaded before the leak check, so they are kept loaded to be
// recognised by their names.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOpenNI2.so\nleak:libOniFile.so\n";
}
void keep_drivers(const std::string& folder) {
  for (const auto& driver : std::filesystem::directory_iterator(folder + "/OpenNI2/Drivers"))
    dlopen(driver.path().c_str(), RTLD_LAZY | RTLD_NODELETE);
}
#else
void keep_drivers(const std::string&) {}
#endif

int main(int argc, char** argv) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  remote_touch::start_with_libraries(REMOTE_TOUCH_VIRTUAL_OPENNI2, argv);
  keep_drivers(REMOTE_TOUCH_VIRTUAL_OPENNI2);
#endif
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
