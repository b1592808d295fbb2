// The WebSocket to Haply's service, over a real socket to a service that is simulated
// (tests/doubles/haply_service.h). Times are those of the machine: a call that does not end by its deadline
// hangs.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <utility>

#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/live/devices/clock.h"
#include "tests/doubles/haply_service.h"
#include "tests/runners/live/devices/haply_ticks.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::haply_link_test {
namespace {

constexpr double kSoon_s = 0.05;
const std::string kCommand =
    R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":0,"y":0,"z":1}}}}]})";

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

TEST(HaplyLink, ExchangesCommandsAndAnswers) {
  const HaplyService service;
  const auto link = open_and_send(service);
  EXPECT_HAS(receive(*link), "cursor_position");
  ASSERT_EQ(service.commands().size(), 1u);
  EXPECT_EQ(service.commands()[0].force_N, Vec3(0, 0, 1));
}

TEST(HaplyLink, AServiceThatHangsIsWaitedForUntilTheDeadlineAndMayComeBack) {
  HaplyService service;
  service.set(HaplyService::Mood::hangs);
  const auto link = open_and_send(service);
  const double start_s = now_s();
  EXPECT_EQ(receive(*link, kSoon_s), kLate);
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

TEST(HaplyLink, AMessageThatStopsInTheMiddleTimesOut) {
  HaplyService service;
  service.set(HaplyService::Mood::hangs_in_the_middle);
  const auto link = open_and_send(service);
  ASSERT_TRUE(wait_until([&] { return service.misbehaves(); }));
  EXPECT_EQ(receive(*link, kSoon_s), "the Haply service stopped in the middle of a message");
}

// There is always something to read, and never an answer.
TEST(HaplyLink, EndlessPingsTimeOut) {
  HaplyService service;
  service.set(HaplyService::Mood::pings);
  const auto link = open_and_send(service);
  ASSERT_TRUE(wait_until([&] { return service.misbehaves(); }));
  EXPECT_EQ(receive(*link, kSoon_s), "the Haply service stopped in the middle of a message");
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

// A port of this machine on which no program listens, and that no other program gets meanwhile.
class SilentPort {
 public:
  SilentPort() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    number_ = ntohs(address.sin_port);
  }
  ~SilentPort() { ::close(socket_); }
  SilentPort(const SilentPort&) = delete;
  SilentPort& operator=(const SilentPort&) = delete;
  int number() const { return number_; }

 private:
  const int socket_;
  int number_ = 0;
};

// The header Host of the handshake has the same brackets.
TEST(HaplyPlace, HasBracketsAroundAnAddressOfIpv6) {
  for (const auto& [address, authority] :
       {std::pair("ws://[::1]:10002", "[::1]:10002"), std::pair("ws://[fe80::1]/path", "[fe80::1]:10001"),
        std::pair("ws://localhost:5", "localhost:5"), std::pair("", "127.0.0.1:10001")})
    EXPECT_EQ(haply_place({"haply", address, {}}).authority(), authority);
}

TEST(HaplyLink, RefusesAddressesThatCannotBeOpened) {
  const SilentPort silent;
  const std::string gone = "ws://127.0.0.1:" + std::to_string(silent.number());
  EXPECT_HAS(refusal([&] { open_link(gone); }), "haply:" + gone + ": no Haply service at " + gone + "/ (");
  EXPECT_HAS(refusal([&] { open_link(gone); }), "start the Inverse service");
  EXPECT_HAS(refusal([&] { open_link("ws://[::1]:" + std::to_string(silent.number())); }),
             ": no Haply service at ws://[::1]:" + std::to_string(silent.number()) + "/ (");
  EXPECT_HAS(refusal([&] { open_link("http://127.0.0.1"); }), "write ws://HOST:PORT");
  EXPECT_HAS(refusal([&] { open_link("ws://:1"); }), "write ws://HOST:PORT");
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

TEST(HaplyOverTheSocket, ReportsItsAvailability) {
  const Availability availability = haply_availability(steady_clock());
  EXPECT_TRUE(availability.compiled_in);
  EXPECT_FALSE(availability.detail.empty());
  EXPECT_EQ(availability.detail.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::haply_link_test
