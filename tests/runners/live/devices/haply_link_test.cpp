// The WebSocket to Haply's service, over a real socket to a service that is simulated: the protocol of its
// documentation on a free port of this machine. Times are those of the machine: a call that does not end by
// its deadline hangs.

// The same definition and reason as in runners/live/devices/haply_link.cpp.
#define BOOST_ASIO_DISABLE_FENCED_BLOCK
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_haply.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::haply_link_test {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
namespace beast = boost::beast;

class HaplyService {
 public:
  explicit HaplyService(const HaplyWorld& world = {}) : world_(world), thread_([this] { serve(); }) {}
  ~HaplyService() {
    set(Mood::is_dead);
    thread_.join();
  }
  HaplyService(const HaplyService&) = delete;
  HaplyService& operator=(const HaplyService&) = delete;

  int port() const { return port_; }
  std::string address() const { return "ws://127.0.0.1:" + std::to_string(port_); }

  // Its way of answering a command from now on: with no answer, or half of one, or control frames instead;
  // the connection stays. is_dead: it ends the connection and accepts no other.
  enum class Mood { answers, hangs, hangs_in_the_middle, pings, is_dead };
  void set(Mood mood) {
    const std::lock_guard lock(mutex_);
    mood_ = mood;
    changed_.notify_all();
    if (mood != Mood::is_dead) return;
    ::shutdown(listener_, SHUT_RDWR);
    if (connection_ >= 0) ::shutdown(connection_, SHUT_RDWR);
  }
  // Returns true if half an answer or a control frame has been sent.
  bool misbehaves() const {
    const std::lock_guard lock(mutex_);
    return misbehaves_;
  }
  std::vector<HaplyCommand> commands() const {
    const std::lock_guard lock(mutex_);
    return commands_;
  }

 private:
  using Web = beast::websocket::stream<tcp::socket, false>;

  void serve() {
    for (error_code ec;;) {
      tcp::socket socket(context_);
      acceptor_.accept(socket, ec);
      {
        const std::lock_guard lock(mutex_);
        if (mood_ == Mood::is_dead || ec) return;
        connection_ = socket.native_handle();
      }
      Web web(std::move(socket));
      web.next_layer().set_option(tcp::no_delay(true));
      talk(web);
      const std::lock_guard lock(mutex_);
      connection_ = -1;
    }
  }
  void talk(Web& web) {
    error_code ec;
    web.accept(ec);
    web.text(true);
    if (!ec) web.write(boost::asio::buffer(world_.inventory_message(given_N_)), ec);
    while (!ec) {
      beast::flat_buffer received;
      web.read(received, ec);
      if (ec) return;
      std::unique_lock lock(mutex_);
      for (const HaplyCommand& command : haply_commands(beast::buffers_to_string(received.data()))) {
        commands_.push_back(command);
        given_N_ = world_.given_N(command);
      }
      while (!ec && mood_ == Mood::pings) {
        misbehaves_ = true;
        lock.unlock();
        web.ping({}, ec);
        lock.lock();
      }
      const bool stops = mood_ == Mood::hangs_in_the_middle;
      if (stops) {
        // A text frame of 100 bytes, of which only five come.
        const unsigned char half[] = {0x81, 100, '{', '"', 'i', 'n', 'v'};
        boost::asio::write(web.next_layer(), boost::asio::buffer(half), ec);
        misbehaves_ = true;
      }
      changed_.wait(lock, [&] { return mood_ == Mood::answers || mood_ == Mood::is_dead; });
      if (mood_ == Mood::is_dead || stops) return;
      lock.unlock();
      web.write(boost::asio::buffer(world_.state_message(given_N_)), ec);
    }
  }

  const HaplyWorld world_;
  Vec3 given_N_ = Vec3::Zero();  // used by the thread alone
  boost::asio::io_context context_;
  tcp::acceptor acceptor_{context_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
  // The handle is kept beside the objects of Boost, which only the thread uses.
  const int listener_ = acceptor_.native_handle(), port_ = acceptor_.local_endpoint().port();

  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  std::vector<HaplyCommand> commands_;
  int connection_ = -1;
  Mood mood_ = Mood::answers;
  bool misbehaves_ = false;
  std::thread thread_;
};

// The same service in a process of its own, which can be killed, and whose allocations are not counted.
class HaplyServiceProcess {
 public:
  HaplyServiceProcess() {
    int ends[2] = {};
    EXPECT_EQ(::pipe(ends), 0);
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      const HaplyService service;
      const int port = service.port();
      if (::write(ends[1], &port, sizeof port) == sizeof port)
        for (;;) ::pause();
      ::_exit(1);
    }
    ::close(ends[1]);
    EXPECT_EQ(::read(ends[0], &port_, sizeof port_), static_cast<ssize_t>(sizeof port_));
    ::close(ends[0]);
  }
  ~HaplyServiceProcess() { kill(); }
  HaplyServiceProcess(const HaplyServiceProcess&) = delete;
  HaplyServiceProcess& operator=(const HaplyServiceProcess&) = delete;

  std::string address() const { return "ws://127.0.0.1:" + std::to_string(port_); }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  pid_t child_ = -1;
  int port_ = 0;
};

constexpr double kSoon_s = 0.05;
const std::string kCommand =
    R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":0,"y":0,"z":1}}}}]})";

Wrench force(const Vec3& force_N) {
  return {force_N, Vec3::Zero()};
}
double now_s() {
  return steady_clock().now_s();
}
std::unique_ptr<HaplyLink> open_link(const std::string& address) {
  return open_haply_link({"haply", address, {}}, steady_clock(), now_s() + kPatience_s);
}
std::string receive(HaplyLink& link, double within_s = kPatience_s) {
  std::string_view text;
  const DeviceFault fault = link.receive(text, now_s() + within_s);
  return fault ? fault.what : std::string(text);
}
// Opens a link, reads the inventory and sends a command.
std::unique_ptr<HaplyLink> open_and_send(const HaplyService& service) {
  auto link = open_link(service.address());
  EXPECT_HAS(receive(*link), "session_id");
  EXPECT_FALSE(link->send(kCommand, now_s() + kPatience_s));
  return link;
}

TEST(HaplyLink, AServiceThatHangsIsWaitedForUntilTheDeadlineAndMayComeBack) {
  HaplyService service;
  service.set(HaplyService::Mood::hangs);
  const auto link = open_and_send(service);
  const double start_s = now_s();
  EXPECT_EQ(receive(*link, kSoon_s), "the Haply service does not answer");
  EXPECT_GE(now_s() - start_s, kSoon_s);
  service.set(HaplyService::Mood::answers);
  EXPECT_HAS(receive(*link), "cursor_position");
}

TEST(HaplyLink, AKilledServiceIsAFault) {
  HaplyServiceProcess service;
  const auto link = open_link(service.address());
  EXPECT_HAS(receive(*link), "session_id");
  service.kill();
  EXPECT_EQ(receive(*link), "the Haply service closed the connection");
  EXPECT_EQ(receive(*link), "the Haply service closed the connection");
}

// Pings always give something to read, and never an answer.
TEST(HaplyLink, HalfAMessageAndEndlessPingsTimeOut) {
  for (const HaplyService::Mood mood : {HaplyService::Mood::hangs_in_the_middle, HaplyService::Mood::pings}) {
    HaplyService service;
    service.set(mood);
    const auto link = open_and_send(service);
    ASSERT_TRUE(wait_until([&] { return service.misbehaves(); }));
    EXPECT_EQ(receive(*link, kSoon_s), "the Haply service stopped in the middle of a message");
  }
}

TEST(HaplyLink, TextThatIsTooLongOrNoUtf8EndsTheConnection) {
  for (const auto& [answer, fault] :
       {std::pair(std::string(1 << 20, 'x'), "the Haply service sent a message that is too long"),
        std::pair(std::string("\xff\xff"), "the connection to the Haply service failed")}) {
    HaplyWorld world;
    world.answer = answer;
    const HaplyService service(world);
    const auto link = open_and_send(service);
    EXPECT_EQ(receive(*link), fault);
    EXPECT_STREQ(link->send(kCommand, now_s() + kPatience_s).what, fault);
  }
}

TEST(HaplyLink, ACutEndsACallUnderWay) {
  HaplyService service;
  service.set(HaplyService::Mood::hangs);
  const auto link = open_and_send(service);
  std::thread other([&] { link->cut(); });
  EXPECT_EQ(receive(*link), "the Haply service closed the connection");
  other.join();
}

// The header Host of the handshake has the same brackets.
TEST(HaplyPlace, HasBracketsAroundAnAddressOfIpv6) {
  for (const auto& [address, authority] :
       {std::pair("ws://[::1]:10002", "[::1]:10002"), std::pair("ws://[fe80::1]/path", "[fe80::1]:10001"),
        std::pair("ws://localhost:5", "localhost:5"), std::pair("", "127.0.0.1:10001")})
    EXPECT_EQ(haply_place({"haply", address, {}}).authority(), authority);
}

// No program listens at the port 1 of a machine.
TEST(HaplyLink, RefusesAddressesThatCannotBeOpened) {
  for (const auto& [address, message] :
       {std::pair("ws://127.0.0.1:1", "haply:ws://127.0.0.1:1: no Haply service at ws://127.0.0.1:1/ ("),
        std::pair("ws://127.0.0.1:1", "start the Inverse service"),
        std::pair("ws://[::1]:1", ": no Haply service at ws://[::1]:1/ ("),
        std::pair("http://127.0.0.1", "write ws://HOST:PORT"), std::pair("ws://:1", "write ws://HOST:PORT")})
    EXPECT_HAS(refusal([&, address = address] { open_link(address); }), message);
}

// The adapter and the socket together, with ticks until one of them was answered in its time.
TEST(HaplyOverTheSocket, ReadsAndWrites) {
  HaplyWorld world;
  world.position_m = Vec3(0.1, 0.2, 0.3);
  HaplyService service(world);
  const auto device = open_haply(service.address(), steady_clock());
  DeviceReading reading;
  EXPECT_TRUE(wait_until([&] { return !device->read(reading) && !device->write(force({0, 1, 0})); }));
  EXPECT_TRUE(reading.position_m.isApprox(Vec3(0.1, 0.3, -0.2), 1e-12));
  EXPECT_TRUE(wait_until([&] { return service.commands().back().force_N == Vec3(0, 0, 1); }));
  device->release();
  EXPECT_TRUE(wait_until([&] { return service.commands().back().force_N.isZero(); }));
}

// The service is in a process of its own: what it allocates is not counted.
TEST(HaplyOverTheSocket, ATickAllocatesNothing) {
  HaplyServiceProcess service;
  const auto device = open_haply(service.address(), steady_clock());
  std::size_t allocations = 0;
  int answered = 0;
  EXPECT_TRUE(wait_until([&] {
    DeviceReading reading;
    const std::size_t before = allocation_count();
    const bool is_read = !device->read(reading);
    device->write(force({0.1, 0.2, 0.3}));
    allocations += allocation_count() - before;
    answered += is_read ? 1 : 0;
    return answered >= 100;
  }));
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace remote_touch::haply_link_test
