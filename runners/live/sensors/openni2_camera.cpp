#include "runners/live/sensors/depth_source.h"

#include "core/parameters/parameter.h"

#ifdef REMOTE_TOUCH_OPENNI2
#include <OpenNI.h>
#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "runners/libraries/shared_library.h"
#endif

namespace remote_touch {

#ifndef REMOTE_TOUCH_OPENNI2

std::unique_ptr<DepthSource> open_openni2(const std::string&, Clock&) {
  throw InputError("openni2", openni2_availability().detail);
}

Availability openni2_availability() {
  return {.compiled_in = false, .detail = "not compiled in: install libopenni2-dev and build again"};
}

#else

namespace {

namespace fs = std::filesystem;

// The library counts its users, but not safely between threads.
std::mutex& count_mutex() {
  static std::mutex one;
  return one;
}

// Returns the library's own text for its last error, in one line.
std::string error_text() {
  std::string text = openni::OpenNI::getExtendedError();
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? "no reason given" : text;
}

// Returns the folder in which the library searches for drivers. It is beside the library's file.
std::string driver_folder() {
  Dl_info info{};
  void* symbol = dlsym(RTLD_DEFAULT, "oniInitialize");
  if (symbol == nullptr || dladdr(symbol, &info) == 0) return "OpenNI2/Drivers";
  return (fs::path(info.dli_fname).parent_path() / "OpenNI2/Drivers").string();
}

bool is_file(const std::string& address) {
  std::error_code ignored;
  return fs::is_regular_file(address, ignored);
}

// Keeps the library initialised while an object of this class exists. Any thread may make an object.
class Library {
 public:
  // Throws InputError if it cannot be initialised.
  Library() {
    const std::lock_guard lock(count_mutex());
    if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
    const std::string reason = error_text();
    openni::OpenNI::shutdown();
    throw InputError("openni2",
                     "does not start (" + reason + "): expected drivers (lib*.so.0) in " + driver_folder());
  }
  ~Library() {
    const std::lock_guard lock(count_mutex());
    openni::OpenNI::shutdown();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Returns the cameras, without open recordings, which the library also lists as devices.
  std::vector<openni::DeviceInfo> cameras() const {
    openni::Array<openni::DeviceInfo> devices;
    openni::OpenNI::enumerateDevices(&devices);
    std::vector<openni::DeviceInfo> found;
    for (int i = 0; i < devices.getSize(); ++i)
      if (!is_file(devices[i].getUri())) found.push_back(devices[i]);
    return found;
  }
};

// A thread of the driver notifies this object when the camera with this URI was unplugged.
class LossListener : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit LossListener(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  ~LossListener() override { openni::OpenNI::removeDeviceDisconnectedListener(this); }

  bool is_lost() const { return is_lost_; }
  void onDeviceDisconnected(const openni::DeviceInfo* device) override {
    if (uri_ == device->getUri()) is_lost_ = true;
  }

 private:
  const std::string uri_;
  std::atomic<bool> is_lost_ = false;
};

// Waits at most timeout_ms for a frame. Returns STATUS_OK if one is available.
openni::Status wait_for(openni::VideoStream& stream, int timeout_ms) {
  openni::VideoStream* streams[] = {&stream};
  int which = 0;
  return openni::OpenNI::waitForAnyStream(streams, 1, &which, timeout_ms);
}

// Returns the newest frame, which must be available; an invalid one on failure. VideoStream::readFrame()
// would use an uninitialised pointer when it fails.
openni::VideoFrameRef read_from(const openni::VideoStream& stream) {
  openni::VideoFrameRef frame;
  OniFrame* raw = nullptr;
  if (oniStreamReadFrame(stream._getHandle(), &raw) != ONI_STATUS_OK || raw == nullptr) return frame;
  frame._setFrame(raw);  // counts one more user
  oniFrameRelease(raw);
  return frame;
}

// A longer pause means that a recording is damaged, because its player shortens pauses to 2 s.
constexpr double kMaxPause_s = 5;
// A slow machine may miss this much of the end of a recording.
constexpr double kMaxMissed_s = 0.5;

// Returns 0 if the depth is not a distance along the axis, but the shift that the sensor measures.
double metres_per_unit(openni::PixelFormat format) {
  if (format == openni::PIXEL_FORMAT_DEPTH_1_MM) return 0.001;
  if (format == openni::PIXEL_FORMAT_DEPTH_100_UM) return 0.0001;
  return 0;
}

// Returns the accepted mode of the greatest rank; none if no mode is accepted.
template <class Accept, class Rank>
std::optional<openni::VideoMode> best_mode(const openni::VideoStream& stream, Accept accept, Rank rank) {
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  std::optional<openni::VideoMode> best;
  for (int i = 0; i < modes.getSize(); ++i)
    if (accept(modes[i]) && (!best || rank(*best) < rank(modes[i]))) best.emplace(modes[i]);
  return best;
}

std::optional<openni::VideoMode> best_depth_mode(const openni::VideoStream& stream) {
  return best_mode(
      stream, [](const openni::VideoMode& mode) { return metres_per_unit(mode.getPixelFormat()) > 0; },
      [](const openni::VideoMode& mode) {
        return std::tuple(mode.getResolutionX() <= 640, -std::abs(mode.getFps() - 30), mode.getResolutionX(),
                          mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM);
      });
}

std::optional<openni::VideoMode> best_colour_mode(const openni::VideoStream& stream,
                                                  const openni::VideoMode& depth) {
  return best_mode(
      stream,
      [&](const openni::VideoMode& mode) {
        return mode.getPixelFormat() == openni::PIXEL_FORMAT_RGB888 &&
               mode.getResolutionX() == depth.getResolutionX() &&
               mode.getResolutionY() == depth.getResolutionY();
      },
      [&](const openni::VideoMode& mode) { return -std::abs(mode.getFps() - depth.getFps()); });
}

PixelRows rows_of(const openni::VideoFrameRef& frame, bool is_mirrored) {
  return {
      frame.getData(),   static_cast<std::size_t>(std::max(frame.getDataSize(), 0)),      frame.getWidth(),
      frame.getHeight(), static_cast<std::size_t>(std::max(frame.getStrideInBytes(), 0)), is_mirrored};
}

class Openni2Camera final : public DepthSource {
 public:
  Openni2Camera(const std::string& address, const Clock& host) : host_(host) {
    open_device(address);
    loss_.emplace(device_.getDeviceInfo().getUri());
    open_depth();
    view_.has_colour = open_colour();
    // Registered depth has the view of the colour camera.
    describe(view_.has_colour ? colour_ : depth_);
    if (depth_.start() != openni::STATUS_OK)
      refuse("depth does not start (" + error_text() + "); another program may be using the camera");
    last_sign_s_ = host_.now_s();
  }

