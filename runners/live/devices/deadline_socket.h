// A connected stream socket on which no call waits beyond a deadline, a moment of its clock in seconds; what
// is possible without waiting is done after it too. The waiting itself is the system's.
#pragma once

#include <cstddef>
#include <string>

#include "runners/live/timing/clock.h"

namespace remote_touch {

class DeadlineSocket {
 public:
  struct Transfer {
    std::size_t bytes = 0;
    int error = 0;  // of errno; ETIMEDOUT at the deadline, ECONNRESET when the peer has closed
  };

  explicit DeadlineSocket(const Clock& clock) : clock_(&clock) {}
  ~DeadlineSocket();
  DeadlineSocket(DeadlineSocket&& other) noexcept;
  DeadlineSocket& operator=(DeadlineSocket&& other) noexcept;

  // Why it could not be connected; empty when it is. Looking a name up may take longer than the deadline.
  // Small messages leave at once (TCP_NODELAY).
  std::string connect_to_host(const std::string& host, const std::string& port, double deadline_s);
  std::string connect_to_path(const std::string& path, double deadline_s);

  // What is there now, without waiting; EAGAIN when that is nothing.
  Transfer read_ready(void* data, std::size_t size) noexcept;
  // 0 when there is something to read, or the end of the stream.
  int wait_readable(double deadline_s) noexcept;
  Transfer read_some(void* data, std::size_t size, double deadline_s) noexcept;
  Transfer write_some(const void* data, std::size_t size, double deadline_s) noexcept;

  // Nothing is sent or received from now on, and calls under way end. From any thread, while this object
  // lives.
  void cut() noexcept;

 private:
  int wait(short events, double deadline_s) noexcept;
  int connect_within(const void* address, unsigned size, double deadline_s) noexcept;
  void close() noexcept;

  const Clock* clock_;
  int handle_ = -1;
};

}  // namespace remote_touch
