#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>

#include "core/parameters/parameter.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::device_table_test {
namespace {

// Its trajectory reads the newest frame of its scenario in every tick.
constexpr const char* kPressInTheImage = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "image-press", "row": 60, "column": 80, "depth_m": 0.01}})";

class DeviceTable : public testing::Test {
 protected:
  std::unique_ptr<HapticDevice> open(const std::string& uri, std::shared_ptr<HandPoses> poses = nullptr) {
    return open_device(uri, {experiment_, scenes::kernels(), clock_, std::move(poses)});
  }
  const Experiment experiment_ = Experiment::from_json(kPressInTheImage, "a test");
  const std::unique_ptr<Scenario> scenario_ = experiment_.build_scenario(scenes::kernels());
  const std::unique_ptr<Trajectory> script_ = experiment_.build_trajectory(*scenario_);
  SimulatedClock clock_;
};

// The scenario lives as long as the device.
TEST_F(DeviceTable, TheSimulatedHandFollowsATrajectoryThatReadsFrames) {
  const auto device = open("sim:");
  run_ticks(*device, 300, [&](int i) {
    DeviceReading reading;
    device->read(reading);
    device->write({});
    EXPECT_EQ(reading.position_m, script_->at((i + 1) / 1000.0).position_W) << "tick " << i;
  });
}

// The fourth image has another size. read() does not throw: that would end the program.
TEST_F(DeviceTable, ATrajectoryThatCannotUseAFrameIsAFault) {
  const TestFolder folder("size_changes");
  folder.write("camera.json", R"({"width": 160, "height": 120, "fx": 150, "fy": 150, "cx": 79.5, "cy": 59.5,
    "depth_scale_m": 0.001, "frame_rate_hz": 30})");
  for (int i = 0; i < 6; ++i) {
    const int width = i == 3 ? 80 : 160;
    const std::vector<std::uint16_t> samples(static_cast<std::size_t>(width) * 120, 500);
    folder.write_png("depth/" + std::to_string(i) + ".png", width, 120, PNG_FORMAT_LINEAR_Y, samples.data());
  }
  const Experiment press = Experiment::from_json(
      R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
          R"("}, "renderer": {"name": "proxy"}, "trajectory": {"name": "image-press"}, "duration_s": 0.2})",
      "a test");
  const auto device = open_device("sim:", {press, scenes::kernels(), clock_, nullptr});
  DeviceFault fault;
  int ticks = 0;
  const DeviceTick tick = [&] {
    DeviceReading reading;
    fault = device->read(reading);
    return ++ticks < 1000 && !fault;
  };
  EXPECT_HAS(refusal([&] { device->run(tick); }), "depth/3.png");
  EXPECT_EQ(ticks, 100) << "the first tick is 1 ms, and frame 3 is captured at 0.1 s";
  ASSERT_TRUE(fault);
  EXPECT_HAS(fault.what, "80 x 120 pixels");
}

TEST_F(DeviceTable, TheMouseBeginsWhereTheExperimentDoes) {
  DeviceReading reading;
  open("browser:", std::make_shared<HandPoses>())->read(reading);
  EXPECT_EQ(reading.position_m, script_->at(0).position_W);
}

TEST_F(DeviceTable, TheMouseNeedsAPage) {
  EXPECT_HAS(refusal([&] { open("browser:"); }), "expected the option --view");
  EXPECT_HAS(refusal([&] { open("browser:x", std::make_shared<HandPoses>()); }), "expected browser:");
}

}  // namespace
}  // namespace remote_touch::device_table_test
