#include "runners/live/sensors/realsense_camera.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch::rs2 {
namespace {

// The file name contains the minor version; only packages for development add a name without it. Older
// versions can be named with the environment variable.
constexpr int kOldestMinor = 50, kNewestMinor = 69;
constexpr int kMajor = 2;

SharedLibrary::Lookup realsense_lookup() {
  SharedLibrary::Lookup lookup{
      {"librealsense2.so"}, "REMOTE_TOUCH_LIBREALSENSE", "the RealSense SDK (librealsense2)"};
  for (int minor = kNewestMinor; minor >= kOldestMinor; --minor)
    lookup.names.push_back("librealsense2.so." + std::to_string(kMajor) + "." + std::to_string(minor));
  return lookup;
}

std::string text_of_version(int version) {
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

}  // namespace

RealSenseLibrary::RealSenseLibrary() : library(realsense_lookup()) {}

int RealSenseLibrary::checked_version() const {
  const int found = Calls(*this, library.file())("does not report its version", get_api_version);
  if (found / 10000 != kMajor)
    throw InputError(library.file(), "is version " + text_of_version(found) + " of its interface: expected " +
                                         std::to_string(kMajor) + ".x");
  return found;
}

std::string RealSenseLibrary::version_text() const {
  return text_of_version(version);
}

std::string RealSenseLibrary::text_of(Error* error) const {
  const char *message = get_error_message(error), *function = get_failed_function(error);
  std::string text = function != nullptr ? function : "";
  if (message != nullptr) text += (text.empty() ? "" : ": ") + std::string(message);
  free_error(error);
  return text.empty() ? "no reason given" : text;
}

void Calls::refuse(const std::string& problem) const {
  throw InputError(name_, problem);
}

void Calls::check(const char* what, Error* error) const {
  if (error != nullptr) refuse(std::string(what) + " (the library says: " + rs2_.text_of(error) + ")");
}

// True if the image is distorted; false for a pinhole camera.
bool has_distortion(const Intrinsics& intrinsics) {
  return intrinsics.model != distortion_none &&
         std::any_of(std::begin(intrinsics.coefficients), std::end(intrinsics.coefficients),
                     [](float coefficient) { return coefficient != 0; });
}

// Returns a lens that calls the library's own functions, because the meaning of a model's coefficients has
// changed between versions. Throws InputError, with this name, for a model that some versions cannot invert,
// and for versions before 2.46, which lack these functions. The library must outlive the lens.
Lens lens_of(const std::string& name, const RealSenseLibrary& rs2, const Intrinsics& intrinsics) {
  if (rs2.project_point_to_pixel == nullptr || rs2.deproject_pixel_to_point == nullptr)
    throw InputError(name,
                     "has a lens with distortion: expected librealsense 2.46 or newer, which can compute it");
  if (intrinsics.model != brown_conrady && intrinsics.model != inverse_brown_conrady)
    throw InputError(name, "has a lens of model " + std::to_string(intrinsics.model) +
                               ": expected one of Brown and Conrady, whose pixels have known rays");
  using Eigen::Vector2d;
  const auto finite = [](double x, double y) -> std::optional<Vector2d> {
    if (!std::isfinite(x) || !std::isfinite(y)) return {};
    return Vector2d(x, y);
  };
  return {[=, &rs2](const Vector2d& ray) {
            const float point[3] = {static_cast<float>(ray.x()), static_cast<float>(ray.y()), 1};
            float pixel[2] = {NAN, NAN};
            rs2.project_point_to_pixel(pixel, &intrinsics, point);
            return finite(pixel[0], pixel[1]);
          },
          [=, &rs2](const Vector2d& at) {
            const float pixel[2] = {static_cast<float>(at.x()), static_cast<float>(at.y())};
            float point[3] = {NAN, NAN, NAN};
            rs2.deproject_pixel_to_point(point, &intrinsics, pixel, 1);
            return finite(point[0], point[1]);
          }};
}

}  // namespace remote_touch::rs2

namespace remote_touch {
namespace {

constexpr int kRealSenseWidth = 640, kRealSenseHeight = 480, kRealSenseRate_hz = 30;
constexpr int kAnyIndex = -1;
constexpr double kPoll_s = 1e-3;
constexpr double kCheckAfter_s = 0.1;  // the connection is checked after this time without a frame
constexpr int kMaxList = 64;           // most cameras, sensors, streams or frames that are read

// The library with its context.
struct RealSense {
  explicit RealSense(const std::string& name)
      : call(rs2, name), context(call.held("the library does not start", rs2.create_context, rs2.version)) {}

