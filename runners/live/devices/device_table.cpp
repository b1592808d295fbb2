#include "runners/live/devices/device_table.h"

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
#include <utility>

#include "runners/experiment/sessions/session_scene.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haply.h"

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

SimulatedDevice::SimulatedDevice(std::shared_ptr<const Trajectory> script, const SimulatedHand& hand,
                                 const DevicePlacement& placement, double rate_hz, Clock& clock)
    : HapticDevice(
          clock, {.name = "simulated device", .sensed_axes = 6, .actuated_axes = 6, .tick_rate_hz = rate_hz}),
      script_(std::move(script)),
      hand_(hand),
      placement_(placement) {}

void SimulatedDevice::run(const DeviceTick& tick) {
  if (!start_s_) start_s_ = clock().now_s();
  HapticDevice::run(tick);
  if (failure_) std::rethrow_exception(failure_);
}

void SimulatedDevice::move_to_now() {
  const auto now = static_cast<long long>((clock().now_s() - start_s_.value_or(0)) * traits_.tick_rate_hz);
  const long long first = ticks_;
  ticks_ = std::max(ticks_ + 1, now);
  for (long long tick = std::max(first + 1, ticks_ - kMaxTicksAtOnce); tick <= ticks_; ++tick) {
    const double time_s = static_cast<double>(tick) / traits_.tick_rate_hz;
    state_ = hand_.move(script_->at(time_s), time_s);
  }
}

DeviceFault SimulatedDevice::read(DeviceReading& reading) noexcept try {
  if (fault_) return fault_;
  const long long first = ticks_;
  move_to_now();
  reading = placement_.of_device(state_);
  if (first > 0)
    reading.velocity_m_per_s =
        (reading.position_m - last_.position_m) * traits_.tick_rate_hz / static_cast<double>(ticks_ - first);
  last_ = reading;
  return {};
} catch (const std::exception& error) {
  failure_ = std::current_exception();
  return fault_ = {error.what()};
} catch (...) {
  failure_ = std::current_exception();
  return fault_ = {"the script of the simulated hand failed"};
}

DeviceFault SimulatedDevice::write(const Wrench& wrench) noexcept {
  const Wrench device_wrench =
      armed_.load(std::memory_order_relaxed) ? placement_.in_world(wrench) : Wrench{};
  hand_.apply(device_wrench);
  return {};
}

BrowserDevice::BrowserDevice(std::shared_ptr<HandPoses> poses, const DeviceState& start,
                             const DevicePlacement& placement, double rate_hz, Clock& clock)
    : HapticDevice(
          clock,
          {.name = "mouse in a browser", .sensed_axes = 6, .actuated_axes = 0, .tick_rate_hz = rate_hz}),
      poses_(std::move(poses)),
      placement_(placement),
      stopped_{start.position_W, start.orientation_W, 0},
      wanted_(stopped_),
      now_(start) {}

void BrowserDevice::run(const DeviceTick& tick) {
  start_s_ = clock().now_s();
  HapticDevice::run(tick);
}

void BrowserDevice::request(const HandMotion& motion) {
  if (motion.stops != stops_) {
    stopped_ = {now_.position_W, now_.orientation_W, 0};
    velocity_m_per_s_.setZero();
  }
  stops_ = motion.stops;
  const DeviceState &from = motion.from, &to = motion.to;
  wanted_.position_W = (stopped_.position_W + to.position_W - from.position_W)
                           .cwiseMax(-kMaxHandDistance_m)
                           .cwiseMin(kMaxHandDistance_m);
  wanted_.orientation_W =
      (to.orientation_W * from.orientation_W.conjugate() * stopped_.orientation_W).normalized();
  wanted_.buttons = to.buttons;
}

// x'' = w^2 (wanted - x) - 2 w x', the velocity first: stable for steps far below 1 / w.
void BrowserDevice::follow(double interval_s) {
  constexpr double w = kNaturalFrequency_rad_per_s;
  velocity_m_per_s_ +=
      interval_s * (w * w * (wanted_.position_W - now_.position_W) - 2 * w * velocity_m_per_s_);
  const double speed = velocity_m_per_s_.norm();
  if (speed > kMaxSpeed_m_per_s) velocity_m_per_s_ *= kMaxSpeed_m_per_s / speed;
  now_.position_W += interval_s * velocity_m_per_s_;
}

void BrowserDevice::turn(double interval_s) {
  const double left = now_.orientation_W.angularDistance(wanted_.orientation_W);
  if (left < 1e-9) return;
  const double angle = std::min(
      {left, 0.5 * kNaturalFrequency_rad_per_s * interval_s * left, kMaxTurning_rad_per_s * interval_s});
  now_.orientation_W = now_.orientation_W.slerp(angle / left, wanted_.orientation_W).normalized();
}

