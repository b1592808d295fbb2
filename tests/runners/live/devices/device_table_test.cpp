#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>

#include "core/parameters/input_error.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::device_table_test {
namespace {

// Its trajectory looks at the newest frame of its scenario in every tick.
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

struct Positions final : DeviceCycle {
  explicit Positions(HapticDevice& opened) : device(opened) {}
  bool tick() noexcept override {
    DeviceReading reading;
    device.read(reading);
    device.write({});
    list.push_back(reading.position_m);
    return list.size() < 300;
  }
  HapticDevice& device;
  std::vector<Vec3> list;
};

// The scenario lives as long as the device.
TEST_F(DeviceTable, TheSimulatedHandFollowsATrajectoryThatLooksAtFrames) {
  const auto device = open("sim:");
  Positions positions(*device);
  device->run(positions);
  for (std::size_t i = 0; i < positions.list.size(); ++i)
    EXPECT_EQ(positions.list[i], script_->at(static_cast<double>(i + 1) / 1000).position_W) << "tick " << i;
}

TEST_F(DeviceTable, TheMouseBeginsWhereTheExperimentDoes) {
  DeviceReading reading;
  open("browser:", std::make_shared<HandPoses>())->read(reading);
  EXPECT_EQ(reading.position_m, script_->at(0).position_W);
}

TEST_F(DeviceTable, TheMouseNeedsAPage) {
  EXPECT_HAS(refusal([&] { open("browser:"); }), "expected with --view");
  EXPECT_HAS(refusal([&] { open("browser:x", std::make_shared<HandPoses>()); }), "expected browser:");
}

}  // namespace
}  // namespace remote_touch::device_table_test