  // Returns the serial numbers; "unknown" for a camera that does not report it, for instance in recovery
  // mode.
  std::vector<std::string> serials() const {
    const auto list = call.held("cameras cannot be listed", rs2.query_devices, context.get());
    const int count = call("cameras cannot be counted", rs2.get_device_count, list.get());
    std::vector<std::string> found;
    for (int i = 0; i < std::min(count, kMaxList); ++i)
      found.push_back(info(call.held("a camera cannot be queried", rs2.create_device, list.get(), i).get(),
                           rs2::info_serial_number));
    return found;
  }

  std::string info(const rs2::Device* device, rs2::CameraInfo what) const {
    if (call("does not report its properties", rs2.supports_device_info, device, what) == 0) return "unknown";
    const char* text = call("does not report its properties", rs2.get_device_info, device, what);
    return text != nullptr ? text : "unknown";
  }

  const rs2::RealSenseLibrary rs2;
  const rs2::Calls call;
  const rs2::Held<rs2::Context> context;
};

// Stops a pipeline that has been started.
struct StopPipeline {
  const rs2::RealSenseLibrary* rs2;
  void operator()(rs2::Pipeline* pipeline) const {
    rs2::Error* error = nullptr;
    rs2->pipeline_stop(pipeline, &error);
    if (error != nullptr) rs2->free_error(error);  // the camera may have been unplugged
  }
};

class RealSenseCamera final : public DepthSource {
 public:
  RealSenseCamera(const std::string& address, Clock& host)
      : host_(host), name_(address.empty() ? "realsense" : "realsense:" + address), real_sense_(name_) {
    config_ = call_.held("depth cannot be requested", rs2_.create_config);
    choose(address);
    start();
    describe(depth_intrinsics());
    connected_s_ = host_.now_s();
  }

  SensorState next(SensorFrame& frame, double timeout_s) override try {
    if (!failure_.empty()) return SensorState::failed;
    const double deadline_s = host_.now_s() + timeout_s;
    while (true) {
      double arrived_s = 0;
      const rs2::Held<rs2::Frame> depth = newest_depth(arrived_s);
      if (depth && take(depth.get(), arrived_s, frame)) return SensorState::frame;
      check_connection();
      const double remaining_s = deadline_s - host_.now_s();
      if (remaining_s <= 0) return SensorState::waiting;
      host_.sleep_s(std::clamp(remaining_s, 0.1 * kPoll_s, kPoll_s));
    }
  } catch (const InputError& error) {
    failure_ = error.what();
    return SensorState::failed;
  }

 private:
  void choose(const std::string& serial) {
    const std::vector<std::string> known = real_sense_.serials();
    if (known.empty())
      call_.refuse(
          "no camera is plugged in: expected one at USB that this user may open (lsusb, udev rules)");
    if (serial.empty()) return;
    if (std::find(known.begin(), known.end(), serial) == known.end())
      call_.refuse("no camera has this serial number: expected " + list_of(known));
    call_("cannot be chosen", rs2_.config_enable_device, config_.get(), serial.c_str());
  }

  void start() {
    call_("depth cannot be requested", rs2_.config_enable_stream, config_.get(), rs2::stream_depth, kAnyIndex,
          kRealSenseWidth, kRealSenseHeight, rs2::format_z16, kRealSenseRate_hz);
    hub_ = call_.held("disconnection cannot be detected", rs2_.create_device_hub, real_sense_.context.get());
    pipeline_ = call_.held("depth does not start", rs2_.create_pipeline, real_sense_.context.get());
    profile_ = call_.held(
        "depth of 640 x 480 pixels at 30 Hz does not start; another program may be using the camera",
        rs2_.pipeline_start_with_config, pipeline_.get(), config_.get());
    running_.reset(pipeline_.get());
    device_ = call_.held("does not report its properties", rs2_.pipeline_profile_get_device, profile_.get());
  }

