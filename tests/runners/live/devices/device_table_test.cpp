// The parts that the table of devices and its adapters share: addresses, connections, and devices without
// hardware; and the presets of devices.
#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::device_table_test {
namespace {

TEST(DeviceTable, TheMouseNeedsAPageAndBeginsWhereTheExperimentDoes) {
  const Experiment experiment = Experiment::from_json(R"({
      "scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "waypoints", "waypoints": [[0.1, 0.2, 0.3, 0]]}})",
                                                      "test");
  SimulatedClock clock;
  const auto open = [&](const std::string& uri, std::shared_ptr<HandPoses> poses = nullptr) {
    return open_device(uri, {experiment, scenes::kernels(), clock, std::move(poses)});
  };
  EXPECT_HAS(refusal([&] { open("browser:"); }), "expected the option --view");
  EXPECT_HAS(refusal([&] { open("browser:x", std::make_shared<HandPoses>()); }), "expected browser:");
  DeviceReading reading;
  open("browser:", std::make_shared<HandPoses>())->read(reading);
  EXPECT_EQ(reading.position_m, Vec3(0.1, 0.2, 0.3));
}

const std::vector<std::string> kKnown{"rate", "force"};

TEST(DeviceAddress, HasAPathAndSettingsOrTheirDefaults) {
  const DeviceAddress address("fd", "0?rate=500&force=vector", kKnown), plain("fd", "", kKnown);
  EXPECT_EQ(address.place(), "0");
  EXPECT_EQ(plain.place(), "");
  EXPECT_FALSE(plain.has("rate"));
  EXPECT_EQ(address.number("rate", 1000, 1, 4000), 500);
  EXPECT_EQ(plain.number("rate", 1000, 1, 4000), 1000);
  EXPECT_EQ(address.choice("force", {"values", "vector"}), "vector");
  EXPECT_EQ(plain.choice("force", {"values", "vector"}), "values");
  EXPECT_EQ(address.word("force", "none"), "vector");
  EXPECT_EQ(plain.word("force", "none"), "none");
  EXPECT_EQ(address.refusal("x").what(), std::string("fd:0?rate=500&force=vector: x"));
  EXPECT_EQ(plain.refusal("x").what(), std::string("fd: x")) << "one colon";
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

// Connections to a UNIX socket whose queue is full, in the time of the machine.

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

TEST(DeadlineSocket, WaitsForRoomInTheQueueOfAServiceUntilTheDeadline) {
  const TestFolder folder("queue");
  const BusyService service((folder / "s").string());
  DeadlineSocket socket(steady_clock());
  const double start_s = now_s();
  EXPECT_EQ(socket.connect_to_path(service.path(), start_s + 0.05), std::strerror(ETIMEDOUT));
  EXPECT_GE(now_s() - start_s, 0.05);
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    service.accept_one();
  });
  EXPECT_EQ(socket.connect_to_path(service.path(), now_s() + 60), "");
  later.join();
}

// The hand of a user with a mouse, compared with the closed form of the spring that it follows.

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

// The stop and the first motion after it may reach the loop together.
TEST_F(BrowserDeviceTest, ANewStopHoldsTheHandWhereThatTickHasIt) {
  after(1);
  want({start_.position_W + Vec3(1, 0, 0)});
  const Vec3 there = after(300).position_m;
  request({{}, {}, 1});
  for (int i = 0; i < 50; ++i)
    EXPECT_NEAR((after(1).position_m - there).norm(), 0, 1e-12) << i << ": it had a speed";
  request({{}, {Vec3(0, 0.01, 0)}, 2});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.01, 0)).norm(), 0, 1e-9);
  request({{}, {Vec3(0, 0.03, 0)}, 2});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.03, 0)).norm(), 0, 1e-9) << "the same stop";
}

