// The socket of a spacenavd that does not run. A test writes its frames.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace remote_touch {

class SpacenavSocket {
 public:
  explicit SpacenavSocket(const std::string& path)
      : listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_, 4) != 0)
      ADD_FAILURE() << "no socket at " << path;
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

}  // namespace remote_touch