  rs2::Intrinsics depth_intrinsics() const {
    const auto streams =
        call_.held("does not list its streams", rs2_.pipeline_profile_get_streams, profile_.get());
    const int count = call_("does not list its streams", rs2_.get_stream_profiles_count, streams.get());
    for (int i = 0; i < std::min(count, kMaxList); ++i) {
      const rs2::Stream* stream =
          call_("does not list its streams", rs2_.get_stream_profile, streams.get(), i);
      if (stream == nullptr || !is_depth(stream)) continue;
      rs2::Intrinsics intrinsics{};
      call_("does not report its intrinsics", rs2_.get_video_stream_intrinsics, stream, &intrinsics);
      return intrinsics;
    }
    call_.refuse("sends no depth in 16 bits");
  }

  double depth_scale() const {
    const auto sensors = call_.held("does not list its sensors", rs2_.query_sensors, device_.get());
    const int count = call_("does not list its sensors", rs2_.get_sensors_count, sensors.get());
    for (int i = 0; i < std::min(count, kMaxList); ++i) {
      const auto sensor = call_.held("does not list its sensors", rs2_.create_sensor, sensors.get(), i);
      if (call_("does not list its sensors", rs2_.is_sensor_extendable_to, sensor.get(),
                rs2::is_depth_sensor) == 0)
        continue;
      return static_cast<double>(call_("does not report its depth unit", rs2_.get_depth_scale, sensor.get()));
    }
    call_.refuse("has no depth sensor");
  }

  void describe(const rs2::Intrinsics& intrinsics) {
    view_.metres_per_unit = depth_scale();
    view_.frame_rate_hz = kRealSenseRate_hz;
    if (!(view_.metres_per_unit > 0 && view_.metres_per_unit <= 1))
      call_.refuse("reports depth in units of " + std::to_string(view_.metres_per_unit) +
                   " m: expected more than 0, 1 at most");
    const bool is_camera = intrinsics.width > 0 && intrinsics.height > 0 && intrinsics.fx > 0 &&
                           intrinsics.fy > 0 && std::isfinite(intrinsics.fx) &&
                           std::isfinite(intrinsics.fy) && std::isfinite(intrinsics.ppx) &&
                           std::isfinite(intrinsics.ppy);
    if (!is_camera)
      call_.refuse("reports no usable intrinsics: expected finite numbers and a focal length above 0");
    view_.camera = {intrinsics.width, intrinsics.height, intrinsics.fx,
                    intrinsics.fy,    intrinsics.ppx,    intrinsics.ppy};
    if (!rs2::has_distortion(intrinsics)) return;
    undistortion_.emplace(name_, intrinsics.width, intrinsics.height, rs2::lens_of(name_, rs2_, intrinsics));
    view_.camera = undistortion_->camera();
  }

  bool is_depth(const rs2::Stream* stream) const {
    rs2::StreamKind kind{};
    rs2::Format format{};
    int index = 0, id = 0, rate_hz = 0;
    call_("a stream does not report its format", rs2_.get_stream_profile_data, stream, &kind, &format, &index,
          &id, &rate_hz);
    return kind == rs2::stream_depth && format == rs2::format_z16;
  }

  rs2::Held<rs2::Frame> newest_depth(double& arrived_s) const {
    rs2::Held<rs2::Frame> newest(nullptr, {&rs2_});
    for (int i = 0; i < kMaxList; ++i) {
      rs2::Frame* next = nullptr;
      if (call_("sends no more frames", rs2_.pipeline_poll_for_frames, pipeline_.get(), &next) == 0 ||
          next == nullptr)
        break;
      newest.reset(next);
      arrived_s = host_.now_s();
    }
    return newest ? depth_of(std::move(newest)) : std::move(newest);
  }

  // Returns the depth frame; the library may deliver frames of several streams as one composite frame.
  rs2::Held<rs2::Frame> depth_of(rs2::Held<rs2::Frame> frames) const {
    const char* problem = "a frame cannot be read";
    if (call_(problem, rs2_.is_frame_extendable_to, frames.get(), rs2::is_composite_frame) == 0) {
      if (!is_depth(call_(problem, rs2_.get_frame_stream_profile, frames.get()))) frames.reset();
      return frames;
    }
    const int count = call_(problem, rs2_.embedded_frames_count, frames.get());
    for (int i = 0; i < std::min(count, kMaxList); ++i) {
      rs2::Held<rs2::Frame> frame = call_.held(problem, rs2_.extract_frame, frames.get(), i);
      if (is_depth(call_(problem, rs2_.get_frame_stream_profile, frame.get()))) return frame;
    }
    frames.reset();
    return frames;
  }

