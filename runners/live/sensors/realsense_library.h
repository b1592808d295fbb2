// The functions of the rs2 interface (librealsense 2) that its adapter calls. Declared here from its
// documentation; no header of the vendor is needed.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "runners/libraries/shared_library.h"

namespace remote_touch::rs2 {

struct Context;
struct DeviceList;
struct Device;
struct DeviceHub;
struct SensorList;
struct Sensor;
struct Pipeline;
struct Config;
struct Profile;  // profile of a running pipeline
struct StreamList;
struct Stream;  // belongs to its list or its frame
struct Frame;
struct Error;

enum CameraInfo : int { info_name = 0, info_serial_number = 1 };
enum StreamKind : int { stream_depth = 1 };
enum Format : int { format_z16 = 1 };
enum Extension : int { is_depth_sensor = 7, is_composite_frame = 10 };
enum Distortion : int { distortion_none = 0, inverse_brown_conrady = 2, brown_conrady = 4 };

struct Intrinsics {
  int width, height;
  float ppx, ppy, fx, fy;
  Distortion model;
  float coefficients[5];
};
static_assert(sizeof(Intrinsics) == 48 && offsetof(Intrinsics, model) == 24);

struct RealSenseLibrary {
  // Throws InputError if it is not found or has another major version.
  RealSenseLibrary();

  // The version that the library reports: 25605 is 2.56.5. A context is created with this same version,
  // because the library refuses an application that was compiled for a newer one.
  int version = 0;
  std::string version_text() const;
  // Returns the text of an error, and frees the error.
  std::string text_of(Error* error) const;

  SharedLibrary library;
  int (*get_api_version)(Error**) = nullptr;
  const char* (*get_error_message)(const Error*) = nullptr;
  const char* (*get_failed_function)(const Error*) = nullptr;
  void (*free_error)(Error*) = nullptr;

  Context* (*create_context)(int api_version, Error**) = nullptr;
  void (*delete_context)(Context*) = nullptr;
  DeviceList* (*query_devices)(const Context*, Error**) = nullptr;
  int (*get_device_count)(const DeviceList*, Error**) = nullptr;
  void (*delete_device_list)(DeviceList*) = nullptr;
  Device* (*create_device)(const DeviceList*, int index, Error**) = nullptr;
  void (*delete_device)(Device*) = nullptr;
  const char* (*get_device_info)(const Device*, CameraInfo, Error**) = nullptr;  // belongs to the device
  int (*supports_device_info)(const Device*, CameraInfo, Error**) = nullptr;
  DeviceHub* (*create_device_hub)(const Context*, Error**) = nullptr;
  void (*delete_device_hub)(const DeviceHub*) = nullptr;
  int (*device_hub_is_device_connected)(const DeviceHub*, const Device*, Error**) = nullptr;
  SensorList* (*query_sensors)(const Device*, Error**) = nullptr;
  int (*get_sensors_count)(const SensorList*, Error**) = nullptr;
  void (*delete_sensor_list)(SensorList*) = nullptr;
  Sensor* (*create_sensor)(const SensorList*, int index, Error**) = nullptr;
  void (*delete_sensor)(Sensor*) = nullptr;
  int (*is_sensor_extendable_to)(const Sensor*, Extension, Error**) = nullptr;
  float (*get_depth_scale)(Sensor*, Error**) = nullptr;  // metres per unit

  Pipeline* (*create_pipeline)(Context*, Error**) = nullptr;
  void (*delete_pipeline)(Pipeline*) = nullptr;
  Config* (*create_config)(Error**) = nullptr;
  void (*delete_config)(Config*) = nullptr;
  void (*config_enable_device)(Config*, const char* serial, Error**) = nullptr;
  void (*config_enable_stream)(Config*, StreamKind, int index, int width, int height, Format, int rate_hz,
                               Error**) = nullptr;
  Profile* (*pipeline_start_with_config)(Pipeline*, Config*, Error**) = nullptr;
  void (*pipeline_stop)(Pipeline*, Error**) = nullptr;
  Device* (*pipeline_profile_get_device)(Profile*, Error**) = nullptr;  // the caller deletes it
  StreamList* (*pipeline_profile_get_streams)(Profile*, Error**) = nullptr;
  void (*delete_pipeline_profile)(Profile*) = nullptr;
  int (*get_stream_profiles_count)(const StreamList*, Error**) = nullptr;
  const Stream* (*get_stream_profile)(const StreamList*, int index, Error**) = nullptr;
  void (*delete_stream_profiles_list)(StreamList*) = nullptr;
  void (*get_stream_profile_data)(const Stream*, StreamKind*, Format*, int* index, int* id, int* rate_hz,
                                  Error**) = nullptr;
  void (*get_video_stream_intrinsics)(const Stream*, Intrinsics*, Error**) = nullptr;