// The pages are limited to 20 m of motion.
TEST_F(BrowserDeviceTest, NoPoseIsBeyondTheLimitOfPages) {
  request({{Vec3(-10, 0, 0)}, {Vec3(10, 0, 0)}});
  EXPECT_NEAR(after(12000).position_m.x(), kMaxHandDistance_m, 1e-9);
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

// The presets of data/devices: experiments with the limits of a haptic device.

const std::filesystem::path kRoot = REMOTE_TOUCH_SOURCE_DIR;

// The device's limits, as its page states them. half_width_m: of a box inside the workspace. No force: an
// input device.
struct Preset {
  const char* name;
  const char* page;
  Vec3 half_width_m;
  double max_force_N, max_stiffness_N_per_m;
};
const Preset kPresets[] = {
    {"falcon", "force_dimension", {0.051, 0.051, 0.051}, 8.9, 3000},
    {"inverse3", "haply", {0.23, 0.255, 0.115}, 4, 1000},
    {"omega", "force_dimension", {0.043, 0.043, 0.043}, 12, 5000},  // the cube in a ball of 75 mm radius
    {"spacemouse", "spacemouse", {0.15, 0.15, 0.15}, 0, 0},
    {"touch", "touch", {0.08, 0.06, 0.035}, 3.3, 400},
};

std::string file_of(const Preset& preset) {
  return std::string("data/devices/") + preset.name + ".json";
}

Experiment load(const Preset& preset, const std::vector<std::string>& overrides = {}) {
  return Experiment::load((kRoot / file_of(preset)).string(), overrides);
}

TEST(DevicePresets, AreOneFileForEachDeviceAndAPageNamesIt) {
  std::set<std::string> files, known;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "data/devices"))
    files.insert("data/devices/" + entry.path().filename().string());
  for (const Preset& preset : kPresets) {
    known.insert(file_of(preset));
    std::ifstream page(kRoot / "runners/live/hardware" / (std::string(preset.page) + ".md"));
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    EXPECT_NE(text.find(file_of(preset)), std::string::npos) << preset.name;
  }
  EXPECT_EQ(files, known);
}

// The hand of a run yields to the force, so it is not where the trajectory is. Fewer pixels make the run
// short.
TEST(DevicePresets, KeepTheHandOfARunInTheWorkspace) {
  for (const Preset& preset : kPresets) {
    const Experiment experiment =
        load(preset, {"scenario.width=160", "scenario.height=120", "scenario.focal_px=131"});
    const DevicePlacement placement(experiment.live());
    const auto expect_in_workspace = [&](const Vec3& p_W) {
      const Vec3 p_D = placement.of_device({.position_W = p_W}).position_m;
      EXPECT_TRUE((p_D.cwiseAbs().array() <= preset.half_width_m.array()).all())
          << preset.name << ": " << p_D.transpose();
    };
    const Trace trace = simulate(experiment);
    double yields_m = 0;
    for (std::size_t i = 0; i < trace.length(); ++i) {
      expect_in_workspace(trace.hip_position_m[i]), expect_in_workspace(trace.intended_position_m[i]);
      yields_m = std::max(yields_m, (trace.hip_position_m[i] - trace.intended_position_m[i]).norm());
    }
    EXPECT_EQ(yields_m > 0.001, preset.max_force_N > 0) << preset.name << " yields by " << yields_m << " m";
    const auto scenario = experiment.build_scenario(scenes::kernels());
    EXPECT_LE(experiment.build_trajectory(*scenario)->duration_s(), experiment.settings().duration_s)
        << preset.name;
  }
}

TEST(DevicePresets, AStiffnessThatIsNoneDoesNotSwitchTheScalingOff) {
  EXPECT_EQ(force_scale(2400, 1, 600), 0.25);
  EXPECT_EQ(force_scale(300, 2, 600), 1);
  EXPECT_EQ(force_scale(1e6, 1, 0), 1) << "the limit of the device is not known";
  for (const double none : {std::nan(""), -1.0, HUGE_VAL})
    for (const std::array<double, 3>& a :
         {std::array{none, 1.0, 600.0}, std::array{2400.0, none, 600.0}, std::array{2400.0, 1.0, none}})
      EXPECT_HAS(refusal([&] { force_scale(a[0], a[1], a[2]); }), "expected a finite number, 0 or more");
}

TEST(DevicePresets, AskForNoMoreThanTheDeviceCanExert) {
  for (const Preset& preset : kPresets) {
    const Experiment experiment = load(preset);
    const auto device = [&](const std::string& name) { return experiment.value_at_start("device." + name); };
    EXPECT_EQ(device("max_force_N").get<double>(), preset.max_force_N) << preset.name;
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_EQ(device(std::string("force_") + axis).get<bool>(), preset.max_force_N > 0) << preset.name;
      EXPECT_FALSE(device(std::string("torque_") + axis).get<bool>()) << preset.name;
    }
    if (preset.max_force_N == 0) continue;
    EXPECT_LE(experiment.safety().max_force_N, 0.9 * preset.max_force_N) << preset.name;
    EXPECT_LE(experiment.max_stiffness_N_per_m() * experiment.live().device_scale,
              preset.max_stiffness_N_per_m)
        << preset.name;
  }
}

}  // namespace
}  // namespace remote_touch::device_table_test
