// The adapter of spacenavd: against a socket of the test's own on a simulated clock, and against the stock
// daemon with a simulated serial mouse (tests/doubles/spacenav_daemon.h).
#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/doubles/spacenav_daemon.h"
#include "tests/doubles/spacenav_socket.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::spacenav_test {
namespace {

constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();

class Spacenav : public testing::Test {
 protected:
  Spacenav() : folder_("spacenav_test"), path_((folder_ / "sock").string()), server_(path_) {}

  std::unique_ptr<HapticDevice> open(const std::string& settings = "") {
    auto device = open_spacenav(path_ + settings, clock_);
    server_.accept();
    return device;
  }
  // Reads the device after a sleep of after_s.
  DeviceReading read(HapticDevice& device, double after_s) {
    clock_.sleep_s(after_s);
    DeviceReading reading;
    const DeviceFault fault = device.read(reading);
    EXPECT_FALSE(fault) << fault.what;
    return reading;
  }
  // Reads the device every millisecond and returns the last reading.
  DeviceReading read_for(HapticDevice& device, int ms) {
    DeviceReading reading;
    for (int i = 0; i < ms; ++i) reading = read(device, 1e-3);
    return reading;
  }

  SimulatedClock clock_;

  const TestFolder folder_;
  const std::string path_;
  SpacenavSocket server_;
};

TEST_F(Spacenav, IsInputOnly) {
  const auto device = open();
  EXPECT_EQ(device->traits().sensed_axes, 6);
  EXPECT_EQ(device->traits().actuated_axes, 0);
  EXPECT_EQ(device->traits().max_force_N, 0);
  EXPECT_FALSE(device->write({Vec3(1, 2, 3), Vec3::Zero()}));
  device->release();
  DeviceReading reading;
  EXPECT_FALSE(device->read(reading));
  EXPECT_TRUE(reading.position_m.isZero());
  EXPECT_TRUE(reading.orientation.isApprox(Eigen::Quaterniond::Identity()));
}

// Deflections become speeds in the device's axes: the daemon's z points away from the user.
TEST_F(Spacenav, ConvertsAxesAndUnits) {
  const auto device = open("?speed=1e-3&turning=2e-3&box=10");
  server_.send({0, 100, 200, 300, 0, 0, 0, 16});
  const DeviceReading moved = read_for(*device, 50);
  EXPECT_TRUE(moved.velocity_m_per_s.isApprox(Vec3(0.1, 0.2, -0.3), 1e-9));
  EXPECT_TRUE(moved.position_m.normalized().isApprox(Vec3(1, 2, -3).normalized(), 1e-9));
  EXPECT_TRUE(moved.angular_velocity_rad_per_s.isZero());
  server_.send({0, 0, 0, 0, 100, 200, 300, 16});
  const DeviceReading turned = read_for(*device, 50);
  EXPECT_TRUE(turned.angular_velocity_rad_per_s.isApprox(Vec3(0.2, 0.4, -0.6), 1e-9));
  const Eigen::AngleAxisd rotation(turned.orientation);
  EXPECT_TRUE(rotation.axis().isApprox(Vec3(1, 2, -3).normalized(), 1e-9));
  EXPECT_TRUE(turned.velocity_m_per_s.isZero());
}

TEST_F(Spacenav, TheDisplacementIsSpeedTimesTime) {
  const auto device = open("?speed=1e-3&box=10");
  server_.send({0, 100, 0, 0, 0, 0, 0, 16});
  EXPECT_NEAR(read_for(*device, 200).position_m.x(), 0.1 * 0.2, 1e-12);
}

TEST_F(Spacenav, StaysInTheBoxOfTheWorkspace) {
  const auto device = open("?speed=0.1&box=0.02");
  for (const std::int32_t count : {kMax, kMin}) {
    server_.send({0, count, count, count, count, count, count, 16});
    const DeviceReading reading = read_for(*device, 20);
    const double at = count > 0 ? 0.02 : -0.02;
    EXPECT_TRUE(reading.position_m.isApprox(Vec3(at, at, -at), 1e-12)) << reading.position_m.transpose();
    EXPECT_TRUE(reading.velocity_m_per_s.isZero());
    EXPECT_NEAR(reading.orientation.norm(), 1, 1e-9);
  }
}

// A deflection counts for half a second.
TEST_F(Spacenav, ADeflectionThatIsNotSentAgainEnds) {
  const auto device = open("?speed=1e-3&box=10");
  server_.send({0, 100, 0, 0, 0, 0, 0, 16});
  EXPECT_NEAR(read_for(*device, 1).velocity_m_per_s.x(), 0.1, 1e-9);
  EXPECT_NEAR(read_for(*device, 499).velocity_m_per_s.x(), 0.1, 1e-9);
  const DeviceReading after = read_for(*device, 2);
  EXPECT_TRUE(after.velocity_m_per_s.isZero());
  EXPECT_EQ(read_for(*device, 20).position_m, after.position_m);
}

// One reading moves the position by the time since the last one, 0.1 s at most.
TEST_F(Spacenav, APauseWithoutReadingsCausesNoJump) {
  const auto device = open("?speed=1e-3&box=10");
  server_.send({0, 100, 0, 0, 0, 0, 0, 16});
  const double before = read_for(*device, 10).position_m.x();
  EXPECT_NEAR(read(*device, 0.3).position_m.x() - before, 0.1 * 0.1, 1e-12);
}

TEST_F(Spacenav, ReadsButtons) {
  const auto device = open();
  server_.send({1, 0, 0, 0, 0, 0, 0, 0});
  server_.send({1, 31, 0, 0, 0, 0, 0, 0});
  server_.send({1, 32, 0, 0, 0, 0, 0, 0});  // more than there are bits
  server_.send({1, -1, 0, 0, 0, 0, 0, 0});
  server_.send({3, 0, 1, 2, 3, 4, 5, 0});  // a mouse is plugged in
  EXPECT_EQ(read_for(*device, 10).buttons, 0x80000001u);
  server_.send({2, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(read_for(*device, 10).buttons, 0x80000000u);
}

TEST_F(Spacenav, JoinsFramesThatComeInPieces) {
  const auto device = open("?speed=1e-3&box=10");
  const std::vector<std::int32_t> frame = {0, 100, 0, 0, 0, 0, 0, 16};
  const char* bytes = reinterpret_cast<const char*>(frame.data());
  for (std::size_t i = 0; i < 32; ++i) {
    EXPECT_TRUE(read_for(*device, 1).velocity_m_per_s.isZero());
    server_.send(bytes + i, 1);
  }
  EXPECT_FALSE(read_for(*device, 5).velocity_m_per_s.isZero());
}

TEST_F(Spacenav, ReportsAFaultForWhatIsNoFrame) {
  const auto device = open();
  server_.send({-7, 0, 0, 0, 0, 0, 0, 0});
  DeviceReading reading;
  EXPECT_TRUE(device->read(reading));
  EXPECT_STREQ(device->read(reading).what, "the socket sends data that are not spacenavd's messages");
}

TEST_F(Spacenav, ADaemonThatClosesIsAFault) {
  const auto device = open();
  read_for(*device, 5);
  server_.close();
  DeviceReading reading;
  EXPECT_STREQ(device->read(reading).what, "spacenavd has closed the connection");
  EXPECT_TRUE(device->read(reading));
  EXPECT_TRUE(device->write({}));
}

TEST_F(Spacenav, ATickAllocatesNothing) {
  const auto device = open();
  for (int i = 0; i < 100; ++i) server_.send({0, i, i, i, i, i, i, 16});
  DeviceReading reading;
  const std::size_t before = allocation_count();
  for (int i = 0; i < 100; ++i)
    if (device->read(reading) || device->write({})) break;
  EXPECT_EQ(allocation_count(), before);
}

TEST_F(Spacenav, UsesTheSocketOfTheEnvironment) {
  ::setenv("SPNAV_SOCKET", path_.c_str(), 1);
  EXPECT_TRUE(spacenav_availability("", clock_).found);
  EXPECT_EQ(spacenav_availability("", clock_).detail, "spacenavd at " + path_);
  const auto device = open_spacenav("?box=1", clock_);
  EXPECT_EQ(device->traits().name, "spacenavd " + path_);
  ::setenv("SPNAV_SOCKET", "/nowhere", 1);
  EXPECT_FALSE(spacenav_availability("", clock_).found);
  EXPECT_HAS(spacenav_availability("", clock_).detail,
             "no spacenavd at /nowhere (No such file or directory); install");
  ::unsetenv("SPNAV_SOCKET");
}

TEST(SpacenavAddress, RefusesWhatCannotBeOpened) {
  SimulatedClock clock;
  const auto open = [&](const std::string& address) {
    return refusal([&] { open_spacenav(address, clock); });
  };
  EXPECT_HAS(
      open("/nowhere/sock"),
      "spnav:/nowhere/sock: no spacenavd at /nowhere/sock (No such file or directory); install and start");
  EXPECT_HAS(open("/" + std::string(200, 'a')), "the path is too long for a socket");
  EXPECT_HAS(open("/tmp"), "no spacenavd at /tmp (");
  EXPECT_HAS(open("?box=0"), "spnav:?box=0: box is \"0\": expected a number from 0.001 to 10");
  EXPECT_HAS(open("?speed"), "the setting speed has no value; write speed=VALUE");
  EXPECT_HAS(open("?box=1&box=2"), "the setting box is given twice");
}

// --- the stock daemon: in real time, which may take long on a busy machine ---

// Waits until a reading meets the condition, once the daemon has passed on a packet of the mouse. Returns
// true if one does.
bool comes(HapticDevice& device, DeviceReading& reading,
           const std::function<bool(const DeviceReading&)>& condition) {
  return wait_until([&] { return !device.read(reading) && condition(reading); });
}

// The daemon queries once which mouse is at its terminal, and waits a quarter of a second for the answer. A
// busy machine can need more than one daemon until the mouse is found.
std::unique_ptr<SpacenavDaemon> daemon_with(const SerialMouse& mouse, const std::filesystem::path& folder) {
  std::unique_ptr<SpacenavDaemon> daemon;
  wait_until([&] {
    daemon.reset();
    daemon = std::make_unique<SpacenavDaemon>(folder, mouse.terminal());
    return wait_until([&] { return spacenav_availability(daemon->socket(), steady_clock()).found; }, 10) &&
           wait_until([&] { return mouse.is_detected(); }, 1);
  });
  return daemon;
}

TEST(SpacenavDaemon, DeliversASerialMouse) {
  if (spacenav_daemon_program().empty()) GTEST_SKIP() << "spacenavd is not installed (apt package spacenavd)";
  const TestFolder folder("spacenav_daemon_test");
  SerialMouse mouse;
  const auto daemon = daemon_with(mouse, folder.path());
  ASSERT_TRUE(mouse.is_detected()) << bytes_of(folder / "log");
  const auto device = open_spacenav(daemon->socket() + "?speed=1e-3&turning=1e-3&box=10", steady_clock());
  DeviceReading reading;
  // The daemon sends what changes, and only to clients that it has accepted by then.
  int moved = 0;
  ASSERT_TRUE(comes(*device, reading, [&](const DeviceReading& r) {
    mouse.deflect({10 + ++moved % 2, 0, 0, 0, 0, 0});
    return !r.velocity_m_per_s.isZero();
  }));
  // The mouse's own axes are those of the device.
  for (int axis = 0; axis < 6; ++axis) {
    std::array<int, 6> counts{};
    counts[static_cast<std::size_t>(axis)] = 50 + 10 * axis;
    Eigen::Matrix<double, 6, 1> expected = Eigen::Matrix<double, 6, 1>::Zero(), found;
    expected[axis] = 1e-3 * (50 + 10 * axis);
    mouse.deflect(counts);
    EXPECT_TRUE(comes(*device, reading,
                      [&](const DeviceReading& r) {
                        found << r.velocity_m_per_s, r.angular_velocity_rad_per_s;
                        return found.isApprox(expected, 1e-9);
                      }))
        << axis << ": " << found.transpose();
  }
  mouse.deflect({});
  EXPECT_TRUE(comes(*device, reading, [](const DeviceReading& r) {
    return r.velocity_m_per_s.isZero() && r.angular_velocity_rad_per_s.isZero();
  }));
  EXPECT_TRUE((reading.position_m.array() > 0).all()) << reading.position_m.transpose();
  mouse.press(0b101);
  EXPECT_TRUE(comes(*device, reading, [](const DeviceReading& r) { return r.buttons == 0b101u; }));
  mouse.press(0);
  EXPECT_TRUE(comes(*device, reading, [](const DeviceReading& r) { return r.buttons == 0; }));

  daemon->kill();
  EXPECT_STREQ(device->read(reading).what, "spacenavd has closed the connection");
}

}  // namespace
}  // namespace remote_touch::spacenav_test
