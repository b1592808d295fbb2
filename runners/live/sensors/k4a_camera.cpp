#include "runners/live/sensors/k4a_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch::k4a {
namespace {

const SharedLibrary::Lookup kK4aLibrary{
    {"libk4a.so.1.4", "libk4a.so"},
    "REMOTE_TOUCH_LIBK4A",
    "the Azure Kinect Sensor SDK (libk4a1.4), or of Orbbec's K4A wrapper"};

// The log is never freed, because a thread of the library may write to it at any time.
struct Log {
  std::mutex mutex;
  std::string first_error;
};
Log& k4a_log() {
  static Log& one = *new Log;
  return one;
}

void keep_first_error(void*, LogLevel, const char*, int, const char* message) {
  const std::lock_guard lock(k4a_log().mutex);
  if (k4a_log().first_error.empty() && message != nullptr) k4a_log().first_error = message;
}

}  // namespace

K4aLibrary::K4aLibrary() : library(kK4aLibrary) {
  // The library prints its errors to standard output if it has no handler. If another part of the process has
  // set a handler before, that one stays.
  if (set_debug_message_handler != nullptr) set_debug_message_handler(keep_first_error, nullptr, log_error);
}

std::string K4aLibrary::pop_first_error() const {
  const std::lock_guard lock(k4a_log().mutex);
  return std::exchange(k4a_log().first_error, {});
}

}  // namespace remote_touch::k4a

namespace remote_touch {
namespace {

struct K4aMode {
  const char* name;
  k4a::DepthMode depth;
  k4a::Fps fps;
  int width, height;
  double rate_hz;
};
constexpr K4aMode kK4aModes[] = {
    {"nfov", k4a::nfov_unbinned, k4a::fps_30, 640, 576, 30},
    {"nfov-binned", k4a::nfov_2x2_binned, k4a::fps_30, 320, 288, 30},
    {"wfov-binned", k4a::wfov_2x2_binned, k4a::fps_30, 512, 512, 30},
    {"wfov", k4a::wfov_unbinned, k4a::fps_15, 1024, 1024, 15},
};

constexpr std::uint32_t kMaxCameras = 64;  // a larger number is an error of the library
constexpr int kMaxQueue = 16;              // the library keeps fewer captures

struct K4aAddress {
  std::string name, camera;
  K4aMode mode;
};

K4aAddress k4a_address(const std::string& address) {
  const std::size_t question = address.find('?');
  K4aAddress wanted{address.empty() ? "k4a" : "k4a:" + address, address.substr(0, question), kK4aModes[0]};
  if (question == std::string::npos) return wanted;
  std::string known;
  for (const K4aMode& mode : kK4aModes) {
    if (address.substr(question + 1) == mode.name) {
      wanted.mode = mode;
      return wanted;
    }
    known += (known.empty() ? "" : ", ") + std::string(mode.name);
  }
  throw InputError(wanted.name, "no mode of the camera: expected one of " + known + " after ?");
}

// Returns the number of a camera; none if the text is a serial number.
std::optional<std::uint32_t> k4a_number(const std::string& camera) {
  if (camera.empty()) return 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (camera.size() > 2 || !std::all_of(camera.begin(), camera.end(), is_digit)) return {};
  return static_cast<std::uint32_t>(std::stoi(camera));
}

class K4aCamera final : public DepthSource {
 public:
  K4aCamera(const std::string& address, const Clock& host) : host_(host), address_(k4a_address(address)) {
    k4a_.pop_first_error();
    open_device(address_.camera);
    calibrate();
    start();
  }

  ~K4aCamera() override { k4a_.device_stop_cameras(device_.get()); }

  SensorState next(SensorFrame& frame, double timeout_s) override {
    if (!failure_.empty()) return SensorState::failed;
    const double deadline_s = host_.now_s() + timeout_s;
    while (true) {
      const double remaining_s = deadline_s - host_.now_s();
      double arrived_s = 0;
      const k4a::HeldCapture capture = newest(std::max(remaining_s, 0.0), arrived_s);
      if (capture && take(capture.get(), arrived_s, frame)) return SensorState::frame;
      if (!failure_.empty()) return SensorState::failed;
      if (!capture || remaining_s <= 0) return SensorState::waiting;
    }
  }

