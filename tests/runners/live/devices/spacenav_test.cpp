// The adapter of spacenavd: against a socket of the test's own on a simulated clock, and against the stock
// daemon with a simulated serial mouse.
#include "runners/live/devices/device_table.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::spacenav_test {
namespace {

constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();

// The socket of a spacenavd that does not run. A test writes its frames.
class SpacenavSocket {
 public:
  explicit SpacenavSocket(const std::string& path)
      : listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0) << path;
    EXPECT_EQ(::listen(listener_, 4), 0);
  }
  ~SpacenavSocket() {
    close();
    ::close(listener_);
  }

  void accept() { connection_ = ::accept(listener_, nullptr, nullptr); }
  void close() {
    if (connection_ >= 0) ::close(connection_);
    connection_ = -1;
  }
  void send(const std::vector<std::int32_t>& frame) { send(frame.data(), 4 * frame.size()); }
  void send(const void* bytes, std::size_t size) {
    EXPECT_EQ(::send(connection_, bytes, size, MSG_NOSIGNAL), static_cast<ssize_t>(size));
  }

 private:
  int listener_, connection_ = -1;
};

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
TEST_F(Spacenav, TheDisplacementIsSpeedTimesTimeWithoutAJumpAfterAPause) {
  const auto device = open("?speed=1e-3&box=10");
  server_.send({0, 100, 0, 0, 0, 0, 0, 16});
  const double before = read_for(*device, 200).position_m.x();
  EXPECT_NEAR(before, 0.1 * 0.2, 1e-12);
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

TEST_F(Spacenav, ADaemonThatClosesOrSendsNoFrameIsAFault) {
  for (const bool closes : {true, false}) {
    const auto device = open();
    read_for(*device, 5);
    if (closes)
      server_.close();
    else
      server_.send({-7, 0, 0, 0, 0, 0, 0, 0});
    DeviceReading reading;
    EXPECT_TRUE(device->read(reading));
    EXPECT_STREQ(device->read(reading).what, closes
                                                 ? "spacenavd has closed the connection"
                                                 : "the socket sends data that are not spacenavd's messages");
    EXPECT_TRUE(device->write({}));
  }
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
  for (const auto& [address, message] :
       {std::pair<std::string, std::string>{
            "/nowhere/sock",
            "spnav:/nowhere/sock: no spacenavd at /nowhere/sock (No such file or "
            "directory); install and start"},
        {"/" + std::string(200, 'a'), "the path is too long for a socket"},
        {"/tmp", "no spacenavd at /tmp ("},
        {"?speed", "the setting speed has no value; write speed=VALUE"},
        {"?box=0", "spnav:?box=0: box is \"0\": expected a number from 0.001 to 10"}})
    EXPECT_HAS(refusal([&, address = address] { open_spacenav(address, clock); }), message);
}

// --- the stock daemon: in real time, which may take long on a busy machine ---

// A pseudo-terminal that answers like a serial Magellan SpaceMouse. The mouse's frame is x to the right, y
// up, z towards the user, which are the axes of its packets. A packet holds four bits per character: the
// manufacturer's letters have the values as their lower halves.
class SerialMouse {
 public:
  SerialMouse() : handle_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_TRUE(handle_ >= 0 && ::grantpt(handle_) == 0 && ::unlockpt(handle_) == 0) << "no pseudo-terminal";
    if (const char* const name = ::ptsname(handle_)) terminal = name;
    thread_ = std::thread([this] { answer(); });
  }
  ~SerialMouse() {
    is_over_ = true;
    thread_.join();
    ::close(handle_);
  }

  std::string terminal;                  // the daemon opens it
  std::atomic<bool> is_detected{false};  // the daemon has switched its reports on

  // Deflects the mouse along and about x, y and z, in counts.
  void deflect(const std::array<int, 6>& counts) {
    std::string packet = "d";
    for (const int count : counts)
      for (int shift = 12; shift >= 0; shift -= 4) packet += kNibbles[((count + 0x8000) >> shift) & 15];
    send(packet);
  }
  // buttons: one bit for each that is down.
  void press(unsigned buttons) {
    std::string packet = "k";
    for (int shift = 0; shift < 12; shift += 4) packet += kNibbles[(buttons >> shift) & 15];
    send(packet);
  }

 private:
  static constexpr char kNibbles[] = "0AB3D56GH9:K<MN?";

  // The daemon first sends the commands of a Spaceball, which this mouse is not, and then requests the
  // version (vQ). It switches the reports on with m3, which the mouse repeats.
  void answer() {
    for (std::string command; !is_over_;) {
      pollfd one{handle_, POLLIN, 0};
      char c = 0;
      if (::poll(&one, 1, 20) <= 0 || (one.revents & POLLIN) == 0 || ::read(handle_, &c, 1) != 1) {
        if ((one.revents & POLLHUP) != 0) ::usleep(1000);  // no program has it open
        continue;
      }
      command += c;
      if (c != '\r') continue;
      if (command == "vQ\r") send("vMAGELLAN  Version 6.60  3Dconnexion GmbH 05/11/01");
      if (command == "m3\r") {
        send("m3");
        is_detected = true;
      }
      command.clear();
    }
  }
  void send(const std::string& packet) {
    const std::string line = packet + '\r';
    EXPECT_EQ(::write(handle_, line.data(), line.size()), static_cast<ssize_t>(line.size())) << "it is full";
  }

  const int handle_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

// Returns the path of the installed daemon; empty if it is not installed.
std::string installed_daemon() {
  for (const char* program : {"/usr/bin/spacenavd", "/usr/sbin/spacenavd", "/usr/local/bin/spacenavd"})
    if (::access(program, X_OK) == 0) return program;
  return "";
}

// The stock daemon in a folder of its own, where it makes its socket.
class StockDaemon {
 public:
  StockDaemon(const TestFolder& folder, const std::string& terminal) {
    std::filesystem::create_directories(folder / "run");
    const std::string program = installed_daemon(), log = (folder / "log").string();
    const std::string settings = folder.write("spnavrc", "serial = " + terminal + "\n").string();
    child_ = ::fork();
    if (child_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::unsetenv("DISPLAY");
    const int out = ::open(log.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(out, 1), ::dup2(out, 2);
    if (::chdir(folder.path().c_str()) == 0)
      ::execl(program.c_str(), program.c_str(), "-d", "-v", "-c", settings.c_str(),
              static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ~StockDaemon() { kill(); }
  StockDaemon(const StockDaemon&) = delete;
  StockDaemon& operator=(const StockDaemon&) = delete;

  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  pid_t child_ = -1;
};

// Waits until a reading meets the condition, once the daemon has passed on a packet of the mouse. Returns
// true if one does.
bool comes(HapticDevice& device, DeviceReading& reading,
           const std::function<bool(const DeviceReading&)>& condition) {
  return wait_until([&] { return !device.read(reading) && condition(reading); });
}

// The daemon queries once which mouse is at its terminal, and waits a quarter of a second for the answer. A
// busy machine can need more than one daemon until the mouse is found.
std::unique_ptr<StockDaemon> daemon_with(const SerialMouse& mouse, const TestFolder& folder) {
  const std::string socket = (folder / "run/spnav.sock").string();
  std::unique_ptr<StockDaemon> daemon;
  wait_until([&] {
    daemon.reset();
    daemon = std::make_unique<StockDaemon>(folder, mouse.terminal);
    return wait_until([&] { return spacenav_availability(socket, steady_clock()).found; }, 10) &&
           wait_until([&] { return mouse.is_detected.load(); }, 1);
  });
  return daemon;
}

TEST(SpacenavDaemon, DeliversASerialMouse) {
  if (installed_daemon().empty()) GTEST_SKIP() << "spacenavd is not installed (apt package spacenavd)";
  const TestFolder folder("spacenav_daemon_test");
  SerialMouse mouse;
  const auto daemon = daemon_with(mouse, folder);
  ASSERT_TRUE(mouse.is_detected) << bytes_of(folder / "log");
  const auto device =
      open_spacenav((folder / "run/spnav.sock").string() + "?speed=1e-3&turning=1e-3&box=10", steady_clock());
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
