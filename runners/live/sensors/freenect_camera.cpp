#include "runners/live/sensors/depth_source.h"

#include "core/parameters/parameter.h"

#ifdef REMOTE_TOUCH_FREENECT
#include <libfreenect.h>
#include <signal.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#endif

namespace remote_touch {

#ifndef REMOTE_TOUCH_FREENECT

std::unique_ptr<DepthSource> open_freenect(const std::string&, Clock&) {
  throw InputError("freenect", freenect_availability().detail);
}

Availability freenect_availability() {
  return {.compiled_in = false, .detail = "not compiled in: install libfreenect-dev and build again"};
}

#else

namespace {

// Only functions that fakenect has too may be called here. It lacks freenect_set_flag(), so the flags keep
// their initial values: no image is mirrored.

// Nominal focal lengths in pixels: registered depth is seen by the colour camera, other depth by the infrared
// one.
constexpr double kColourFocalLength = 525, kInfraredFocalLength = 575.8;
constexpr double kTicksPerSecond = 60e6;
constexpr double kTicksPerTurn = 4294967296.0;  // the stamps have 32 bits: 72 s

struct Shutdown {
  void operator()(freenect_context* context) const { freenect_shutdown(context); }
};
struct Close {
  void operator()(freenect_device* device) const { freenect_close_device(device); }
};
using Context = std::unique_ptr<freenect_context, Shutdown>;

Context start_library() {
  freenect_context* context = nullptr;
  const int code = freenect_init(&context, nullptr);
  if (code < 0 || context == nullptr)
    throw InputError("freenect", "does not start (libusb says " + std::to_string(code) +
                                     "): expected a machine with USB that this user may open (udev rules)");
  freenect_set_log_level(context, FREENECT_LOG_FATAL);  // return values report the errors
  // The other subdevices need firmware, or belong to other programs.
  freenect_select_subdevices(context, FREENECT_DEVICE_CAMERA);
  return Context(context);
}

int number_of(const std::string& address) {
  int number = 0;
  const char *first = address.data(), *last = first + address.size();
  const auto [end, error] = std::from_chars(first, last, number);
  if (address.empty()) return 0;
  if (error != std::errc{} || end != last || number < 0)
    throw InputError("freenect:" + address, "no camera has this number: expected 0, 1, ...");
  return number;
}

// Enumerates the modes, because the library's own search by format ends the program under fakenect.
template <class IsWanted>
std::optional<freenect_frame_mode> mode_of(int count, freenect_frame_mode (*mode_at)(int),
                                           IsWanted is_wanted) {
  for (int i = 0; i < count; ++i)
    if (const freenect_frame_mode mode = mode_at(i);
        mode.is_valid && mode.resolution == FREENECT_RESOLUTION_MEDIUM && is_wanted(mode))
      return mode;
  return {};
}

std::optional<freenect_frame_mode> depth_mode(freenect_depth_format format) {
  return mode_of(freenect_get_depth_mode_count(), freenect_get_depth_mode,
                 [&](const freenect_frame_mode& mode) { return mode.depth_format == format; });
}

std::optional<freenect_frame_mode> colour_mode() {
  return mode_of(freenect_get_video_mode_count(), freenect_get_video_mode,
                 [](const freenect_frame_mode& mode) { return mode.video_format == FREENECT_VIDEO_RGB; });
}

// The sensor measures the shift of a light pattern from its position on a plane at 1.2 m. The projector is
// 75 mm to the side; the unit is a quarter of a pixel, which is 1.042 mm wide on that plane. These values are
// nominal as well.
constexpr int kShifts = 2048;
std::array<std::uint16_t, kShifts> depth_of_shifts() {
  constexpr double kPlane_mm = 1200, kBase_mm = 75, kPixel_mm = 1.042, kMaxDepth_mm = 10000;
  std::array<std::uint16_t, kShifts> depth_mm{};
  for (int shift = 0; shift + 1 < kShifts; ++shift) {  // the last value means that nothing was measured
    const double shift_mm = ((shift - 800) / 4.0 - 0.375) * kPixel_mm;
    const double z_mm = kPlane_mm * kBase_mm / (kBase_mm - shift_mm);
    if (z_mm > 0 && z_mm < kMaxDepth_mm) depth_mm[shift] = static_cast<std::uint16_t>(z_mm);
  }
  return depth_mm;
}

class FreenectCamera final : public DepthSource {
 public:
  FreenectCamera(const std::string& address, const Clock& host) : host_(host) {
    open_device(address);
    choose_modes();
    start();
  }

