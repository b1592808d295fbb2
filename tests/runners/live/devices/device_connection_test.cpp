#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runners/live/devices/clock.h"
#include "tests/support/test_files.h"

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