 private:
  void open_device(const std::string& camera) {
    const std::uint32_t count = k4a_.device_get_installed_count();
    if (count == 0 || count > kMaxCameras)
      refuse(
          "no camera is plugged in: expected one that is powered and that this user may open (lsusb, udev rules)");
    const std::optional<std::uint32_t> number = k4a_number(camera);
    if (!number) return find_by_serial(camera, count);
    if (*number >= count)
      refuse("no such camera: expected 0 to " + std::to_string(count - 1) + ", or a serial number");
    device_ = open_by_number(*number);
    if (!device_)
      refuse("cannot be opened" + reason() +
             "; another program may hold it: expected a camera that this user may open (udev rules)");
  }

  k4a::OpenDevice open_by_number(std::uint32_t number) const {
    k4a::Device device = nullptr;
    if (k4a_.device_open(number, &device) != k4a::succeeded) device = nullptr;
    return {device, {&k4a_}};
  }

  // Returns the serial number; empty if the device does not report one.
  std::string serial_of(k4a::Device device) const {
    std::array<char, 64> serial{};
    std::size_t size = serial.size() - 1;
    if (k4a_.device_get_serialnum(device, serial.data(), &size) != k4a::succeeded) return {};
    return serial.data();
  }

  void find_by_serial(const std::string& serial, std::uint32_t count) {
    std::string known;
    for (std::uint32_t number = 0; number < count; ++number) {
      k4a::OpenDevice device = open_by_number(number);
      const std::string its = device ? serial_of(device.get()) : "one that cannot be opened" + reason();
      if (device && its == serial) {
        device_ = std::move(device);
        return;
      }
      known += (known.empty() ? "" : ", ") + (its.empty() ? "one without serial number" : its);
    }
    refuse("no camera has this serial number: expected " + known + ", or its number from 0 on");
  }

  void calibrate() {
    if (k4a_.device_get_calibration(device_.get(), address_.mode.depth, k4a::colour_off, &calibration_) !=
        k4a::succeeded)
      refuse("does not report its calibration" + reason());
    undistortion_.emplace(address_.name, address_.mode.width, address_.mode.height, lens());
    view_.camera = undistortion_->camera();
    view_.metres_per_unit = 0.001;
    view_.frame_rate_hz = address_.mode.rate_hz;
  }

  Lens lens() const {
    const auto pixel_of = [this](const Eigen::Vector2d& ray) -> std::optional<Eigen::Vector2d> {
      const k4a::Float3 point{static_cast<float>(ray.x()), static_cast<float>(ray.y()), 1};
      k4a::Float2 pixel{};
      int is_valid = 0;
      if (k4a_.calibration_3d_to_2d(&calibration_, &point, k4a::depth_camera, k4a::depth_camera, &pixel,
                                    &is_valid) != k4a::succeeded ||
          is_valid == 0)
        return {};
      return Eigen::Vector2d(pixel.x, pixel.y);
    };
    const auto ray_of = [this](const Eigen::Vector2d& at) -> std::optional<Eigen::Vector2d> {
      const k4a::Float2 pixel{static_cast<float>(at.x()), static_cast<float>(at.y())};
      k4a::Float3 point{};
      int is_valid = 0;
      if (k4a_.calibration_2d_to_3d(&calibration_, &pixel, 1, k4a::depth_camera, k4a::depth_camera, &point,
                                    &is_valid) != k4a::succeeded ||
          is_valid == 0)
        return {};
      return Eigen::Vector2d(point.x, point.y);
    };
    return {pixel_of, ray_of};
  }

  // Called last in the constructor, because only the destructor stops the camera.
  void start() {
    k4a::Configuration configuration;
    configuration.depth_mode = address_.mode.depth;
    configuration.camera_fps = address_.mode.fps;
    if (k4a_.device_start_cameras(device_.get(), &configuration) != k4a::succeeded)
      refuse(
          "depth does not start" + reason() +
          ": expected the vendor's depth engine where the loader finds it, and a camera at USB 3 that no other program holds");
  }