  // Waits for a first frame of a recording, which shows that the player's thread has begun. A player that is
  // closed before that continues for 3 s and is then killed.
  ~Openni2Camera() override {
    if (frame_count_ > 0 && last_number_ == 0) wait_for(depth_, 500);
  }

  SensorState next(SensorFrame& frame, double timeout_s) override {
    if (!failure_.empty()) return SensorState::failed;
    if (has_ended_) return SensorState::ended;
    const double deadline_s = host_.now_s() + timeout_s;
    while (true) {
      if (loss_->is_lost()) return fail("was disconnected");
      const double remaining_s = deadline_s - host_.now_s();
      // Waits in parts of at most 50 ms, because the loss of a camera does not end a wait. 0 does not wait.
      const double part_ms = std::clamp(std::ceil(1e3 * remaining_s), 0.0, 50.0);
      const openni::Status status = wait_for(depth_, static_cast<int>(part_ms));
      if (status == openni::STATUS_OK) return take(frame);
      if (status != openni::STATUS_TIME_OUT) return fail("waiting for a frame failed (" + error_text() + ")");
      if (frame_count_ > 0 && host_.now_s() - last_sign_s_ > kMaxPause_s) return fail_of_damage();
      if (remaining_s <= 0) return SensorState::waiting;
    }
  }

 private:
  void open_device(const std::string& address) {
    const std::vector<openni::DeviceInfo> cameras = library_.cameras();
    name_ = address.empty() || address == "any" ? "openni2" : address;
    std::string uri = address;
    if (name_ == "openni2") {
      if (cameras.empty())
        refuse(
            "no camera that a driver in " + driver_folder() +
            " knows: expected one that is plugged in and that this user may open (lsusb, udev rules), or an "
            ".oni file");
      uri = cameras.front().getUri();
    } else if (!is_file(address)) {
      // Only listed cameras are opened: with other addresses one of the drivers crashes.
      std::string known;
      for (const openni::DeviceInfo& camera : cameras) known += std::string(", ") + camera.getUri();
      if (known.find(", " + address) == std::string::npos)
        refuse("neither a file nor a camera that a driver in " + driver_folder() + " knows: expected any" +
               known);
    }
    if (device_.open(uri.c_str()) != openni::STATUS_OK)
      refuse("cannot be opened (" + error_text() + ")" +
             (is_file(uri) ? ": expected a whole .oni recording" : ""));
  }

