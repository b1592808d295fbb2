// A camera that exists only here, as a driver for the run-time library of OpenNI 2. It shows a pattern at 30
// Hz. The environment variable VIRTUAL_CAMERA controls it, with words that are separated by commas:
//   absent           no camera is plugged in
//   stop_after=N     sends no frame after frame N, which is not missing
//   small_after=N    depth after frame N has half of the rows
//   stays_mirrored   shows a mirrored image, whatever mirroring is set
//   unregistered     does not register depth to colour
// The library's own headers need allocation macros that no package ships. The two below are enough.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#include "tests/doubles/virtual_openni2/virtual_camera.h"

namespace remote_touch::virtual_camera {
namespace {

std::atomic<int> sent{0};  // the number of the newest frame; 0: none since the camera was opened
std::atomic<bool> is_unplugged{false};

// Returns the number after the word, 1 if the word has no number, and 0 if the word is missing.
int option(const std::string& word) {
  const char* variable = std::getenv("VIRTUAL_CAMERA");
  const std::string text = std::string(",") + (variable ? variable : "") + ",";
  const std::size_t at = text.find("," + word);
  if (at == std::string::npos) return 0;
  const std::size_t end = at + 1 + word.size();
  return text[end] == '=' ? std::atoi(text.c_str() + end + 1) : 1;
}

template <class Value>
OniStatus give(const Value& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof value)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof value);
  *size = sizeof value;
  return ONI_STATUS_OK;
}

OniDeviceInfo device_info() {
  OniDeviceInfo info{};
  std::strcpy(info.uri, "virtual-camera");
  std::strcpy(info.vendor, "Remote Touch");
  std::strcpy(info.name, "Virtual camera");
  return info;
}

// A mode that is never to be chosen comes first, as real cameras have one.
OniVideoMode depth_modes[] = {{ONI_PIXEL_FORMAT_SHIFT_9_2, kWidth, kHeight, kRate_hz},
                              {ONI_PIXEL_FORMAT_DEPTH_1_MM, kWidth / 2, kHeight / 2, kRate_hz},
                              {ONI_PIXEL_FORMAT_DEPTH_1_MM, kWidth, kHeight, kRate_hz},
                              {ONI_PIXEL_FORMAT_DEPTH_100_UM, kWidth, kHeight, kRate_hz}};
OniVideoMode colour_modes[] = {{ONI_PIXEL_FORMAT_YUV422, kWidth, kHeight, kRate_hz},
                               {ONI_PIXEL_FORMAT_RGB888, kWidth, kHeight, kRate_hz}};
OniSensorInfo sensors[] = {{ONI_SENSOR_DEPTH, 4, depth_modes}, {ONI_SENSOR_COLOR, 2, colour_modes}};

class Device;

class Stream : public oni::driver::StreamBase {
 public:
  Stream(Device& device, bool is_depth) : device_(device), is_depth_(is_depth) {
    mode_ = is_depth ? depth_modes[0] : colour_modes[0];
    is_mirrored_ = true;  // real cameras mirror too
  }
  ~Stream() override { Stream::stop(); }

  OniBool isPropertySupported(int property) override {
    return property == ONI_STREAM_PROPERTY_VIDEO_MODE || property == ONI_STREAM_PROPERTY_MIRRORING ||
           property == ONI_STREAM_PROPERTY_CROPPING || property == ONI_STREAM_PROPERTY_STRIDE ||
           property == ONI_STREAM_PROPERTY_HORIZONTAL_FOV || property == ONI_STREAM_PROPERTY_VERTICAL_FOV ||
           property == ONI_STREAM_PROPERTY_MAX_VALUE;
  }
  OniStatus getProperty(int property, void* data, int* size) override;
  OniStatus setProperty(int property, const void* data, int size) override;
  OniStatus start() override;
  void stop() override;

  OniFrame* see(int number);
  void send(OniFrame* frame);

 private:
  int pixel_bytes() const { return is_depth_ ? 2 : 3; }
  void draw(int number, std::uint8_t* to) const;

  Device& device_;
  const bool is_depth_;
  OniVideoMode mode_{};
  bool is_mirrored_ = false;
};