  [[noreturn]] void refuse(const std::string& problem) const { throw InputError(address_.name, problem); }

  // Returns the library's reason, to be appended to a message; empty if it gave none.
  std::string reason() const {
    const std::string said = k4a_.pop_first_error();
    return said.empty() ? "" : " (the library says: " + said + ")";
  }

  // Empties the library's queue, because the library returns the oldest capture first.
  k4a::HeldCapture newest(double timeout_s, double& arrived_s) {
    k4a::HeldCapture capture(nullptr, {&k4a_});
    auto timeout_ms = static_cast<std::int32_t>(std::clamp(std::ceil(1e3 * timeout_s), 0.0, 60e3));
    for (int i = 0; i < kMaxQueue; ++i) {
      k4a::Capture next = nullptr;
      const k4a::WaitResult result = k4a_.device_get_capture(device_.get(), &next, timeout_ms);
      if (result == k4a::wait_succeeded && next != nullptr) {
        capture.reset(next);
        arrived_s = host_.now_s();
        timeout_ms = 0;
        continue;
      }
      // If there is a capture already, the next call reports the failure.
      if (result != k4a::wait_timeout && !capture)
        fail("was disconnected, or its depth engine has stopped" + reason());
      break;
    }
    return capture;
  }

  // Copies the capture into the frame. Returns false if there is no new frame, or after a failure.
  bool take(k4a::Capture capture, double arrived_s, SensorFrame& frame) {
    const k4a::HeldImage image(k4a_.capture_get_depth_image(capture), {&k4a_});
    if (!image) return false;
    const double stamp_s = 1e-6 * static_cast<double>(k4a_.image_get_device_timestamp_us(image.get()));
    if (stamp_s_ && stamp_s == *stamp_s_) return false;  // the same frame as before
    const PixelRows rows{k4a_.image_get_buffer(image.get()),
                         k4a_.image_get_size(image.get()),
                         k4a_.image_get_width_pixels(image.get()),
                         k4a_.image_get_height_pixels(image.get()),
                         static_cast<std::size_t>(std::max(k4a_.image_get_stride_bytes(image.get()), 0)),
                         false};
    if (k4a_.image_get_format(image.get()) != k4a::depth16 || !copy_depth(rows, view_.camera, seen_)) {
      fail("a frame is " + std::to_string(rows.width) + " x " + std::to_string(rows.height) + " pixels in " +
           std::to_string(rows.bytes) + " bytes of format " +
           std::to_string(k4a_.image_get_format(image.get())) + ": expected those of the camera's mode");
      return false;
    }
    undistortion_->apply(seen_, frame.depth);
    frame.colour.clear();
    frame.number = numbers_.next(stamp_s_ ? std::round((stamp_s - *stamp_s_) * view_.frame_rate_hz) : 1);
    frame.captured_s = clock_.captured_s(stamp_s, arrived_s);
    stamp_s_ = stamp_s;
    return true;
  }

  void fail(const std::string& reason_told) { failure_ = printable(address_.name + ": " + reason_told); }

  const Clock& host_;
  const K4aAddress address_;
  const k4a::K4aLibrary k4a_;
  k4a::OpenDevice device_{nullptr, {&k4a_}};
  k4a::Calibration calibration_{};
  std::optional<Undistortion> undistortion_;
  SensorClock clock_;
  FrameNumbers numbers_;
  std::optional<double> stamp_s_;  // time stamp of the frame before
  std::vector<std::uint16_t> seen_;
};

}  // namespace

std::unique_ptr<DepthSource> open_k4a(const std::string& address, Clock& clock) {
  return std::make_unique<K4aCamera>(address, clock);
}

Availability k4a_availability() {
  return availability_of([] {
    const k4a::K4aLibrary k4a;
    const std::uint32_t count = k4a.device_get_installed_count();
    const bool found = count > 0 && count <= kMaxCameras;
    return Availability{
        .found = found,
        .detail = k4a.library.file() + ": " +
                  (found ? std::to_string(count) + (count == 1 ? " camera" : " cameras")
                         : "no camera is plugged in, or this user may not open its USB port")};
  });
}

}  // namespace remote_touch
