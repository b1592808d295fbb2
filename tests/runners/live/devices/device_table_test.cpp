#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_clock.h"
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

namespace remote_touch::device_address_test {
namespace {

const std::vector<std::string> kKnown{"rate", "force"};

TEST(DeviceAddress, HasAPathAndSettings) {
  const DeviceAddress address("fd", "0?rate=500&force=vector", kKnown);
  EXPECT_EQ(address.place(), "0");
  EXPECT_EQ(address.refusal("x").what(), std::string("fd:0?rate=500&force=vector: x"));
  EXPECT_EQ(address.number("rate", 1000, 1, 4000), 500);
  EXPECT_EQ(address.choice("force", {"values", "vector"}), "vector");
  EXPECT_EQ(address.word("force", "none"), "vector");
}

TEST(DeviceAddress, MissingSettingsHaveTheirDefaults) {
  const DeviceAddress address("fd", "", kKnown);
  EXPECT_EQ(address.place(), "");
  EXPECT_FALSE(address.has("rate"));
  EXPECT_EQ(address.number("rate", 1000, 1, 4000), 1000);
  EXPECT_EQ(address.choice("force", {"values", "vector"}), "values");
  EXPECT_EQ(address.word("force", "none"), "none");
}

TEST(DeviceAddress, WrongSettingsAreNamed) {
  const auto refused = [](const std::string& written) {
    return refusal([&] { DeviceAddress("fd", written, kKnown).number("rate", 1000, 1, 4000); });
  };
  EXPECT_HAS(refused("0?moon=1"), "fd:0?moon=1: has no setting \"moon\": expected rate, force");
  EXPECT_HAS(refused("0?rate="), "the setting rate has no value; write rate=VALUE");
  EXPECT_HAS(refused("0?rate"), "the setting rate has no value; write rate=VALUE");
  EXPECT_HAS(refused("0?rate=5&rate=6"), "the setting rate is given twice: expected once");
  for (const char* number : {"0.5", "4001", "x", "nan"})
    EXPECT_HAS(refused(std::string("?rate=") + number), "expected a number from 1 to 4000") << number;
}

TEST(DeviceAddress, MessagesBeginWithTheAddressAndOneColon) {
  const auto message = [](const std::string& written) {
    return refusal([&] { throw DeviceAddress("haply", written, kKnown).refusal("no service"); });
  };
  EXPECT_EQ(message(""), "haply: no service");
  EXPECT_EQ(message("ws://127.0.0.1:10001"), "haply:ws://127.0.0.1:10001: no service");
}

}  // namespace
}  // namespace remote_touch::device_address_test

// Connections to a UNIX socket whose queue is full, in the time of the machine.
namespace remote_touch::deadline_socket_test {
namespace {

double now_s() {
  return steady_clock().now_s();
}

// Listens at a path; its queue is full from the start.
class BusyService {
 public:
  explicit BusyService(std::string path)
      : path_(std::move(path)), listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    address_.sun_family = AF_UNIX;
    EXPECT_LT(path_.size(), sizeof address_.sun_path);
    std::memcpy(address_.sun_path, path_.c_str(), path_.size() + 1);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<const sockaddr*>(&address_), sizeof address_), 0);
    EXPECT_EQ(::listen(listener_, 0), 0);
    while (join_queue()) continue;
  }
  ~BusyService() {
    for (const int client : clients_) ::close(client);
    ::close(listener_);
  }
  BusyService(const BusyService&) = delete;
  BusyService& operator=(const BusyService&) = delete;

  const std::string& path() const { return path_; }
  void accept_one() const { ::close(::accept(listener_, nullptr, nullptr)); }

 private:
  bool join_queue() {
    clients_.push_back(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    return clients_.size() < 100 &&
           ::connect(clients_.back(), reinterpret_cast<const sockaddr*>(&address_), sizeof address_) == 0;
  }

  const std::string path_;
  const int listener_;
  sockaddr_un address_{};
  std::vector<int> clients_;
};

TEST(DeadlineSocket, WaitsForRoomInTheQueueOfAService) {
  const TestFolder folder("queue");
  const BusyService service((folder / "s").string());
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    service.accept_one();
  });
  DeadlineSocket socket(steady_clock());
  EXPECT_EQ(socket.connect_to_path(service.path(), now_s() + 60), "");
  later.join();
}

TEST(DeadlineSocket, WaitsForRoomUntilTheDeadline) {
  const TestFolder folder("queue");
  const BusyService service((folder / "s").string());
  DeadlineSocket socket(steady_clock());
  const double start_s = now_s();
  EXPECT_EQ(socket.connect_to_path(service.path(), start_s + 0.05), std::strerror(ETIMEDOUT));
  EXPECT_GE(now_s() - start_s, 0.05);
}

}  // namespace
}  // namespace remote_touch::deadline_socket_test

