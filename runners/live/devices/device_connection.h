// The connection to a device: its address, and a socket with deadlines.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/live/devices/clock.h"

namespace remote_touch {

// Names of sensors and devices: "scheme:address".
struct Uri {
  std::string scheme, address;  // the address may be empty
};

// Throws InputError if the text has no scheme or no colon. flag: "--depth" or "--device".
Uri parse_uri(const std::string& flag, const std::string& text);

// Returns the entry of that scheme. Throws InputError, which lists an example of each entry, if there is
// none.
template <class Entry>
const Entry& find_scheme(std::span<const Entry> entries, const std::string& flag, const Uri& uri) {
  std::string known;
  for (const Entry& entry : entries) {
    if (uri.scheme == entry.scheme) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.example);
  }
  throw InputError(flag + " " + uri.scheme + ":" + uri.address, "expected " + known);
}

// Returns the words, separated by commas, for messages.
std::string list_of(const std::vector<std::string>& words);

// The address of a device as the user writes it, "haply:ws://127.0.0.1:10001?force=values&rate=2000": a
// scheme, a place and settings. choice() and number() throw InputError for a value that is not allowed.
class DeviceAddress {
 public:
  // address: without the scheme. Throws InputError if a setting is unknown, has no value or is given twice.
  DeviceAddress(const std::string& scheme, const std::string& address, const std::vector<std::string>& known);

  const std::string& place() const { return place_; }  // empty if the user gave none

  bool has(const std::string& key) const { return settings_.count(key) > 0; }
  std::string word(const std::string& key, const std::string& otherwise) const;
  // Returns the value of the setting, which must be one of `allowed`. Returns the first of them if the
  // setting is not given.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  double number(const std::string& key, double otherwise, double min, double max) const;

  InputError refusal(const std::string& problem) const;

 private:
  std::string written_, place_;
  std::map<std::string, std::string> settings_;
};

// A connected stream socket. No call waits beyond its deadline, which is a time of the socket's clock in
// seconds. A transfer that is possible without waiting is made even after the deadline. The operating system
// does the waiting.
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