  // Copies the depth into the frame. Returns false if it is the same frame as before.
  bool take(const rs2::Frame* depth, double arrived_s, SensorFrame& frame) {
    const char* problem = "a frame cannot be read";
    const double stamp_s = 1e-3 * call_(problem, rs2_.get_frame_timestamp, depth);
    const unsigned long long counted = call_(problem, rs2_.get_frame_number, depth);
    if (!std::isfinite(stamp_s)) call_.refuse("a frame has no time stamp");
    connected_s_ = arrived_s;
    if (stamp_s_ && stamp_s == *stamp_s_ && counted == counted_) return false;
    const PixelRows rows = rows_of(depth);
    if (!copy_depth(rows, view_.camera, seen_))
      call_.refuse("a frame is " + std::to_string(rows.width) + " x " + std::to_string(rows.height) +
                   " pixels in " + std::to_string(rows.bytes) +
                   " bytes: expected those of the camera's mode");
    if (undistortion_)
      undistortion_->apply(seen_, frame.depth);
    else
      std::swap(seen_, frame.depth);
    frame.colour.clear();
    const bool is_count_continued = stamp_s_ && counted > counted_;
    frame.number = numbers_.next(is_count_continued ? static_cast<double>(counted - counted_) : 1);
    frame.captured_s = clock_.captured_s(stamp_s, arrived_s);
    stamp_s_ = stamp_s, counted_ = counted;
    return true;
  }

  PixelRows rows_of(const rs2::Frame* depth) const {
    const char* problem = "a frame cannot be read";
    PixelRows rows;
    rows.first = call_(problem, rs2_.get_frame_data, depth);
    rows.width = call_(problem, rs2_.get_frame_width, depth);
    rows.height = call_(problem, rs2_.get_frame_height, depth);
    rows.stride =
        static_cast<std::size_t>(std::max(call_(problem, rs2_.get_frame_stride_in_bytes, depth), 0));
    rows.bytes = rs2_.get_frame_data_size != nullptr
                     ? static_cast<std::size_t>(std::max(call_(problem, rs2_.get_frame_data_size, depth), 0))
                     : rows.stride * static_cast<std::size_t>(std::max(rows.height, 0));
    return rows;
  }

  // Checks every kCheckAfter_s that the camera is still connected, as long as no frame comes.
  void check_connection() {
    if (host_.now_s() - connected_s_ < kCheckAfter_s) return;
    connected_s_ = host_.now_s();
    if (call_("cannot be checked for disconnection", rs2_.device_hub_is_device_connected, hub_.get(),
              device_.get()) == 0)
      call_.refuse("was disconnected");
  }

  Clock& host_;
  const std::string name_;
  const RealSense real_sense_;
  const rs2::RealSenseLibrary& rs2_ = real_sense_.rs2;
  const rs2::Calls& call_ = real_sense_.call;
  // The following members are released from the last to the first.
  rs2::Held<rs2::Config> config_;
  rs2::Held<rs2::DeviceHub> hub_;
  rs2::Held<rs2::Pipeline> pipeline_;
  rs2::Held<rs2::Profile> profile_;
  rs2::Held<rs2::Device> device_;
  std::unique_ptr<rs2::Pipeline, StopPipeline> running_{nullptr, {&rs2_}};

  std::optional<Undistortion> undistortion_;  // none: a pinhole camera
  SensorClock clock_;
  FrameNumbers numbers_;
  std::optional<double> stamp_s_;   // time stamp of the frame before
  unsigned long long counted_ = 0;  // the camera's number of the frame before
  double connected_s_ = 0;          // when the camera was last known to be connected
  std::vector<std::uint16_t> seen_;
};

}  // namespace

std::unique_ptr<DepthSource> open_realsense(const std::string& address, Clock& clock) {
  return std::make_unique<RealSenseCamera>(address, clock);
}

Availability realsense_availability() {
  return availability_of([] {
    const RealSense real_sense("realsense");
    const std::vector<std::string> serials = real_sense.serials();
    return Availability{
        .found = !serials.empty(),
        .detail = real_sense.rs2.library.file() + " (" + real_sense.rs2.version_text() + "): " +
                  (serials.empty() ? "no camera is plugged in, or this user may not open its USB port"
                                   : list_of(serials))};
  });
}

}  // namespace remote_touch