// The hand of a user with a mouse, compared with the closed form of the spring that it follows.
namespace remote_touch::browser_device_test {
namespace {

constexpr double kRate_hz = 1000;

class BrowserDeviceTest : public testing::Test {
 protected:
  DeviceReading after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(1 / kRate_hz);
      EXPECT_FALSE(device_.read(reading));
    }
    return reading;
  }
  void want(const DeviceState& pose) { request({{start_.position_W, start_.orientation_W, 0}, pose}); }
  void request(const HandMotion& motion) {
    poses_->back() = motion;
    poses_->publish();
  }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  SimulatedClock clock_;
  const DeviceState start_{.position_W = Vec3(0.1, 0.2, 0.3)};
  BrowserDevice device_{poses_, start_, DevicePlacement(LiveSettings{}), kRate_hz, clock_};
};

TEST_F(BrowserDeviceTest, IsAtItsStartUntilItIsMoved) {
  EXPECT_EQ(after(50).position_m, start_.position_W);
}

// x(t) = d (1 - (1 + w t) e^(-w t)), as long as that is slower than the limit. Steps of a millisecond, the
// velocity first, are ahead of it by at most a third of w times the step, 2 % of d.
constexpr double kAhead = BrowserDevice::kNaturalFrequency_rad_per_s * 0.001 / 3;
TEST_F(BrowserDeviceTest, FollowsAsACriticallyDampedSpringWould) {
  const double d = 0.004, w = BrowserDevice::kNaturalFrequency_rad_per_s;
  after(1);
  want({start_.position_W + Vec3(0, d, 0)});
  for (int ms = 1; ms <= 200; ++ms) {
    const double t = 1e-3 * ms, expected = d * (1 - (1 + w * t) * std::exp(-w * t));
    EXPECT_NEAR(after(1).position_m.y() - start_.position_W.y(), expected, kAhead * d) << ms << " ms";
  }
  EXPECT_NEAR(after(300).position_m.y(), start_.position_W.y() + d, 1e-9);
}

TEST_F(BrowserDeviceTest, IsNeverFasterThanItsLimits) {
  after(1);
  DeviceState far{start_.position_W + Vec3(1, 0, 0)};
  far.orientation_W = Eigen::AngleAxisd(3, Vec3::UnitZ());
  want(far);
  DeviceReading before = after(1);
  double fastest = 0, turning = 0;
  for (int i = 0; i < 1000; ++i) {
    const DeviceReading now = after(1);
    fastest = std::max(fastest, (now.position_m - before.position_m).norm() * kRate_hz);
    EXPECT_NEAR((now.position_m - before.position_m).norm() * kRate_hz, now.velocity_m_per_s.norm(), 1e-6);
    turning = std::max(turning, now.orientation.angularDistance(before.orientation) * kRate_hz);
    before = now;
  }
  EXPECT_NEAR(fastest, BrowserDevice::kMaxSpeed_m_per_s, 1e-6);
  EXPECT_NEAR(turning, BrowserDevice::kMaxTurning_rad_per_s, 1e-3);
  EXPECT_LT(fastest, 0.9 * SafetyLimits{}.max_speed_m_per_s) << "the safety gate does not mind";
}

TEST_F(BrowserDeviceTest, TurnsToThePoseAndReportsTheButtons) {
  DeviceState turned{start_.position_W};
  turned.orientation_W = Eigen::AngleAxisd(0.5, Vec3(1, 2, 2) / 3);
  turned.buttons = 3;
  want(turned);
  EXPECT_EQ(after(1).buttons, 3u);
  EXPECT_NEAR(after(1000).orientation.angularDistance(turned.orientation_W), 0, 1e-8);
}

// The stop and the first motion after it may reach the loop together.
TEST_F(BrowserDeviceTest, ANewStopHoldsTheHandWhereThatTickHasIt) {
  after(1);
  want({start_.position_W + Vec3(1, 0, 0)});
  const Vec3 there = after(300).position_m;
  request({{}, {Vec3(0, 0.01, 0)}, 1});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.01, 0)).norm(), 0, 1e-9);
  request({{}, {Vec3(0, 0.03, 0)}, 1});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.03, 0)).norm(), 0, 1e-9) << "the same stop";
}

TEST_F(BrowserDeviceTest, AStopTakesTheSpeedAway) {
  after(1);
  want({start_.position_W + Vec3(1, 0, 0)});
  const Vec3 there = after(300).position_m;
  request({{}, {}, 1});
  for (int i = 0; i < 50; ++i) EXPECT_NEAR((after(1).position_m - there).norm(), 0, 1e-12) << i;
}

// A loop that missed ticks finds the hand where it would be by then.
TEST_F(BrowserDeviceTest, MovesOnWhileTicksAreMissed) {
  after(1);
  want({start_.position_W + Vec3(0, 0.004, 0)});
  clock_.sleep_s(0.03);
  DeviceReading reading;
  device_.read(reading);
  const double t = 0.03, w = BrowserDevice::kNaturalFrequency_rad_per_s;
  EXPECT_NEAR(reading.position_m.y() - 0.2, 0.004 * (1 - (1 + w * t) * std::exp(-w * t)), kAhead * 0.004);
}

}  // namespace
}  // namespace remote_touch::browser_device_test
