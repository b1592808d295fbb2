// The same definition and reason as in runners/live/devices/haply_link.cpp.
#define BOOST_ASIO_DISABLE_FENCED_BLOCK
#include "tests/doubles/haply_service.h"

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
#include <stdexcept>
#include <thread>

namespace remote_touch {

namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
namespace beast = boost::beast;
using Web = beast::websocket::stream<tcp::socket, false>;

}  // namespace

struct HaplyService::Inside {
  boost::asio::io_context context;
  tcp::acceptor acceptor{context, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
  // The handle is kept beside the objects of Boost, which only the thread uses.
  const int listener = acceptor.native_handle();
  const int port = acceptor.local_endpoint().port();

  mutable std::mutex mutex;
  std::condition_variable changed;
  HaplyWorld world;
  std::vector<HaplyCommand> commands;
  Vec3 given_N = Vec3::Zero();
  int connection = -1;
  Mood mood = Mood::answers;
  std::thread thread;

  void serve();
  void talk(Web& web);
  void note(const std::string& text);
  bool is(Mood asked);
  bool misbehaves = false;
  std::string answer(bool is_inventory);
};

void HaplyService::Inside::serve() {
  for (;;) {
    error_code ec;
    tcp::socket socket(context);
    acceptor.accept(socket, ec);
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (mood == Mood::is_dead || ec) return;
      connection = socket.native_handle();
    }
    Web web(std::move(socket));
    web.next_layer().set_option(tcp::no_delay(true));
    talk(web);
    const std::lock_guard<std::mutex> lock(mutex);
    connection = -1;
  }
}

void HaplyService::Inside::talk(Web& web) {
  error_code ec;
  web.accept(ec);
  web.text(true);
  if (!ec) web.write(boost::asio::buffer(answer(true)), ec);
  while (!ec) {
    beast::flat_buffer command;
    web.read(command, ec);
    if (ec) return;
    note(beast::buffers_to_string(command.data()));
    const std::string text = answer(false);
    while (!ec && is(Mood::pings)) {
      web.ping({}, ec);
      const std::lock_guard<std::mutex> lock(mutex);
      misbehaves = true;
    }
    std::unique_lock<std::mutex> lock(mutex);
    const bool has_to_wait = mood == Mood::hangs_in_the_middle;
    if (has_to_wait) {
      // A text frame of 100 bytes, of which only five come.
      const unsigned char half[] = {0x81, 100, '{', '"', 'i', 'n', 'v'};
      boost::asio::write(web.next_layer(), boost::asio::buffer(half), ec);
      misbehaves = true;
    }
    changed.wait(lock, [&] { return mood == Mood::answers || mood == Mood::is_dead; });
    if (mood == Mood::is_dead || has_to_wait) return;
    lock.unlock();
    web.write(boost::asio::buffer(text), ec);
  }
}

void HaplyService::Inside::note(const std::string& text) {
  const std::vector<HaplyCommand> sent = haply_commands(text);
  const std::lock_guard<std::mutex> lock(mutex);
  for (const HaplyCommand& command : sent) {
    commands.push_back(command);
    given_N = given_force_N(world, command);
  }
}

std::string HaplyService::Inside::answer(bool is_inventory) {
  const std::lock_guard<std::mutex> lock(mutex);
  return is_inventory ? haply_inventory(world, given_N) : haply_state(world, given_N);
}

bool HaplyService::Inside::is(Mood asked) {
  const std::lock_guard<std::mutex> lock(mutex);
  return mood == asked;
}

void HaplyService::set(Mood mood) {
  const std::lock_guard<std::mutex> lock(inside_->mutex);
  inside_->mood = mood;
  inside_->changed.notify_all();
  if (mood != Mood::is_dead) return;
  ::shutdown(inside_->listener, SHUT_RDWR);
  if (inside_->connection >= 0) ::shutdown(inside_->connection, SHUT_RDWR);
}

HaplyService::HaplyService(const HaplyWorld& world) : inside_(std::make_unique<Inside>()) {
  inside_->world = world;
  inside_->thread = std::thread([this] { inside_->serve(); });
}

HaplyService::~HaplyService() {
  set(Mood::is_dead);
  inside_->thread.join();
}

int HaplyService::port() const {
  return inside_->port;
}

bool HaplyService::misbehaves() const {
  const std::lock_guard<std::mutex> lock(inside_->mutex);
  return inside_->misbehaves;
}

std::vector<HaplyCommand> HaplyService::commands() const {
  const std::lock_guard<std::mutex> lock(inside_->mutex);
  return inside_->commands;
}

HaplyServiceProcess::HaplyServiceProcess() {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  child_ = ::fork();
  if (child_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close(ends[0]);
    const HaplyService service;
    const int port = service.port();
    if (::write(ends[1], &port, sizeof port) == sizeof port)
      for (;;) ::pause();
    ::_exit(1);
  }
  ::close(ends[1]);
  if (::read(ends[0], &port_, sizeof port_) != sizeof port_) port_ = 0;
  ::close(ends[0]);
}

void HaplyServiceProcess::kill() {
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
  child_ = -1;
}

}  // namespace remote_touch
