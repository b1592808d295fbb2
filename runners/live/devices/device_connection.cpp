#include "runners/live/devices/device_connection.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <ctime>
#include <memory>
#include <sstream>

namespace remote_touch {

Uri parse_uri(const std::string& flag, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0)
    throw InputError(flag + " " + text, "expected SCHEME:ADDRESS, see remote-touch devices");
  return {text.substr(0, colon), text.substr(colon + 1)};
}

namespace {

std::string short_text(double value) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);
  text << value;
  return text.str();
}

// Returns EAGAIN for every error that means that the call should be tried again later.
int normalised_error(int error) {
  return error == EWOULDBLOCK || error == EINTR ? EAGAIN : error;
}

}  // namespace

std::string list_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

DeviceAddress::DeviceAddress(const std::string& scheme, const std::string& address,
                             const std::vector<std::string>& known)
    : written_(scheme + ":" + address) {
  const std::size_t mark = address.find('?');
  place_ = address.substr(0, mark);
  if (mark == std::string::npos) return;
  std::istringstream settings(address.substr(mark + 1));
  settings.exceptions(std::ios::badbit);  // throws if there is no memory; otherwise it would report the end
  for (std::string setting; std::getline(settings, setting, '&');) {
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw refusal("has no setting \"" + key + "\": expected " + list_of(known));
    if (equals == std::string::npos || equals + 1 == setting.size())
      throw refusal("the setting " + key + " has no value; write " + key + "=VALUE");
    if (!settings_.emplace(key, setting.substr(equals + 1)).second)
      throw refusal("the setting " + key + " is given twice: expected once");
  }
}

// InputError adds a colon after its subject. The final colon of an address such as "haply:" is removed, so
// that the message has only one.
InputError DeviceAddress::refusal(const std::string& problem) const {
  const bool ends_with_colon = written_.back() == ':';
  return InputError(ends_with_colon ? written_.substr(0, written_.size() - 1) : written_, problem);
}

std::string DeviceAddress::word(const std::string& key, const std::string& otherwise) const {
  const auto found = settings_.find(key);
  return found == settings_.end() ? otherwise : found->second;
}

std::string DeviceAddress::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  const std::string chosen = word(key, allowed.front());
  if (std::find(allowed.begin(), allowed.end(), chosen) == allowed.end())
    throw refusal(key + " is \"" + chosen + "\": expected " + list_of(allowed));
  return chosen;
}

double DeviceAddress::number(const std::string& key, double otherwise, double min, double max) const {
  if (!has(key)) return otherwise;
  const std::string text = word(key, "");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // The comparison is negated so that NaN is refused too.
  if (error != std::errc() || end != text.data() + text.size() || !(value >= min && value <= max))
    throw refusal(key + " is \"" + text + "\": expected a number from " + short_text(min) + " to " +
                  short_text(max));
  return value;
}

DeadlineSocket::~DeadlineSocket() {
  close();
}

void DeadlineSocket::close() noexcept {
  if (handle_ >= 0) ::close(handle_);
  handle_ = -1;
}

void DeadlineSocket::cut() noexcept {
  if (handle_ >= 0) ::shutdown(handle_, SHUT_RDWR);
}

std::string DeadlineSocket::connect_to_host(const std::string& host, const std::string& port,
                                            double deadline_s) {
  addrinfo requested{};
  requested.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), port.c_str(), &requested, &found);
  if (error != 0) return ::gai_strerror(error);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
  int why = EHOSTUNREACH;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    close();
    handle_ = ::socket(one->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    why = handle_ < 0 ? errno : connect_within(one->ai_addr, one->ai_addrlen, deadline_s);
    if (why != 0) continue;
    const int immediately = 1;
    ::setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &immediately, sizeof immediately);
    return "";
  }
  close();
  return std::strerror(why);
}

std::string DeadlineSocket::connect_to_path(const std::string& path, double deadline_s) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return "the path is too long for a socket";
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  close();
  handle_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int why = handle_ < 0 ? errno : connect_within(&address, sizeof address, deadline_s);
  if (why == 0) return "";
  close();
  return std::strerror(why);
}

int DeadlineSocket::connect_within(const void* address, unsigned size, double deadline_s) noexcept {
  while (::connect(handle_, static_cast<const sockaddr*>(address), size) != 0) {
    if (errno == EINPROGRESS) break;
    if (errno != EAGAIN) return errno;
    // The queue of a UNIX socket is full. The system does not tell when there is room in it.
    if (clock_.now_s() >= deadline_s) return ETIMEDOUT;
    constexpr timespec kPause{0, 1'000'000};
    ::nanosleep(&kPause, nullptr);
  }
  if (const int error = wait(POLLOUT, deadline_s)) return error;
  int error = 0;
  socklen_t length = sizeof error;
  ::getsockopt(handle_, SOL_SOCKET, SO_ERROR, &error, &length);
  return error;
}

// Polls at least once, also after the deadline, so that a thread that did not run meanwhile still finds data
// that have arrived.
int DeadlineSocket::wait(short events, double deadline_s) noexcept {
  for (;;) {
    const double remaining_s = std::max(0.0, deadline_s - clock_.now_s());
    timespec left{};
    left.tv_sec = static_cast<time_t>(remaining_s);
    left.tv_nsec = static_cast<long>(1e9 * (remaining_s - std::floor(remaining_s)));
    pollfd one{handle_, events, 0};
    const int ready = ::ppoll(&one, 1, &left, nullptr);
    if (ready > 0) return 0;
    if (ready == 0) return ETIMEDOUT;
    if (errno != EINTR) return errno;
  }
}

int DeadlineSocket::wait_readable(double deadline_s) noexcept {
  return wait(POLLIN, deadline_s);
}

DeadlineSocket::Transfer DeadlineSocket::read_ready(void* data, std::size_t size) noexcept {
  const ssize_t got = ::recv(handle_, data, size, MSG_DONTWAIT);
  if (got > 0) return {static_cast<std::size_t>(got), 0};
  return {0, got == 0 ? ECONNRESET : normalised_error(errno)};
}

DeadlineSocket::Transfer DeadlineSocket::read_some(void* data, std::size_t size, double deadline_s) noexcept {
  for (;;) {
    const Transfer got = read_ready(data, size);
    if (got.error != EAGAIN) return got;
    if (const int error = wait(POLLIN, deadline_s)) return {0, error};
  }
}

DeadlineSocket::Transfer DeadlineSocket::write_some(const void* data, std::size_t size,
                                                    double deadline_s) noexcept {
  for (;;) {
    const ssize_t put = ::send(handle_, data, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (put >= 0) return {static_cast<std::size_t>(put), 0};
    if (normalised_error(errno) != EAGAIN) return {0, errno};
    if (const int error = wait(POLLOUT, deadline_s)) return {0, error};
  }
}

}  // namespace remote_touch
