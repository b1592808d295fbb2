// A test double of the rs2 interface of librealsense 2: it has the vendor's signatures and none of its
// behaviour. If REMOTE_TOUCH_OLD_REALSENSE is defined, it lacks what version 2.27 lacked.
#include "tests/doubles/camera_double.h"

namespace {

using remote_touch::CameraDouble;
using remote_touch::CameraLens;

CameraDouble camera;

constexpr int kSerialNumber = 1, kDepthStream = 1, kInfraredStream = 3, kZ16 = 1, kY8 = 9;
constexpr int kIsDepthSensor = 7, kIsCompositeFrame = 10;

struct Intrinsics {
  int width, height;
  float cx, cy, fx, fy;
  int model;
  float coefficients[5];
};

// Streams belong to the library.
struct StreamDouble {
  int kind, format;
};
const StreamDouble infrared{kInfraredStream, kY8}, depth{kDepthStream, kZ16};

using Bytes = CameraDouble::Bytes;

Bytes bytes_of(int number) {
  return CameraDouble::bytes_of(number);
}
int number_in(const void* handle) {
  return CameraDouble::number_in(handle);
}

void set_error(void** error, const std::string& message) {
  camera.expect(error != nullptr && *error == nullptr, "the error of another call");
  Bytes text(message.begin(), message.end());
  text.push_back(0);
  *error = camera.hold("error", std::move(text));
}

// Returns true if the call can do its work.
bool begins(const char* name, void** error) {
  if (!camera.enter(name)) return true;
  set_error(error, std::string("the double's\ntext for ") + name);
  return false;
}
bool begins(const char* name, const char* kind, const void* handle, void** error) {
  if (!begins(name, error)) return false;
  if (camera.is_held(kind, handle)) return true;
  set_error(error, std::string("no ") + kind);
  return false;
}
// Holds a new object whose content is `number`, and returns its handle; null if the call itself fails.
void* created(const char* name, const char* parent_kind, const void* parent, const char* kind, int number,
              void** error) {
  if (!begins(name, parent_kind, parent, error)) return nullptr;
  return camera.hold(kind, bytes_of(number));
}
void deleted(const char* name, const char* kind, const void* handle) {
  camera.enter(name);
  camera.give_back(kind, handle);
}

bool is_depth_frame(const void* frame) {
  return static_cast<const Bytes*>(frame)->back() == kDepthStream;
}
// The content of a frame is its number, its pixels, and its kind.
void* frame_of(int number, int kind) {
  Bytes content = CameraDouble::bytes_of(number, kind == kDepthStream ? camera.image() : Bytes());
  content.push_back(static_cast<std::uint8_t>(kind));
  return camera.hold("frame", std::move(content));
}

[[maybe_unused]] CameraLens lens_of(const Intrinsics& intrinsics) {
  const float* c = intrinsics.coefficients;
  CameraLens lens;
  lens.width = intrinsics.width, lens.height = intrinsics.height;
  lens.fx = intrinsics.fx, lens.fy = intrinsics.fy, lens.cx = intrinsics.cx, lens.cy = intrinsics.cy;
  lens.k = {c[0], c[1], c[4], 0, 0, 0}, lens.p1 = c[2], lens.p2 = c[3];
  return lens;
}

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the vendor's

CameraDouble* camera_double() {
  return &camera;
}

int rs2_get_api_version(void** error) {
  return begins("rs2_get_api_version", error) ? camera.state.version : 0;
}

const char* rs2_get_error_message(const void* error) {
  if (!camera.is_held("error", error)) return nullptr;
  return reinterpret_cast<const char*>(static_cast<const Bytes*>(error)->data());
}

const char* rs2_get_failed_function(const void*) {
  return camera.calls().back().c_str();
}

void rs2_free_error(void* error) {
  camera.give_back("error", error);
}

void* rs2_create_context(int version, void** error) {
  if (!begins("rs2_create_context", error)) return nullptr;
  if (version / 10000 != camera.state.version / 10000 || version / 100 > camera.state.version / 100) {
    set_error(error, "API version mismatch");
    return nullptr;
  }
  return camera.hold("context");
}
void rs2_delete_context(void* context) {
  deleted("rs2_delete_context", "context", context);
  camera.expect(camera.held() == 0, "something else is still held");
}

void* rs2_query_devices(const void* context, void** error) {
  return created("rs2_query_devices", "context", context, "device list", 0, error);
}
int rs2_get_device_count(const void* list, void** error) {
  if (!begins("rs2_get_device_count", "device list", list, error)) return 0;
  return static_cast<int>(camera.state.serials.size());
}
void rs2_delete_device_list(void* list) {
  deleted("rs2_delete_device_list", "device list", list);
}
void* rs2_create_device(const void* list, int index, void** error) {
  return created("rs2_create_device", "device list", list, "device", index, error);
}
void rs2_delete_device(void* device) {
  deleted("rs2_delete_device", "device", device);
}
int rs2_supports_device_info(const void* device, int what, void** error) {
  if (!begins("rs2_supports_device_info", "device", device, error)) return 0;
  return what == kSerialNumber && !camera.state.serials[static_cast<std::size_t>(number_in(device))].empty()
             ? 1
             : 0;
}
const char* rs2_get_device_info(const void* device, int what, void** error) {
  if (!begins("rs2_get_device_info", "device", device, error)) return nullptr;
  camera.expect(what == kSerialNumber, "what it does not support");
  return camera.state.serials[static_cast<std::size_t>(number_in(device))].c_str();
}

void* rs2_create_device_hub(const void* context, void** error) {
  return created("rs2_create_device_hub", "context", context, "hub", 0, error);
}
void rs2_delete_device_hub(const void* hub) {
  deleted("rs2_delete_device_hub", "hub", hub);
}
int rs2_device_hub_is_device_connected(const void* hub, const void* device, void** error) {
  if (!begins("rs2_device_hub_is_device_connected", "hub", hub, error)) return 0;
  return camera.is_held("device", device) && !camera.is_lost() ? 1 : 0;
}

// The first sensor is a colour sensor.
void* rs2_query_sensors(const void* device, void** error) {
  return created("rs2_query_sensors", "device", device, "sensor list", 0, error);
}
int rs2_get_sensors_count(const void* list, void** error) {
  return begins("rs2_get_sensors_count", "sensor list", list, error) ? 2 : 0;
}
void rs2_delete_sensor_list(void* list) {
  deleted("rs2_delete_sensor_list", "sensor list", list);
}
void* rs2_create_sensor(const void* list, int index, void** error) {
  return created("rs2_create_sensor", "sensor list", list, "sensor", index, error);
}
void rs2_delete_sensor(void* sensor) {
  deleted("rs2_delete_sensor", "sensor", sensor);
}
int rs2_is_sensor_extendable_to(const void* sensor, int what, void** error) {
  if (!begins("rs2_is_sensor_extendable_to", "sensor", sensor, error)) return 0;
  return what == kIsDepthSensor && number_in(sensor) == 1 && camera.state.has_depth_sensor ? 1 : 0;
}
float rs2_get_depth_scale(void* sensor, void** error) {
  if (!begins("rs2_get_depth_scale", "sensor", sensor, error)) return 0;
  camera.expect(number_in(sensor) == 1, "no sensor of depth");
  return static_cast<float>(camera.state.metres_per_unit);
}

void* rs2_create_pipeline(void* context, void** error) {
  return created("rs2_create_pipeline", "context", context, "pipeline", 0, error);
}
void rs2_delete_pipeline(void* pipeline) {
  deleted("rs2_delete_pipeline", "pipeline", pipeline);
  camera.expect(!camera.is_started(), "it still runs");
}
void* rs2_create_config(void** error) {
  if (!begins("rs2_create_config", error)) return nullptr;
  return camera.hold("config", bytes_of(0));
}
void rs2_delete_config(void* config) {
  deleted("rs2_delete_config", "config", config);
}
// The config stores the index of the camera.
void rs2_config_enable_device(void* config, const char* serial, void** error) {
  if (!begins("rs2_config_enable_device", "config", config, error)) return;
  const auto& serials = camera.state.serials;
  const auto found = std::find(serials.begin(), serials.end(), std::string(serial));
  camera.expect(found != serials.end(), "no camera of this serial number");
  *static_cast<Bytes*>(config) = bytes_of(static_cast<int>(found - serials.begin()));
}
void rs2_config_enable_stream(void* config, int stream, int index, int width, int height, int format,
                              int rate_hz, void** error) {
  if (!begins("rs2_config_enable_stream", "config", config, error)) return;
  camera.expect(stream == kDepthStream && format == kZ16 && index == -1 && width == 640 && height == 480 &&
                    rate_hz == 30,
                "another stream");
}
void* rs2_pipeline_start_with_config(void* pipeline, void* config, void** error) {
  if (!begins("rs2_pipeline_start_with_config", "pipeline", pipeline, error)) return nullptr;
  if (!camera.is_held("config", config) || camera.is_started() ||
      number_in(config) == camera.state.held_by_others) {
    set_error(error, "Couldn't resolve requests");
    return nullptr;
  }
  camera.start();
  return camera.hold("profile", bytes_of(number_in(config)));
}
void rs2_pipeline_stop(void* pipeline, void** error) {
  begins("rs2_pipeline_stop", "pipeline", pipeline, error);
  camera.expect(camera.is_started(), "it does not run");
  camera.stop();
}
void* rs2_pipeline_profile_get_device(void* profile, void** error) {
  if (!begins("rs2_pipeline_profile_get_device", "profile", profile, error)) return nullptr;
  return camera.hold("device", bytes_of(number_in(profile)));
}
void* rs2_pipeline_profile_get_streams(void* profile, void** error) {
  return created("rs2_pipeline_profile_get_streams", "profile", profile, "streams", 0, error);
}
void rs2_delete_pipeline_profile(void* profile) {
  deleted("rs2_delete_pipeline_profile", "profile", profile);
}
int rs2_get_stream_profiles_count(const void* streams, void** error) {
  return begins("rs2_get_stream_profiles_count", "streams", streams, error) ? 2 : 0;
}
const StreamDouble* rs2_get_stream_profile(const void* streams, int index, void** error) {
  if (!begins("rs2_get_stream_profile", "streams", streams, error)) return nullptr;
  return index == 1 && camera.state.sends_depth ? &depth : &infrared;
}
void rs2_delete_stream_profiles_list(void* streams) {
  deleted("rs2_delete_stream_profiles_list", "streams", streams);
}
void rs2_get_stream_profile_data(const StreamDouble* stream, int* kind, int* format, int* index, int* id,
                                 int* rate_hz, void** error) {
  if (!begins("rs2_get_stream_profile_data", error)) return;
  *kind = stream->kind, *format = stream->format, *index = 0, *id = stream->kind, *rate_hz = 30;
}
void rs2_get_video_stream_intrinsics(const StreamDouble* stream, Intrinsics* given, void** error) {
  if (!begins("rs2_get_video_stream_intrinsics", error)) return;
  camera.expect(stream == &depth, "not of depth");
  const CameraLens& lens = camera.state.lens;
  const auto number = [](double value) { return static_cast<float>(value); };
  *given = {lens.width,
            lens.height,
            number(lens.cx),
            number(lens.cy),
            number(lens.fx),
            number(lens.fy),
            camera.state.model,
            {number(lens.k[0]), number(lens.k[1]), number(lens.p1), number(lens.p2), number(lens.k[2])}};
}

// Keeps only the newest frame.
int rs2_pipeline_poll_for_frames(void* pipeline, void** frame, void** error) {
  if (!begins("rs2_pipeline_poll_for_frames", "pipeline", pipeline, error)) return 0;
  if (camera.sent() <= camera.last()) return 0;
  camera.take(camera.sent());
  *frame = frame_of(camera.last(), camera.state.is_alone ? kDepthStream : 0);
  return 1;
}
int rs2_is_frame_extendable_to(const void* frame, int what, void** error) {
  if (!begins("rs2_is_frame_extendable_to", "frame", frame, error)) return 0;
  return what == kIsCompositeFrame && static_cast<const Bytes*>(frame)->back() == 0 ? 1 : 0;
}
int rs2_embedded_frames_count(void* frame, void** error) {
  if (!begins("rs2_embedded_frames_count", "frame", frame, error)) return 0;
  return camera.state.has_depth(number_in(frame)) ? 2 : 1;
}
void* rs2_extract_frame(void* frame, int index, void** error) {
  if (!begins("rs2_extract_frame", "frame", frame, error)) return nullptr;
  return frame_of(number_in(frame), index == 0 ? kInfraredStream : kDepthStream);
}
void rs2_release_frame(void* frame) {
  deleted("rs2_release_frame", "frame", frame);
}
const StreamDouble* rs2_get_frame_stream_profile(const void* frame, void** error) {
  if (!begins("rs2_get_frame_stream_profile", "frame", frame, error)) return nullptr;
  return is_depth_frame(frame) ? &depth : &infrared;
}
const void* rs2_get_frame_data(const void* frame, void** error) {
  if (!begins("rs2_get_frame_data", "frame", frame, error)) return nullptr;
  camera.expect(is_depth_frame(frame), "not of depth");
  return static_cast<const Bytes*>(frame)->data() + sizeof(int);
}
int rs2_get_frame_width(const void* frame, void** error) {
  return begins("rs2_get_frame_width", "frame", frame, error) ? camera.state.lens.width : 0;
}
int rs2_get_frame_height(const void* frame, void** error) {
  if (!begins("rs2_get_frame_height", "frame", frame, error)) return 0;
  return camera.state.lens.height - camera.state.missing_rows;
}
int rs2_get_frame_stride_in_bytes(const void* frame, void** error) {
  return begins("rs2_get_frame_stride_in_bytes", "frame", frame, error) ? camera.stride() : 0;
}
double rs2_get_frame_timestamp(const void* frame, void** error) {
  if (!begins("rs2_get_frame_timestamp", "frame", frame, error)) return 0;
  return 1e3 * camera.state.stamp_s(number_in(frame));
}
unsigned long long rs2_get_frame_number(const void* frame, void** error) {
  if (!begins("rs2_get_frame_number", "frame", frame, error)) return 0;
  return static_cast<unsigned long long>(camera.state.reported_number(number_in(frame)));
}

#ifndef REMOTE_TOUCH_OLD_REALSENSE
int rs2_get_frame_data_size(const void* frame, void** error) {
  if (!begins("rs2_get_frame_data_size", "frame", frame, error)) return 0;
  return static_cast<int>(static_cast<const Bytes*>(frame)->size() - sizeof(int) - 1);
}
void rs2_project_point_to_pixel(float pixel[2], const Intrinsics* intrinsics, const float point[3]) {
  const auto at = lens_of(*intrinsics).pixel_of({point[0] / point[2], point[1] / point[2]});
  pixel[0] = at ? static_cast<float>(at->x()) : NAN, pixel[1] = at ? static_cast<float>(at->y()) : NAN;
}
void rs2_deproject_pixel_to_point(float point[3], const Intrinsics* intrinsics, const float pixel[2],
                                  float depth_m) {
  const auto ray = lens_of(*intrinsics).ray_of({pixel[0], pixel[1]});
  // The scale of 1.1 mimics a version whose two functions contradict each other.
  const double scale = camera.state.fail_name == "rs2_deproject_pixel_to_point" ? 1.1 : 1;
  point[0] = ray ? static_cast<float>(scale * ray->x() * depth_m) : NAN;
  point[1] = ray ? static_cast<float>(scale * ray->y() * depth_m) : NAN;
  point[2] = depth_m;
}
#endif
// NOLINTEND(readability-identifier-naming)
}
