#include "runners/live/devices/haply.h"

#ifdef REMOTE_TOUCH_HAPLY
// The one file of this folder that includes Boost.Beast, which takes ten seconds to compile. The thread
// sanitizer does not support Asio's fences between threads that run handlers; there are no such threads here.
#define BOOST_ASIO_DISABLE_FENCED_BLOCK
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cerrno>

#include "runners/live/devices/device_table.h"
#endif

namespace remote_touch {

#ifndef REMOTE_TOUCH_HAPLY

bool haply_link_is_compiled_in() {
  return false;
}

std::unique_ptr<HaplyLink> open_haply_link(const DeviceAddress& address, const Clock&, double) {
  throw address.refusal("not compiled in; install libboost-dev and build again");
}

#else

namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

// The largest message, in bytes: far more than an inventory of several devices needs. A longer one is
// refused.
constexpr std::size_t kMaxMessage = 1 << 16;
// Time for the rest of a message that has begun to arrive: on one machine it arrives at once.
constexpr double kRestWithin_s = 1e-3;

// The number of transfers that one call may make without a check of the deadline. A peer may cause more, for
// instance with one ping after the other, each of which is answered. The call then ends at the deadline even
// if it never had to wait.
constexpr int kMaxParts = 64;

// The stream below Beast's blocking calls. These calls have no deadline, and one call may wait on the socket
// more than once. Here each wait ends by the deadline of the whole call.
class DeadlineStream {
 public:
  // NOLINTNEXTLINE(readability-identifier-naming): the name that Beast asks for
  using executor_type = boost::asio::io_context::executor_type;

  DeadlineStream(boost::asio::io_context& context, const Clock& clock)
      : socket(clock), context_(context), clock_(clock) {}
  executor_type get_executor() noexcept { return context_.get_executor(); }

  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, error_code& ec) {
    const boost::asio::mutable_buffer first = beast::buffers_front(buffers);
    if (first.size() == 0) return 0;
    if (is_over()) return result({0, ETIMEDOUT}, ec);
    return result(socket.read_some(first.data(), first.size(), deadline_s_), ec);
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers, error_code& ec) {
    if (is_over()) return result({0, ETIMEDOUT}, ec);
    // The head of a frame and its text are sent in one packet.
    char bytes[1024];
    const std::size_t size = boost::asio::buffer_copy(boost::asio::buffer(bytes), buffers);
    return result(socket.write_some(bytes, size, deadline_s_), ec);
  }
  // Beast requires that the throwing versions exist.
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers) {
    error_code ec;
    const std::size_t bytes = read_some(buffers, ec);
    if (ec) throw boost::system::system_error(ec);
    return bytes;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers) {
    error_code ec;
    const std::size_t bytes = write_some(buffers, ec);
    if (ec) throw boost::system::system_error(ec);
    return bytes;
  }

  // Starts a call, for one message, with this deadline.
  void begin(double deadline_s) {
    deadline_s_ = deadline_s;
    parts_ = 0;
  }

  DeadlineSocket socket;

 private:
  bool is_over() { return ++parts_ > kMaxParts && clock_.now_s() > deadline_s_; }
  static std::size_t result(DeadlineSocket::Transfer transfer, error_code& ec) {
    ec = error_code(transfer.error, boost::system::system_category());
    return transfer.bytes;
  }

  boost::asio::io_context& context_;
  const Clock& clock_;
  double deadline_s_ = 0;
  int parts_ = 0;
};

// Beast calls this function when a connection ends. Beast's own function for sockets waits for the peer.
void teardown(beast::role_type, DeadlineStream& stream, error_code& ec) {
  stream.socket.cut();
  ec = {};
}

DeviceFault fault_of(const error_code& ec) {
  if (ec == websocket::error::message_too_big || ec == websocket::error::buffer_overflow)
    return {"the Haply service sent a message that is too long", ec.value()};
  if (ec == websocket::error::closed || ec == boost::system::errc::connection_reset ||
      ec == boost::system::errc::broken_pipe)
    return {"the Haply service closed the connection", ec.value()};
  if (ec == boost::system::errc::timed_out)
    return {"the Haply service stopped in the middle of a message", ec.value()};
  return {"the connection to the Haply service failed", ec.value()};
}

class BeastLink final : public HaplyLink {
 public:
  BeastLink(const HaplyPlace& place, const Clock& clock, double deadline_s)
      : clock_(clock), web_(context_, clock) {
    DeadlineStream& stream = web_.next_layer();
    stream.begin(deadline_s);
    const std::string problem = stream.socket.connect_to_host(place.host, place.port, deadline_s);
    if (!problem.empty()) throw std::runtime_error(problem);
    web_.handshake(place.authority(), place.target);
    web_.text(true);
    web_.auto_fragment(false);
    web_.read_message_max(kMaxMessage);
  }

  DeviceFault send(std::string_view text, double deadline_s) noexcept override {
    return within(deadline_s, [&](error_code& ec) {
      web_.write(boost::asio::const_buffer(text.data(), text.size()), ec);
    });
  }

  DeviceFault receive(std::string_view& text, double deadline_s) noexcept override {
    // Beast is called only after bytes have arrived, because a wait that ends without bytes breaks its
    // stream. The first message is an exception: it may have arrived with the handshake and be in Beast's
    // buffer. A later message cannot be there, because the service answers each command once, and one command
    // is in progress.
    if (has_first_ && !lost_)
      if (const int error = web_.next_layer().socket.wait_readable(deadline_s))
        return {"the Haply service does not answer", error};
    has_first_ = true;
    message_.clear();
    const double rest_s = std::max(deadline_s, clock_.now_s() + kRestWithin_s);
    const DeviceFault fault = within(rest_s, [&](error_code& ec) { web_.read(message_, ec); });
    text = {static_cast<const char*>(message_.data().data()), message_.size()};
    return fault;
  }

  void cut() noexcept override { web_.next_layer().socket.cut(); }

 private:
  template <class Call>
  DeviceFault within(double deadline_s, Call call) noexcept {
    // Beast must not be called again after an error.
    if (lost_) return lost_;
    web_.next_layer().begin(deadline_s);
    error_code ec;
    try {
      call(ec);
      if (ec) lost_ = fault_of(ec);
    } catch (...) {
      lost_ = {"the connection to the Haply service failed", 0};
    }
    return lost_;
  }

  const Clock& clock_;
  boost::asio::io_context context_;  // required by Beast's timers, which are never set; it is not run
  websocket::stream<DeadlineStream, false> web_;
  beast::flat_static_buffer<kMaxMessage> message_;
  bool has_first_ = false;
  DeviceFault lost_;
};

}  // namespace

bool haply_link_is_compiled_in() {
  return true;
}

std::unique_ptr<HaplyLink> open_haply_link(const DeviceAddress& address, const Clock& clock,
                                           double deadline_s) {
  const HaplyPlace place = haply_place(address);
  try {
    return std::make_unique<BeastLink>(place, clock, deadline_s);
  } catch (const std::exception& error) {
    throw address.refusal("no Haply service at ws://" + place.authority() + place.target + " (" +
                          error.what() + "); start the Inverse service, or name where it runs");
  }
}

#endif

}  // namespace remote_touch