  int (*pipeline_poll_for_frames)(Pipeline*, Frame**, Error**) = nullptr;  // 0: none is available
  int (*is_frame_extendable_to)(const Frame*, Extension, Error**) = nullptr;
  int (*embedded_frames_count)(Frame*, Error**) = nullptr;
  Frame* (*extract_frame)(Frame*, int index, Error**) = nullptr;  // the caller releases it
  void (*release_frame)(Frame*) = nullptr;
  const Stream* (*get_frame_stream_profile)(const Frame*, Error**) = nullptr;
  const void* (*get_frame_data)(const Frame*, Error**) = nullptr;
  int (*get_frame_width)(const Frame*, Error**) = nullptr;
  int (*get_frame_height)(const Frame*, Error**) = nullptr;
  int (*get_frame_stride_in_bytes)(const Frame*, Error**) = nullptr;
  double (*get_frame_timestamp)(const Frame*, Error**) = nullptr;  // ms
  unsigned long long (*get_frame_number)(const Frame*, Error**) = nullptr;
  // Functions that older versions lack. A function that is missing is null.
  int (*get_frame_data_size)(const Frame*, Error**) = nullptr;
  void (*project_point_to_pixel)(float pixel[2], const Intrinsics*, const float point[3]) = nullptr;
  void (*deproject_pixel_to_point)(float point[3], const Intrinsics*, const float pixel[2],
                                   float depth) = nullptr;
};

// Handles that are released once. The library has to outlive them.
struct Delete {
  const RealSenseLibrary* rs2;
  void operator()(Context* context) const { rs2->delete_context(context); }
  void operator()(DeviceList* list) const { rs2->delete_device_list(list); }
  void operator()(Device* device) const { rs2->delete_device(device); }
  void operator()(DeviceHub* hub) const { rs2->delete_device_hub(hub); }
  void operator()(SensorList* list) const { rs2->delete_sensor_list(list); }
  void operator()(Sensor* sensor) const { rs2->delete_sensor(sensor); }
  void operator()(Pipeline* pipeline) const { rs2->delete_pipeline(pipeline); }
  void operator()(Config* config) const { rs2->delete_config(config); }
  void operator()(Profile* profile) const { rs2->delete_pipeline_profile(profile); }
  void operator()(StreamList* list) const { rs2->delete_stream_profiles_list(list); }
  void operator()(Frame* frame) const { rs2->release_frame(frame); }
};
template <class Thing>
using Held = std::unique_ptr<Thing, Delete>;

// Calls functions of the library for a camera of this name. If one fails, throws InputError with the
// library's reason.
class Calls {
 public:
  Calls(const RealSenseLibrary& rs2, std::string name) : rs2_(rs2), name_(std::move(name)) {}

  // Returns the result of the function for these arguments and an error. what: text of the failure, such as
  // "depth does not start".
  template <class Result, class... Parameters, class... Arguments>
  Result operator()(const char* what, Result (*function)(Parameters...), Arguments... arguments) const {
    Error* error = nullptr;
    if constexpr (std::is_void_v<Result>) {
      function(arguments..., &error);
      check(what, error);
    } else {
      const Result result = function(arguments..., &error);
      check(what, error);
      return result;
    }
  }
  // Does the same for a function that returns a handle. Throws InputError also if the handle is null.
  template <class Thing, class... Parameters, class... Arguments>
  Held<Thing> held(const char* what, Thing* (*function)(Parameters...), Arguments... arguments) const {
    Held<Thing> thing((*this)(what, function, arguments...), {&rs2_});
    if (!thing) refuse(std::string(what) + " (the library gives no reason)");
    return thing;
  }
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  void check(const char* what, Error* error) const;

  const RealSenseLibrary& rs2_;
  const std::string name_;
};

}  // namespace remote_touch::rs2
