// A connected stream socket. No call waits beyond its deadline, which is a time of the socket's clock in
// seconds. A transfer that is possible without waiting is made even after the deadline. The operating system
// does the waiting.
#pragma once

#include <cstddef>
#include <string>

#include "runners/live/devices/clock.h"

namespace remote_touch {

class DeadlineSocket {
 public:
  struct Transfer {
    std::size_t bytes = 0;
    int error = 0;  // an errno value; ETIMEDOUT at the deadline, ECONNRESET when the peer has closed
  };

  explicit DeadlineSocket(const Clock& clock) : clock_(clock) {}
  ~DeadlineSocket();
  DeadlineSocket(const DeadlineSocket&) = delete;
  DeadlineSocket& operator=(const DeadlineSocket&) = delete;

  // Returns the reason why it could not connect; an empty text on success. Resolving a name may take longer
  // than the deadline. Small messages to a host are sent at once (TCP_NODELAY).
  std::string connect_to_host(const std::string& host, const std::string& port, double deadline_s);
  std::string connect_to_path(const std::string& path, double deadline_s);

  // Reads the bytes that have arrived, without waiting. The error is EAGAIN if none have arrived.
  Transfer read_ready(void* data, std::size_t size) noexcept;
  // Returns 0 if there is something to read, or if the stream has ended; else an errno value.
  int wait_readable(double deadline_s) noexcept;
  Transfer read_some(void* data, std::size_t size, double deadline_s) noexcept;
  Transfer write_some(const void* data, std::size_t size, double deadline_s) noexcept;

  // Shuts the connection down: nothing is sent or received any more, and calls in progress return. Any thread
  // may call it while this object exists.
  void cut() noexcept;

 private:
  int wait(short events, double deadline_s) noexcept;
  int connect_within(const void* address, unsigned size, double deadline_s) noexcept;
  void close() noexcept;

  const Clock& clock_;
  int handle_ = -1;
};

}  // namespace remote_touch
