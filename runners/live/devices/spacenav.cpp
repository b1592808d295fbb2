#include "runners/live/devices/device_table.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace remote_touch {

namespace {

constexpr double kConnectWithin_s = 0.5;
constexpr double kMaxDeflectionAge_s = 0.5;
constexpr double kMaxStep_s = 0.1;  // longest step of one reading: the pose must not jump after a pause
constexpr int kMaxFrames = 256;     // most frames in one reading; the daemon sends some hundred a second

constexpr DeviceFault kGone{"spacenavd has closed the connection"};
constexpr DeviceFault kNoFrame{"the socket sends data that are not spacenavd's messages"};

// The daemon sends frames: the number of an event and its values. Other events report changes of mice and
// settings.
enum Event : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2, kLastEvent = 15 };
using Frame = std::array<std::int32_t, 8>;

std::string socket_of(const DeviceAddress& address) {
  if (!address.place().empty()) return address.place();
  // The variable is read here and not in runners/interfaces/cli, because it has the same meaning in libspnav,
  // and so in every program that uses spacenavd.
  const char* from_environment = std::getenv("SPNAV_SOCKET");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : "/var/run/spnav.sock";
}

void connect(DeadlineSocket& socket, const DeviceAddress& address, const Clock& clock) {
  const std::string path = socket_of(address);
  const std::string problem = socket.connect_to_path(path, clock.now_s() + kConnectWithin_s);
  if (!problem.empty())
    throw address.refusal("no spacenavd at " + path + " (" + problem +
                          "); install and start spacenavd, or name its socket");
}

DeviceAddress spacenav_address(const std::string& address) {
  return {"spnav", address, {"speed", "turning", "box"}};
}

class Spacenav final : public HapticDevice {
 public:
  Spacenav(const DeviceAddress& address, Clock& clock)
      : HapticDevice(clock),
        speed_per_count_(address.number("speed", 5e-4, 1e-6, 0.1)),
        turning_per_count_(address.number("turning", 3e-3, 1e-6, 1)),
        box_m_(address.number("box", 0.15, 1e-3, 10)),
        socket_(clock) {
    connect(socket_, address, clock);
    moved_s_ = clock.now_s();
    traits_.name = "spacenavd " + socket_of(address);
    traits_.sensed_axes = 6;
    traits_.actuated_axes = 0;
  }

  DeviceFault read(DeviceReading& reading) noexcept override {
    const double now_s = clock().now_s();
    if (!fault_) fault_ = take_frames(now_s);
    if (fault_) return fault_;
    if (now_s - reported_s_ > kMaxDeflectionAge_s) counts_.fill(0);
    move(std::min(now_s - moved_s_, kMaxStep_s));
    moved_s_ = now_s;
    reading = pose_;
    return {};
  }

  DeviceFault write(const Wrench&) noexcept override { return fault_; }
  void release() noexcept override {}
  bool rearm() noexcept override { return true; }

 private:
  DeviceFault take_frames(double now_s) noexcept {
    for (int frames = 0; frames < kMaxFrames;) {
      const auto got = socket_.read_ready(bytes_.data() + filled_, bytes_.size() - filled_);
      if (got.error == EAGAIN) return {};
      if (got.error != 0) return {kGone.what, got.error};
      filled_ += got.bytes;
      if (filled_ < bytes_.size()) continue;
      filled_ = 0;
      Frame frame;
      std::memcpy(frame.data(), bytes_.data(), bytes_.size());
      if (const DeviceFault fault = take(frame, now_s)) return fault;
      ++frames;
    }
    return {};
  }

  DeviceFault take(const Frame& frame, double now_s) noexcept {
    if (frame[0] < 0 || frame[0] > kLastEvent) return kNoFrame;
    if (frame[0] == kMotion) {
      std::copy_n(frame.begin() + 1, counts_.size(), counts_.begin());
      reported_s_ = now_s;
    } else if (frame[0] <= kRelease && frame[1] >= 0 && frame[1] < 32) {
      const std::uint32_t button = 1u << frame[1];
      if (frame[0] == kPress)
        pose_.buttons |= button;
      else
        pose_.buttons &= ~button;
    }
    return {};
  }

  void move(double step_s) noexcept {
    const Vec3 flip(1, 1, -1);
    const Vec3 along = speed_per_count_ * flip.cwiseProduct(Vec3(counts_[0], counts_[1], counts_[2]));
    const Vec3 about = turning_per_count_ * flip.cwiseProduct(Vec3(counts_[3], counts_[4], counts_[5]));
    const Vec3 to = (pose_.position_m + step_s * along).cwiseMax(-box_m_).cwiseMin(box_m_);
    // The velocity is that of the clamped position: its component towards a face of the box is zero there,
    // although the mouse is pushed.
    pose_.velocity_m_per_s = step_s > 0 ? Vec3((to - pose_.position_m) / step_s) : along;
    pose_.position_m = to;
    pose_.angular_velocity_rad_per_s = about;
    const double angle = step_s * about.norm();
    if (angle > 0) {
      const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angle, about.normalized()));
      pose_.orientation = (rotation * pose_.orientation).normalized();
    }
  }

  const double speed_per_count_, turning_per_count_;  // m/s and rad/s
  const double box_m_;
  DeadlineSocket socket_;
  DeviceFault fault_;

  std::array<char, sizeof(Frame)> bytes_{};  // bytes received of a frame that is not yet whole
  std::size_t filled_ = 0;
  std::array<std::int32_t, 6> counts_{};  // the last deflection received
  double reported_s_ = 0, moved_s_ = 0;
  DeviceReading pose_;
};

}  // namespace

std::unique_ptr<HapticDevice> open_spacenav(const std::string& address, Clock& clock) {
  return std::make_unique<Spacenav>(spacenav_address(address), clock);
}

Availability spacenav_availability(const std::string& address, const Clock& clock) {
  return availability_of([&] {
    const DeviceAddress parsed = spacenav_address(address);
    DeadlineSocket socket(clock);
    connect(socket, parsed, clock);
    return Availability{.found = true, .detail = "spacenavd at " + socket_of(parsed)};
  });
}

}  // namespace remote_touch