  void open_depth() {
    if (depth_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK)
      refuse("has no depth (" + error_text() + "): expected a depth camera or a recording of one");
    if (!device_.isFile()) {
      const std::optional<openni::VideoMode> mode = best_depth_mode(depth_);
      if (mode && depth_.setVideoMode(*mode) != openni::STATUS_OK)
        refuse("refuses its own mode: " + error_text());
    }
    mode_ = depth_.getVideoMode();
    view_.metres_per_unit = metres_per_unit(mode_.getPixelFormat());
    if (view_.metres_per_unit == 0) refuse("depth is in no unit of length: expected 1 mm or 0.1 mm");
    depth_.setMirroringEnabled(false);
    depth_is_mirrored_ = depth_.getMirroringEnabled();  // a recording may stay mirrored
    if (!device_.isFile()) return;
    frame_count_ = device_.getPlaybackControl()->getNumberOfFrames(depth_);
    if (frame_count_ <= 0)
      refuse("is not a complete depth recording: expected one whose recorder was closed");
  }

  // Opens colour if depth can be registered to it. Returns false if colour cannot be used.
  bool open_colour() {
    const auto registered = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    if (device_.isFile() || !device_.hasSensor(openni::SENSOR_COLOR) ||
        !device_.isImageRegistrationModeSupported(registered))
      return false;
    if (colour_.create(device_, openni::SENSOR_COLOR) != openni::STATUS_OK) return false;
    const std::optional<openni::VideoMode> mode = best_colour_mode(colour_, mode_);
    if (mode && colour_.setVideoMode(*mode) == openni::STATUS_OK &&
        device_.setImageRegistrationMode(registered) == openni::STATUS_OK) {
      colour_.setMirroringEnabled(false);
      colour_is_mirrored_ = colour_.getMirroringEnabled();
      if (colour_.start() == openni::STATUS_OK) return true;
      device_.setImageRegistrationMode(openni::IMAGE_REGISTRATION_OFF);
    }
    colour_.destroy();
    return false;
  }

  void describe(const openni::VideoStream& seen_by) {
    const double across = seen_by.getHorizontalFieldOfView(), down = seen_by.getVerticalFieldOfView();
    if (!(across > 0 && across < M_PI && down > 0 && down < M_PI))
      refuse("reports no field of view: the rays of its pixels are unknown");
    const int width = mode_.getResolutionX(), height = mode_.getResolutionY();
    if (width <= 0 || height <= 0) refuse("reports no image size");
    // The field of view ends at the outer edges of the pixels, half a pixel beyond their centres.
    view_.camera = {width,
                    height,
                    0.5 * width / std::tan(0.5 * across),
                    0.5 * height / std::tan(0.5 * down),
                    0.5 * (width - 1),
                    0.5 * (height - 1)};
    view_.frame_rate_hz = mode_.getFps();
  }

  [[noreturn]] void refuse(const std::string& problem) const { throw InputError(name_, problem); }

  SensorState take(SensorFrame& frame) {
    const openni::VideoFrameRef taken = read_from(depth_);
    if (!taken.isValid()) return fail("a frame cannot be read (" + error_text() + ")");
    const double arrived_s = last_sign_s_ = host_.now_s();
    // The colour frame is read at once, before the next one replaces it.
    if (view_.has_colour && wait_for(colour_, openni::TIMEOUT_NONE) == openni::STATUS_OK)
      colour_frame_ = read_from(colour_);
    const int number = taken.getFrameIndex();
    if (frame_count_ > 0 && number <= last_number_) return begins_anew();
    if (!copy_depth(rows_of(taken, depth_is_mirrored_), view_.camera, frame.depth))
      return fail("frame " + std::to_string(number) + " is " + std::to_string(taken.getWidth()) + " x " +
                  std::to_string(taken.getHeight()) + " pixels in " + std::to_string(taken.getDataSize()) +
                  " bytes: expected those of the camera's mode");
    frame.number = last_number_ = number;
    frame.captured_s = clock_.captured_s(1e-6 * static_cast<double>(taken.getTimestamp()), arrived_s);
    if (!copy_colour(taken.getTimestamp(), frame))
      return fail("a colour frame has another size than its mode");
    if (frame_count_ > 0 && number >= frame_count_) end();
    return SensorState::frame;
  }