// One thread sends the frames of both streams, colour first.
class Device : public oni::driver::DeviceBase {
 public:
  explicit Device(void (*lose)(void*), void* driver) : lose_(lose), driver_(driver) {
    sent = 0, is_unplugged = false;
  }
  ~Device() override {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  OniStatus getSensorInfoList(OniSensorInfo** info, int* count) override {
    *info = sensors, *count = 2;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return new Stream(*this, type == ONI_SENSOR_DEPTH);
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override {
    return mode == ONI_IMAGE_REGISTRATION_OFF || !option("unregistered");
  }
  OniBool isPropertySupported(int property) override {
    return property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
  }
  OniStatus setProperty(int property, const void* data, int) override {
    if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&registration, data, sizeof registration);
    return ONI_STATUS_OK;
  }
  OniStatus getProperty(int property, void* data, int* size) override {
    if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
    return give(registration, data, size);
  }

  void add(Stream* stream, bool is_depth) {
    const std::lock_guard lock(mutex_);
    (is_depth ? depth_ : colour_) = stream;
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  // When this returns, no frame of the stream is being sent.
  void remove(const Stream* stream) {
    const std::lock_guard lock(mutex_);
    if (depth_ == stream) depth_ = nullptr;
    if (colour_ == stream) colour_ = nullptr;
  }

  OniImageRegistrationMode registration = ONI_IMAGE_REGISTRATION_OFF;

 private:
  void run();

  void (*lose_)(void*);
  void* driver_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Stream *depth_ = nullptr, *colour_ = nullptr;
  bool is_closed_ = false;
  std::thread thread_;
};

// A frame for which it is too late is missing, as with a real camera. Frame n is due n / 30 s after the
// start.
void Device::run() {
  using Clock = std::chrono::steady_clock;
  const int stop_after = option("stop_after");
  const auto period = std::chrono::nanoseconds(1'000'000'000 / kRate_hz);
  const auto start = Clock::now();
  const auto after = [&](int number) {
    const int due = std::max<int>(number + 1, (Clock::now() - start) / period);
    return number < stop_after ? std::min(due, stop_after) : due;
  };
  std::unique_lock lock(mutex_);
  for (int number = 1; !is_closed_; number = after(number)) {
    changed_.wait_until(lock, start + number * period, [this] { return is_closed_; });
    if (is_unplugged) {
      lock.unlock();
      lose_(driver_);
      return;
    }
    if (stop_after > 0 && number > stop_after) continue;
    OniFrame* colour = colour_ ? colour_->see(number) : nullptr;
    OniFrame* depth = depth_ ? depth_->see(number) : nullptr;
    if (colour) colour_->send(colour);
    if (depth) depth_->send(depth), sent = number;
  }
}

OniStatus Stream::getProperty(int property, void* data, int* size) {
  switch (property) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return give(mode_, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return give(static_cast<OniBool>(is_mirrored_), data, size);
    case ONI_STREAM_PROPERTY_CROPPING:  // OpenNI plays no recording without these two
      return give(OniCropping{}, data, size);
    case ONI_STREAM_PROPERTY_STRIDE:
      return give(mode_.resolutionX * pixel_bytes(), data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return give(is_depth_ ? kDepthAcross_rad : kColourAcross_rad, data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return give(is_depth_ ? kDepthDown_rad : kColourDown_rad, data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return give(is_depth_ ? kMaxDepth : 255, data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus Stream::setProperty(int property, const void* data, int) {
  if (property == ONI_STREAM_PROPERTY_VIDEO_MODE) {
    std::memcpy(&mode_, data, sizeof mode_);
  } else if (property == ONI_STREAM_PROPERTY_MIRRORING && !option("stays_mirrored")) {
    OniBool wanted = FALSE;
    std::memcpy(&wanted, data, sizeof wanted);
    is_mirrored_ = wanted;
  } else {
    return ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_OK;
}

// Starts only the modes that can be drawn: 640 x 480 pixels, and colour only if depth is registered to it.
OniStatus Stream::start() {
  const bool is_drawn =
      mode_.resolutionX == kWidth && mode_.resolutionY == kHeight &&
      mode_.pixelFormat == (is_depth_ ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888);
  if (!is_drawn || (!is_depth_ && device_.registration == ONI_IMAGE_REGISTRATION_OFF))
    return ONI_STATUS_ERROR;
  device_.add(this, is_depth_);
  return ONI_STATUS_OK;
}

void Stream::stop() {
  device_.remove(this);
}

void Stream::draw(int number, std::uint8_t* to) const {
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u, to += pixel_bytes()) {
      const int seen_u = is_mirrored_ ? kWidth - 1 - u : u;
      if (is_depth_) {
        const std::uint16_t depth = depth_at(number, seen_u, v);
        std::memcpy(to, &depth, sizeof depth);
      } else {
        const std::uint32_t colour = colour_at(number, seen_u, v);
        to[0] = static_cast<std::uint8_t>(colour >> 16);
        to[1] = static_cast<std::uint8_t>(colour >> 8), to[2] = static_cast<std::uint8_t>(colour);
      }
    }
}

OniFrame* Stream::see(int number) {
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return nullptr;
  const int small_after = option("small_after");
  const int height = is_depth_ && small_after > 0 && number > small_after ? kHeight / 2 : kHeight;
  draw(number, static_cast<std::uint8_t*>(frame->data));
  frame->frameIndex = number;
  frame->timestamp = 5'000'000 + 1'000'000ull * static_cast<unsigned>(number) / kRate_hz;
  frame->sensorType = is_depth_ ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR;
  frame->videoMode = mode_;
  frame->width = kWidth, frame->height = height;
  frame->stride = kWidth * pixel_bytes();
  frame->dataSize = frame->stride * height;
  frame->croppingEnabled = FALSE, frame->cropOriginX = 0, frame->cropOriginY = 0;
  return frame;
}

void Stream::send(OniFrame* frame) {
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

class Driver : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    if (!option("absent")) deviceConnected(&info_);
    return ONI_STATUS_OK;
  }
  oni::driver::DeviceBase* deviceOpen(const char*, const char*) override {
    return new Device([](void* driver) { static_cast<Driver*>(driver)->lose(); }, this);
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  void shutdown() override {}

 private:
  void lose() { deviceDisconnected(&info_); }

  const OniDeviceInfo info_ = device_info();
};

}  // namespace
}  // namespace remote_touch::virtual_camera

ONI_EXPORT_DRIVER(remote_touch::virtual_camera::Driver)

// These are the names by which virtual_camera.h calls the functions.
extern "C" int virtual_camera_sent() {
  return remote_touch::virtual_camera::sent;
}
extern "C" void virtual_camera_unplug() {
  remote_touch::virtual_camera::is_unplugged = true;
}
