#include "runners/live/loop/live_view.h"

#include "core/parameters/parameter.h"

#ifdef REMOTE_TOUCH_VIEW_SERVER
// The one file of this folder that includes Boost.Beast.
#define BOOST_ASIO_DISABLE_FENCED_BLOCK
// Boost 1.74 does not know that clang++ 14 has the coroutines of C++20.
#ifdef __clang__
#define BOOST_ASIO_HAS_CO_AWAIT 1
#define BOOST_ASIO_HAS_STD_COROUTINE 1
#endif
#include <fcntl.h>

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <random>
#include <thread>

#endif

namespace remote_touch {

#ifndef REMOTE_TOUCH_VIEW_SERVER

std::unique_ptr<ViewServer> serve_view(std::string, LivePages&, int) {
  throw InputError("--view", "not compiled in; install libboost-dev and build again");
}

#else

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::use_awaitable;
using asio::ip::tcp;
using Request = http::request<http::empty_body>;
using Socket = websocket::stream<beast::tcp_stream>;

constexpr auto kPatience = std::chrono::seconds(5);          // longest wait for a request
constexpr auto kPollPeriod = std::chrono::milliseconds(16);  // period of the checks for messages to send
constexpr auto kIdle = std::chrono::seconds(20);             // longest time without an answer of the browser
constexpr auto kAlive = std::chrono::seconds(1);             // longest time between messages
constexpr auto kMaxEndWait = std::chrono::seconds(1);        // longest wait for pages to close after the run
constexpr int kMaxConnections = 16;
constexpr std::uint32_t kMaxHeader = 8192;

std::string random_secret() {
  std::random_device random;
  char text[33];
  for (int i = 0; i < 4; ++i) std::snprintf(text + 8 * i, 9, "%08x", static_cast<unsigned>(random()));
  return text;
}

// Compares in a time that does not depend on where the texts differ.
bool same(beast::string_view a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < b.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

// Closes the handle in child processes: a browser that this program starts would keep the port.
template <class Handle>
void keep_from_children(Handle& handle) {
  fcntl(handle.native_handle(), F_SETFD, FD_CLOEXEC);
}

class BeastServer final : public ViewServer {
 public:
  BeastServer(std::string page, LivePages& pages, int port)
      : page_(std::move(page)), pages_(pages), acceptor_(context_) {
    open(port);
    port_ = std::to_string(acceptor_.local_endpoint().port());
    asio::co_spawn(context_, accept_all(), asio::detached);
    thread_ = std::thread([this] { context_.run(); });
  }
  ~BeastServer() override {
    try {
      end("it failed; the terminal shows the reason");
    } catch (const std::exception&) {  // no memory: the pages notice the end by themselves
    }
    context_.stop();
    thread_.join();
  }
  std::string address() const override { return "http://127.0.0.1:" + port_ + path_; }
  void end(const std::string& why) override {
    pages_.end(why);
    const auto until = std::chrono::steady_clock::now() + kMaxEndWait;
    while (open_pages_ > 0 && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(kPollPeriod);
  }

 private:
  void open(int port) {
    boost::system::error_code failure;
    const tcp::endpoint place(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
    acceptor_.open(place.protocol(), failure);
    if (!failure) acceptor_.set_option(tcp::acceptor::reuse_address(true), failure);
    if (!failure) acceptor_.bind(place, failure);
    if (!failure) acceptor_.listen(asio::socket_base::max_listen_connections, failure);
    if (!failure) keep_from_children(acceptor_);
    if (failure)
      throw InputError(
          "--view-port " + std::to_string(port),
          "cannot be opened (" + failure.message() + "): expected a free port, or 0 for any free port");
  }

  asio::awaitable<void> accept_all() {
    asio::steady_timer timer(context_);
    for (;;) {
      boost::system::error_code failure;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(use_awaitable, failure));
      if (failure) {  // no more descriptors, for example
        timer.expires_after(kPatience);
        co_await timer.async_wait(use_awaitable);
        continue;
      }
      keep_from_children(socket);
      if (connections_ < kMaxConnections) asio::co_spawn(context_, serve(std::move(socket)), asio::detached);
    }
  }

  // Serves one connection. An exception, for example because a page is closed, ends only this connection.
  asio::awaitable<void> serve(tcp::socket socket) {
    ++connections_;
    try {
      co_await answer(beast::tcp_stream(std::move(socket)));
    } catch (const std::exception&) {
    }
    --connections_;
  }

  asio::awaitable<void> answer(beast::tcp_stream stream) {
    beast::flat_buffer buffer;
    http::request_parser<http::empty_body> parser;
    parser.header_limit(kMaxHeader);
    stream.expires_after(kPatience);
    co_await http::async_read(stream, buffer, parser, use_awaitable);
    const Request request = parser.release();
    const http::status status = status_of(request);
    if (status == http::status::switching_protocols)
      co_await serve_channel(std::move(stream), request);
    else
      co_await send(stream, request, status);
  }

  http::status status_of(const Request& request) const {
    const beast::string_view target = request.target();
    const beast::string_view place = target.substr(0, target.find('?'));
    const bool is_channel = same(place, path_ + "channel");
    if (!is_channel && !same(place, path_ + "state") && !same(target, path_)) return http::status::not_found;
    if (!is_loopback_host(header(request, http::field::host))) return http::status::forbidden;
    if (request.method() != http::verb::get) return http::status::method_not_allowed;
    if (!is_channel) return http::status::ok;
    if (!is_own_origin(header(request, http::field::origin), header(request, http::field::host)))
      return http::status::forbidden;
    if (!websocket::is_upgrade(request) || !is_name(name_in(request))) return http::status::bad_request;
    return pages_.is_full(name_in(request)) ? http::status::conflict : http::status::switching_protocols;
  }
  static std::string name_in(const Request& request) {
    const beast::string_view target = request.target();
    const std::size_t mark = target.find('?');
    return mark == beast::string_view::npos ? std::string() : std::string(target.substr(mark + 1));
  }
  static bool is_name(const std::string& name) {
    return !name.empty() && name.size() <= LivePages::kMaxName &&
           name.find_first_not_of("0123456789abcdef") == std::string::npos;
  }
  static std::string_view header(const Request& request, http::field field) {
    const beast::string_view text = request[field];
    return {text.data(), text.size()};
  }

  asio::awaitable<void> send(beast::tcp_stream& stream, const Request& request, http::status status) {
    http::response<http::string_body> response{status, request.version()};
    response.set(http::field::cache_control, "no-store");
    response.set(http::field::x_frame_options, "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Content-Type-Options", "nosniff");
    if (status == http::status::ok && !same(request.target(), path_)) {
      response.set(http::field::content_type, "application/json");
      response.body() = state_message(pages_.ended(), pages_.is_full(name_in(request)));
    } else if (status == http::status::ok) {
      response.set(http::field::content_type, "text/html; charset=utf-8");
      response.set(
          "Content-Security-Policy",
          "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
          "connect-src 'self' ws://" +
              std::string(header(request, http::field::host)));
      response.body() = page_;
    } else {
      response.set(http::field::content_type, "text/plain");
      response.body() = refusal_text(static_cast<unsigned>(status), port_);
    }
    response.keep_alive(false);
    response.prepare_payload();
    co_await http::async_write(stream, response, use_awaitable);
    boost::system::error_code gone;
    stream.socket().shutdown(tcp::socket::shutdown_send, gone);
  }

  asio::awaitable<void> serve_channel(beast::tcp_stream stream, const Request& request) {
    ++open_pages_;
    LiveChannel* channel = nullptr;
    try {
      const auto socket = std::make_shared<Socket>(std::move(stream));
      beast::get_lowest_layer(*socket).expires_never();
      socket->set_option(websocket::stream_base::timeout{kPatience, kIdle, true});
      socket->read_message_max(kMaxPageMessage);
      socket->auto_fragment(false);  // thousands of writes for a frame otherwise
      co_await socket->async_accept(request, use_awaitable);
      channel = pages_.open(name_in(request));
      if (channel != nullptr) {
        bool is_sending = true;
        asio::co_spawn(context_, send_all(socket, *channel, is_sending), asio::detached);
        co_await receive_all(*socket, *channel);
        channel->end({});
        // Waits for send_all(), because the channel may belong to another page as soon as it is closed.
        asio::steady_timer timer(context_);
        while (is_sending) {  // NOLINT(bugprone-infinite-loop): send_all sets it
          timer.expires_after(kPollPeriod);
          co_await timer.async_wait(use_awaitable);
        }
      }
    } catch (const std::exception&) {
    }
    if (channel != nullptr) pages_.close(*channel);
    --open_pages_;
  }

  asio::awaitable<void> receive_all(Socket& socket, LiveChannel& channel) {
    try {
      beast::flat_buffer buffer;
      for (;;) {
        co_await socket.async_read(buffer, use_awaitable);
        const auto bytes = buffer.data();
        pages_.receive(channel, {static_cast<const char*>(bytes.data()), bytes.size()});
        buffer.clear();
      }
    } catch (const std::exception&) {
    }
    beast::get_lowest_layer(socket).close();
  }

  // Ends with the connection, and closes the connection if a write fails or the channel is over.
  asio::awaitable<void> send_all(std::shared_ptr<Socket> socket, LiveChannel& channel, bool& is_sending) {
    try {
      co_await send_until_over(*socket, channel);
      // The page answers, and receive_all() ends with that. A page that does not answer is cut off.
      if (socket->is_open()) co_await socket->async_close(websocket::close_code::normal, use_awaitable);
    } catch (const std::exception&) {
    }
    beast::get_lowest_layer(*socket).close();
    is_sending = false;
  }
  asio::awaitable<void> send_until_over(Socket& socket, LiveChannel& channel) {
    asio::steady_timer timer(context_);
    LiveChannel::Message message;
    auto sent = std::chrono::steady_clock::now();
    while (socket.is_open()) {
      const bool is_silent = std::chrono::steady_clock::now() - sent > kAlive;
      if (is_silent) message = {alive_message(), true};
      if (channel.next(message) || is_silent) {
        socket.text(message.is_text);
        co_await socket.async_write(asio::buffer(message.bytes), use_awaitable);
        sent = std::chrono::steady_clock::now();
        continue;
      }
      if (channel.is_over()) co_return;
      timer.expires_after(kPollPeriod);
      co_await timer.async_wait(use_awaitable);
    }
  }

  const std::string page_, path_ = "/" + random_secret() + "/";
  LivePages& pages_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  std::string port_;
  int connections_ = 0;
  std::atomic<int> open_pages_ = 0;  // pages that are connected
  std::thread thread_;
};

}  // namespace

std::unique_ptr<ViewServer> serve_view(std::string page, LivePages& pages, int port) {
  return std::make_unique<BeastServer>(std::move(page), pages, port);
}

#endif

}  // namespace remote_touch