  // Copies the newest colour frame if its time differs from that of the depth by at most 1.1 periods.
  // Otherwise the frame has no colour. Returns false if the size of the colour frame is wrong.
  bool copy_colour(std::uint64_t depth_stamp, SensorFrame& frame) {
    frame.colour.clear();
    if (!colour_frame_.isValid()) return true;
    const double apart_s =
        1e-6 * std::abs(static_cast<double>(colour_frame_.getTimestamp()) - static_cast<double>(depth_stamp));
    if (apart_s * view_.frame_rate_hz > 1.1) return true;
    return copy_rgb(rows_of(colour_frame_, colour_is_mirrored_), view_.camera, frame.colour);
  }

  SensorState fail(const std::string& reason) {
    failure_ = name_ + ": " + reason;
    return SensorState::failed;
  }

  SensorState fail_of_damage() {
    return fail("cannot be played beyond frame " + std::to_string(last_number_) + " of " +
                std::to_string(frame_count_) + ": expected an undamaged recording");
  }

  // Handles a recording that starts again from its first frame. The player does so at the end, because a
  // player that is set to stop there sometimes crashes when it is closed. The player also does so if it
  // cannot find a frame; then the recording is damaged.
  SensorState begins_anew() {
    const int missed = frame_count_ - last_number_;
    if (missed <= kMaxMissed_s * view_.frame_rate_hz) return end();
    depth_.stop();
    return fail_of_damage();
  }

  SensorState end() {
    has_ended_ = true;
    depth_.stop();  // else the player continues in the background
    return SensorState::ended;
  }

  const Clock& host_;
  // The following members are closed from the last to the first.
  Library library_;
  std::string name_;
  openni::Device device_;
  std::optional<LossListener> loss_;
  openni::VideoStream depth_, colour_;
  openni::VideoFrameRef colour_frame_;  // the newest colour frame

  openni::VideoMode mode_;
  bool depth_is_mirrored_ = false, colour_is_mirrored_ = false;
  int frame_count_ = 0;  // number of frames of a recording; 0: a camera
  SensorClock clock_;
  int last_number_ = 0;
  double last_sign_s_ = 0;  // time of the newest frame, or of the start
  bool has_ended_ = false;
};

// The library remembers every thread that ever called it. In each call it checks whether these threads still
// exist, and crashes if the memory of an ended thread was freed. So all calls come from a thread that lasts.
class LastingOpenni2Camera final : public DepthSource {
 public:
  LastingOpenni2Camera(const std::string& address, const Clock& host) : thread_(lasting_thread()) {
    thread_->run([&] { camera_ = std::make_unique<Openni2Camera>(address, host); });
    view_ = camera_->view();
  }
  ~LastingOpenni2Camera() override {
    thread_->run([&] { camera_.reset(); });
  }

  SensorState next(SensorFrame& frame, double timeout_s) override {
    SensorState state = SensorState::failed;
    thread_->run([&] { state = camera_->next(frame, timeout_s); });
    failure_ = camera_->failure();
    return state;
  }

 private:
  const std::shared_ptr<LastingThread> thread_;
  std::unique_ptr<Openni2Camera> camera_;
};

Availability found_cameras() {
  const Library library;
  const std::vector<openni::DeviceInfo> cameras = library.cameras();
  if (cameras.empty()) return {.detail = "no camera that a driver in " + driver_folder() + " knows"};
  std::string names;
  for (const openni::DeviceInfo& camera : cameras)
    names += (names.empty() ? "" : ", ") + std::string(camera.getName()) + " (" + camera.getUri() + ")";
  return {.found = true, .detail = names};
}

}  // namespace

std::unique_ptr<DepthSource> open_openni2(const std::string& address, Clock& clock) {
  return std::make_unique<LastingOpenni2Camera>(address, clock);
}

Availability openni2_availability() {
  Availability found;
  lasting_thread()->run([&] { found = availability_of(found_cameras); });
  return found;
}

#endif

}  // namespace remote_touch

#if defined(__SANITIZE_THREAD__) && defined(REMOTE_TOUCH_OPENNI2)
// The thread sanitizer does not understand the library's locks, so it must ignore them from the moment at
// which the library is loaded.
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\nmutex:libOniFile.so\ndeadlock:libOpenNI2.so\ndeadlock:libOniFile.so\n";
}
#endif