  ~FreenectCamera() override {
    thread_.request_stop();
    thread_.join();
    if (view_.has_colour) freenect_stop_video(device_.get());
    freenect_stop_depth(device_.get());
  }

  SensorState next(SensorFrame& frame, double timeout_s) override {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                      [this] { return is_new_ || !failure_.empty(); });
    if (is_new_) {
      std::swap(frame, newest_);
      is_new_ = false;
      return SensorState::frame;
    }
    return failure_.empty() ? SensorState::waiting : SensorState::failed;
  }

 private:
  void open_device(const std::string& address) {
    const int number = number_of(address);
    name_ = "freenect:" + std::to_string(number);
    context_ = start_library();
    const int count = freenect_num_devices(context_.get());
    if (number >= count)
      throw InputError(name_,
                       (count <= 0 ? std::string("no Kinect is plugged in")
                                   : std::to_string(count) + " Kinects are plugged in, numbered from 0") +
                           ": expected one that this user may open (lsusb, udev rules)");
    freenect_device* device = nullptr;
    const int code = freenect_open_device(context_.get(), &device, number);
    if (code < 0)
      throw InputError(name_, "cannot be opened (libusb says " + std::to_string(code) +
                                  "); another program or the kernel's module gspca_kinect may hold it");
    device_.reset(device);
  }

  void choose_modes() {
    const std::optional<freenect_frame_mode> registered = depth_mode(FREENECT_DEPTH_REGISTERED);
    const std::optional<freenect_frame_mode> colour = colour_mode();
    std::optional<freenect_frame_mode> depth = registered;
    if (!depth) depth = depth_mode(FREENECT_DEPTH_MM);
    if (!depth) {
      depth = depth_mode(FREENECT_DEPTH_11BIT);
      gives_shifts_ = true;
      depth_of_shift_ = depth_of_shifts();
    }
    if (!depth || depth->bytes != 2 * depth->width * depth->height)
      throw InputError(name_, "the library has no depth mode of 640 x 480 pixels in 16 bits");
    if (freenect_set_depth_mode(device_.get(), *depth) < 0)
      throw InputError(name_, "the camera refuses its depth mode");
    depth_mode_ = *depth;
    view_.has_colour = registered && colour && colour->bytes == 3 * depth->width * depth->height &&
                       freenect_set_video_mode(device_.get(), *colour) >= 0;
    if (view_.has_colour) colour_mode_ = *colour;
    const double focal_length = registered ? kColourFocalLength : kInfraredFocalLength;
    view_.camera = {depth->width,
                    depth->height,
                    focal_length,
                    focal_length,
                    0.5 * (depth->width - 1),
                    0.5 * (depth->height - 1)};
    view_.frame_rate_hz = depth->framerate;
  }