DeviceFault BrowserDevice::read(DeviceReading& reading) noexcept {
  if (poses_->take()) request(poses_->front());
  const long long first = ticks_;
  ticks_ = std::max(ticks_ + 1, static_cast<long long>((clock().now_s() - start_s_) * traits_.tick_rate_hz));
  const double interval_s = 1 / traits_.tick_rate_hz;
  for (long long tick = std::max(first, ticks_ - kMaxTicksAtOnce); tick < ticks_; ++tick)
    follow(interval_s), turn(interval_s);
  now_.buttons = wanted_.buttons;
  reading = placement_.of_device(now_);
  if (first > 0)
    reading.velocity_m_per_s =
        (reading.position_m - last_.position_m) * traits_.tick_rate_hz / static_cast<double>(ticks_ - first);
  last_ = reading;
  return {};
}

namespace {

// Returns the trajectory of an experiment. It keeps the scenario, whose frames it may read at any time.
std::shared_ptr<const Trajectory> script_of(const DeviceContext& context) {
  const std::shared_ptr<const Scenario> scenario = context.experiment.build_scenario(context.kernels);
  const std::shared_ptr<const Trajectory> trajectory = context.experiment.build_trajectory(*scenario);
  return {trajectory.get(), [scenario, trajectory](const Trajectory*) {}};
}

// The hand starts at the first pose of the experiment's trajectory.
std::unique_ptr<HapticDevice> open_browser(const std::string& address, const DeviceContext& context) {
  if (!address.empty()) throw InputError("--device browser:" + address, "expected browser:");
  if (!context.poses) throw InputError("--device browser:", "needs a page: expected the option --view too");
  const Experiment& experiment = context.experiment;
  return std::make_unique<BrowserDevice>(context.poses, script_of(context)->at(0),
                                         DevicePlacement(experiment.live()),
                                         experiment.settings().haptic_rate_hz, context.clock);
}

std::unique_ptr<HapticDevice> open_simulated(const std::string& address, const DeviceContext& context) {
  const Experiment& experiment = context.experiment;
  if (!address.empty())
    throw InputError("--device sim:" + address,
                     "expected sim:, for the experiment's trajectory and operator");
  return std::make_unique<SimulatedDevice>(script_of(context), experiment.build_hand(),
                                           DevicePlacement(experiment.live()),
                                           experiment.settings().haptic_rate_hz, context.clock);
}

// Opens the hand of a recorded session. It moves in real time and does not respond to forces.
std::unique_ptr<HapticDevice> open_session(const std::string& address, const DeviceContext& context) {
  const Experiment& experiment = context.experiment;
  const auto scenario = experiment.build_scenario(context.kernels);
  const double rate_hz = experiment.settings().haptic_rate_hz;
  return std::make_unique<SimulatedDevice>(
      std::make_unique<SessionHand>(SessionHand::Settings{address}, *scenario),
      SimulatedHand({}, {}, 1 / rate_hz), DevicePlacement(experiment.live()), rate_hz, context.clock);
}

template <std::unique_ptr<HapticDevice> (*open)(const std::string&, Clock&)>
std::unique_ptr<HapticDevice> open_at(const std::string& address, const DeviceContext& context) {
  return open(address, context.clock);
}

constexpr DeviceEntry kDevices[] = {
    {"sim", "sim:", "the experiment's trajectory, with its operator who feels the force; no hardware",
     open_simulated, [] { return always("simulated"); }},
    {"browser", "browser:", "the mouse, in the page of --view; input only", open_browser,
     [] { return always("with --view"); }},
    {"fd", "fd:NUMBER", "Force Dimension omega, sigma, delta, lambda, and Novint Falcon",
     open_at<open_force_dimension>, force_dimension_availability},
    {"touch", "touch:NAME", "Touch, Touch X and Phantoms, by OpenHaptics", open_at<open_open_haptics>,
     open_haptics_availability},
    {"entact", "entact:IP", "Entact W5D and W7D", open_at<open_entact>, entact_availability},
    {"haply", "haply:ws://127.0.0.1:10001", "Haply Inverse3, by the WebSocket of its service",
     [](const std::string& address, const DeviceContext& context) {
       return open_haply(address, context.clock);
     },
     [] { return haply_availability(steady_clock()); }},
    {"spnav", "spnav:PATH", "3Dconnexion SpaceMouse, by spacenavd; input only", open_at<open_spacenav>,
     [] { return spacenav_availability("", steady_clock()); }},
    {"replay", "replay:FILE", "the hand of a recorded live session; no hardware", open_session,
     [] { return always("reads files"); }},
};

}  // namespace

std::span<const DeviceEntry> devices() {
  return kDevices;
}

std::unique_ptr<HapticDevice> open_device(const std::string& text, const DeviceContext& context) {
  const Uri uri = parse_uri("--device", text);
  return find_scheme(devices(), "--device", uri).open(uri.address, context);
}

}  // namespace remote_touch
