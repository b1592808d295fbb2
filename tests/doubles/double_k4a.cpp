// A test double of the k4a interface of the Azure Kinect and of Orbbec's wrapper: it has the vendors'
// signatures and none of their behaviour.
#include "tests/doubles/camera_double.h"

namespace {

using remote_touch::CameraDouble;

CameraDouble camera;

constexpr int kSucceeded = 0, kFailed = 1, kTooSmall = 2;
constexpr int kTimeout = 2;  // a wait that timed out; a wait that failed returns kFailed
constexpr int kDepth16 = 4;
constexpr int kQueue = 4;  // frames that the library keeps
constexpr std::size_t kCalibrationBytes = 1032;

// The members are in the order of the bytes in memory.
struct Started {
  int colour_format, colour_resolution, depth_mode, rate;
  bool only_synchronized;
  int depth_delay, wired_sync;
  unsigned subordinate_delay;
  bool has_no_light;
};

void (*handler)(void*, int, const char*, int, const char*) = nullptr;
void* handler_context = nullptr;
int fail(const char* what) {
  if (handler != nullptr) handler(handler_context, 1, "double_k4a.cpp", 1, what);
  if (handler != nullptr) handler(handler_context, 1, "double_k4a.cpp", 2, "as said above");
  return kFailed;
}

void set_mode(int mode) {
  constexpr int kSizes[5][2] = {{0, 0}, {320, 288}, {640, 576}, {512, 512}, {1024, 1024}};
  camera.state.lens.width = kSizes[mode][0];
  camera.state.lens.height = kSizes[mode][1];
  camera.state.rate_hz = mode == 4 ? 15 : 30;
}

// The mode of the frames must be that of the calibration.
bool is_possible(const Started& wanted) {
  constexpr int kWidths[5] = {0, 320, 640, 512, 1024};
  const int rate = wanted.depth_mode == 4 ? 1 : 2;
  return wanted.colour_resolution == 0 && wanted.depth_mode >= 1 && wanted.depth_mode <= 4 &&
         wanted.rate == rate && kWidths[wanted.depth_mode] == camera.state.lens.width &&
         !wanted.only_synchronized && wanted.wired_sync == 0 && wanted.subordinate_delay == 0 &&
         wanted.depth_delay == 0;
}

// The bytes that are given out as a calibration. Only this library understands them.
const CameraDouble::Bytes& calibration_bytes() {
  static const CameraDouble::Bytes bytes = [] {
    CameraDouble::Bytes filled(kCalibrationBytes);
    for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = static_cast<std::uint8_t>(i % 251);
    return filled;
  }();
  return bytes;
}
bool is_calibration(const void* calibration) {
  return std::memcmp(calibration, calibration_bytes().data(), kCalibrationBytes) == 0;
}

const CameraDouble::Bytes& bytes_in(const void* handle) {
  return *static_cast<const CameraDouble::Bytes*>(handle);
}

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the vendor's

CameraDouble* camera_double() {
  return &camera;
}

int k4a_set_debug_message_handler(void (*callback)(void*, int, const char*, int, const char*), void* context,
                                  int) {
  handler = callback, handler_context = context;
  return kSucceeded;
}

std::uint32_t k4a_device_get_installed_count() {
  return camera.enter("k4a_device_get_installed_count")
             ? 0
             : static_cast<std::uint32_t>(camera.state.serials.size());
}

int k4a_device_open(std::uint32_t index, void** device) {
  if (camera.enter("k4a_device_open") || index >= camera.state.serials.size() ||
      static_cast<int>(index) == camera.state.held_by_others)
    return fail("libusb device(s) are all unavailable");
  const std::string& serial = camera.state.serials[index];
  *device = camera.hold("device", {serial.begin(), serial.end()});
  return kSucceeded;
}

void k4a_device_close(void* device) {
  camera.enter("k4a_device_close");
  camera.expect(!camera.is_started(), "the cameras still run");
  camera.give_back("device", device);
}

int k4a_device_get_serialnum(void* device, char* serial, std::size_t* size) {
  if (camera.enter("k4a_device_get_serialnum") || !camera.is_held("device", device)) return kFailed;
  const CameraDouble::Bytes& text = bytes_in(device);
  const bool fits = serial != nullptr && *size > text.size();
  *size = text.size() + 1;
  if (!fits) return kTooSmall;
  std::memcpy(serial, text.data(), text.size());
  serial[text.size()] = '\0';
  return kSucceeded;
}

int k4a_device_get_calibration(void* device, int depth_mode, int colour_resolution, void* calibration) {
  if (camera.enter("k4a_device_get_calibration") || !camera.is_held("device", device))
    return fail("no calibration");
  camera.expect(colour_resolution == 0 && depth_mode >= 1 && depth_mode <= 4, "mode");
  set_mode(depth_mode);
  std::memcpy(calibration, calibration_bytes().data(), kCalibrationBytes);
  return kSucceeded;
}

int k4a_device_start_cameras(void* device, const Started* wanted) {
  if (camera.enter("k4a_device_start_cameras") || !camera.is_held("device", device))
    return fail("depth engine create failed");
  if (camera.is_started() || !is_possible(*wanted)) return fail("configuration");
  camera.start();
  return kSucceeded;
}

void k4a_device_stop_cameras(void* device) {
  camera.enter("k4a_device_stop_cameras");
  camera.expect(camera.is_held("device", device) && camera.is_started(), "not started");
  camera.stop();
}

// Returns the oldest kept capture first.
int k4a_device_get_capture(void* device, void** capture, std::int32_t timeout_ms) {
  if (camera.enter("k4a_device_get_capture") || !camera.is_held("device", device) || !camera.is_started())
    return fail("capturesync stopped");
  if (camera.sent() <= camera.last() && timeout_ms > 0) {
    const bool is_silent = camera.state.silent_after > 0 && camera.last() >= camera.state.silent_after;
    const double patience_s = 1e-3 * timeout_ms, due_s = camera.wait_for_s(camera.last() + 1) + 1e-6;
    camera.clock().sleep_s(is_silent ? patience_s : std::clamp(due_s, 0.0, patience_s));
  }
  if (camera.sent() <= camera.last()) {
    if (!camera.is_lost()) return kTimeout;
    return fail("usb device gone");
  }
  const int number = std::max(camera.last() + 1, camera.sent() - kQueue + 1);
  camera.take(number);
  *capture = camera.hold("capture", CameraDouble::bytes_of(number));
  return kSucceeded;
}

void k4a_capture_release(void* capture) {
  camera.enter("k4a_capture_release");
  camera.give_back("capture", capture);
}

void* k4a_capture_get_depth_image(void* capture) {
  if (camera.enter("k4a_capture_get_depth_image") || !camera.is_held("capture", capture)) return nullptr;
  const int number = CameraDouble::number_in(capture);
  if (!camera.state.has_depth(number)) return nullptr;
  return camera.hold("image", CameraDouble::bytes_of(number, camera.image()));
}

void k4a_image_release(void* image) {
  camera.enter("k4a_image_release");
  camera.give_back("image", image);
}

const std::uint8_t* k4a_image_get_buffer(void* image) {
  if (camera.enter("k4a_image_get_buffer") || !camera.is_held("image", image)) return nullptr;
  return bytes_in(image).data() + sizeof(int);
}

std::size_t k4a_image_get_size(void* image) {
  if (camera.enter("k4a_image_get_size") || !camera.is_held("image", image)) return 0;
  return bytes_in(image).size() - sizeof(int);
}

int k4a_image_get_format(void* image) {
  if (camera.enter("k4a_image_get_format") || !camera.is_held("image", image)) return 8;
  return camera.state.format >= 0 ? camera.state.format : kDepth16;
}

int k4a_image_get_width_pixels(void* image) {
  if (camera.enter("k4a_image_get_width_pixels") || !camera.is_held("image", image)) return 0;
  return camera.state.lens.width;
}

int k4a_image_get_height_pixels(void* image) {
  if (camera.enter("k4a_image_get_height_pixels") || !camera.is_held("image", image)) return 0;
  return camera.state.lens.height - camera.state.missing_rows;
}

int k4a_image_get_stride_bytes(void* image) {
  if (camera.enter("k4a_image_get_stride_bytes") || !camera.is_held("image", image)) return 0;
  return camera.stride();
}

std::uint64_t k4a_image_get_device_timestamp_usec(void* image) {
  if (camera.enter("k4a_image_get_device_timestamp_usec") || !camera.is_held("image", image)) return 0;
  return static_cast<std::uint64_t>(std::llround(1e6 * camera.state.stamp_s(CameraDouble::number_in(image))));
}

int k4a_calibration_3d_to_2d(const void* calibration, const float* point, int source, int target,
                             float* pixel, int* is_valid) {
  if (camera.state.fail_name == "k4a_calibration_3d_to_2d" || !is_calibration(calibration)) return kFailed;
  if (source != 0 || target != 0) return kFailed;
  const auto at =
      point[2] > 0 ? camera.state.lens.pixel_of({point[0] / point[2], point[1] / point[2]}) : std::nullopt;
  *is_valid = at ? 1 : 0;
  if (at) pixel[0] = static_cast<float>(at->x()), pixel[1] = static_cast<float>(at->y());
  return kSucceeded;
}

int k4a_calibration_2d_to_3d(const void* calibration, const float* pixel, float depth_mm, int source,
                             int target, float* point, int* is_valid) {
  if (camera.state.fail_name == "k4a_calibration_2d_to_3d" || !is_calibration(calibration)) return kFailed;
  if (source != 0 || target != 0) return kFailed;
  const auto ray = depth_mm > 0 ? camera.state.lens.ray_of({pixel[0], pixel[1]}) : std::nullopt;
  *is_valid = ray ? 1 : 0;
  if (!ray) return kSucceeded;
  point[0] = static_cast<float>(ray->x() * depth_mm), point[1] = static_cast<float>(ray->y() * depth_mm),
  point[2] = depth_mm;
  return kSucceeded;
}
// NOLINTEND(readability-identifier-naming)
}