  void start() {
    freenect_set_user(device_.get(), this);
    freenect_set_depth_callback(device_.get(),
                                [](freenect_device* device, void* pixels, std::uint32_t ticks) {
                                  of(device).depth_came(pixels, ticks);
                                });
    freenect_set_video_callback(device_.get(), [](freenect_device* device, void* pixels, std::uint32_t) {
      of(device).colour_came(pixels);
    });
    if (freenect_start_depth(device_.get()) < 0) throw InputError(name_, "depth does not start");
    if (view_.has_colour && freenect_start_video(device_.get()) < 0) view_.has_colour = false;
    // Signals are blocked in the new thread: the program's other threads handle them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::jthread([this](const std::stop_token& stop) { process_events(stop); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  void process_events(const std::stop_token& stop) {
    int code = 0;
    while (!stop.stop_requested() && code >= 0) {
      timeval wait{0, 100'000};
      code = freenect_process_events_timeout(context_.get(), &wait);
    }
    if (code >= 0) return;
    const std::lock_guard lock(mutex_);
    failure_ = name_ + ": no more frames (error " + std::to_string(code) +
               " of the library): the camera was disconnected, or a recording of fakenect has ended";
    changed_.notify_one();
  }

  static FreenectCamera& of(freenect_device* device) {
    return *static_cast<FreenectCamera*>(freenect_get_user(device));
  }

  void depth_came(const void* pixels, std::uint32_t ticks) {
    const double arrived_s = host_.now_s();
    const double captured_s = clock_.captured_s(stamp_s(ticks, arrived_s), arrived_s);
    const auto width = static_cast<std::size_t>(view_.camera.width);
    const auto bytes = static_cast<std::size_t>(depth_mode_.bytes);
    const std::lock_guard lock(mutex_);
    copy_depth({pixels, bytes, depth_mode_.width, depth_mode_.height, 2 * width}, view_.camera,
               newest_.depth);
    if (gives_shifts_)
      for (std::uint16_t& value : newest_.depth) value = value < kShifts ? depth_of_shift_[value] : 0;
    newest_.colour = colour_;
    newest_.number = ++number_;
    newest_.captured_s = captured_s;
    is_new_ = true;
    changed_.notify_one();
  }

  void colour_came(const void* pixels) {
    const auto width = static_cast<std::size_t>(view_.camera.width);
    const auto bytes = static_cast<std::size_t>(colour_mode_.bytes);
    copy_rgb({pixels, bytes, colour_mode_.width, colour_mode_.height, 3 * width}, view_.camera, colour_);
  }

  // The time stamps wrap every 72 s. The number of wraps between two frames follows from the host's clock.
  double stamp_s(std::uint32_t ticks, double arrived_s) {
    const double passed_s = static_cast<double>(ticks - ticks_) / kTicksPerSecond;
    const double turn_s = kTicksPerTurn / kTicksPerSecond;
    const double turns = number_ == 0 ? 0 : std::round((arrived_s - arrived_s_ - passed_s) / turn_s);
    stamp_s_ += passed_s + std::max(turns, 0.0) * turn_s;
    ticks_ = ticks, arrived_s_ = arrived_s;
    return stamp_s_;
  }

  const Clock& host_;
  std::string name_;
  Context context_;
  std::unique_ptr<freenect_device, Close> device_;
  freenect_frame_mode depth_mode_{}, colour_mode_{};
  std::array<std::uint16_t, kShifts> depth_of_shift_{};  // used if the sensor sends shifts
  bool gives_shifts_ = false;

  // Members used only by the thread that processes events.
  SensorClock clock_;
  std::uint32_t ticks_ = 0;
  double stamp_s_ = 0, arrived_s_ = 0;
  int number_ = 0;
  std::vector<std::uint32_t> colour_;

  std::mutex mutex_;  // guards the following members, and failure_ until next() has seen it
  std::condition_variable changed_;
  SensorFrame newest_;
  bool is_new_ = false;

  std::jthread thread_;
};

}  // namespace

std::unique_ptr<DepthSource> open_freenect(const std::string& address, Clock& clock) {
  return std::make_unique<FreenectCamera>(address, clock);
}

Availability freenect_availability() {
  return availability_of([] {
    const int count = freenect_num_devices(start_library().get());
    return Availability{.found = count > 0,
                        .detail = count <= 0 ? "no Kinect is plugged in"
                                             : std::to_string(count) + (count == 1 ? " Kinect" : " Kinects")};
  });
}

#endif

}  // namespace remote_touch
