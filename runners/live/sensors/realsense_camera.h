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

struct Config;
struct Context;
struct Device;
struct DeviceHub;
struct DeviceList;
struct Error;
struct Frame;
struct Pipeline;
struct Sensor;
struct SensorList;
struct StreamList;
struct Profile;  // profile of a running pipeline
struct Stream;   // belongs to its list or its frame

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

  std::string version_text() const;
  // Returns the text of an error, and frees the error.
  std::string text_of(Error* error) const;

  SharedLibrary library;
  int (*get_api_version)(Error**) = library["rs2_get_api_version"];
  const char* (*get_error_message)(const Error*) = library["rs2_get_error_message"];
  const char* (*get_failed_function)(const Error*) = library["rs2_get_failed_function"];
  void (*free_error)(Error*) = library["rs2_free_error"];
  // The version that the library reports: 25605 is 2.56.5. A context is created with this same version,
  // because the library refuses an application that was compiled for a newer one. It is known before the
  // functions below are looked up, because another major version may lack them.
  int version = checked_version();

  Context* (*create_context)(int api_version, Error**) = library["rs2_create_context"];
  void (*delete_context)(Context*) = library["rs2_delete_context"];
  DeviceList* (*query_devices)(const Context*, Error**) = library["rs2_query_devices"];
  int (*get_device_count)(const DeviceList*, Error**) = library["rs2_get_device_count"];
  void (*delete_device_list)(DeviceList*) = library["rs2_delete_device_list"];
  Device* (*create_device)(const DeviceList*, int index, Error**) = library["rs2_create_device"];
  void (*delete_device)(Device*) = library["rs2_delete_device"];
  const char* (*get_device_info)(const Device*, CameraInfo,
                                 Error**) = library["rs2_get_device_info"];  // belongs to the device
  int (*supports_device_info)(const Device*, CameraInfo, Error**) = library["rs2_supports_device_info"];
  DeviceHub* (*create_device_hub)(const Context*, Error**) = library["rs2_create_device_hub"];
  void (*delete_device_hub)(const DeviceHub*) = library["rs2_delete_device_hub"];
  int (*device_hub_is_device_connected)(const DeviceHub*, const Device*,
                                        Error**) = library["rs2_device_hub_is_device_connected"];
  SensorList* (*query_sensors)(const Device*, Error**) = library["rs2_query_sensors"];
  int (*get_sensors_count)(const SensorList*, Error**) = library["rs2_get_sensors_count"];
  void (*delete_sensor_list)(SensorList*) = library["rs2_delete_sensor_list"];
  Sensor* (*create_sensor)(const SensorList*, int index, Error**) = library["rs2_create_sensor"];
  void (*delete_sensor)(Sensor*) = library["rs2_delete_sensor"];
  int (*is_sensor_extendable_to)(const Sensor*, Extension, Error**) = library["rs2_is_sensor_extendable_to"];
  float (*get_depth_scale)(Sensor*, Error**) = library["rs2_get_depth_scale"];  // metres per unit

  Pipeline* (*create_pipeline)(Context*, Error**) = library["rs2_create_pipeline"];
  void (*delete_pipeline)(Pipeline*) = library["rs2_delete_pipeline"];
  Config* (*create_config)(Error**) = library["rs2_create_config"];
  void (*delete_config)(Config*) = library["rs2_delete_config"];
  void (*config_enable_device)(Config*, const char* serial, Error**) = library["rs2_config_enable_device"];
  void (*config_enable_stream)(Config*, StreamKind, int index, int width, int height, Format, int rate_hz,
                               Error**) = library["rs2_config_enable_stream"];
  Profile* (*pipeline_start_with_config)(Pipeline*, Config*,
                                         Error**) = library["rs2_pipeline_start_with_config"];
  void (*pipeline_stop)(Pipeline*, Error**) = library["rs2_pipeline_stop"];
  Device* (*pipeline_profile_get_device)(Profile*, Error**) =
      library["rs2_pipeline_profile_get_device"];  // the caller deletes it
  StreamList* (*pipeline_profile_get_streams)(Profile*,
                                              Error**) = library["rs2_pipeline_profile_get_streams"];
  void (*delete_pipeline_profile)(Profile*) = library["rs2_delete_pipeline_profile"];
  int (*get_stream_profiles_count)(const StreamList*, Error**) = library["rs2_get_stream_profiles_count"];
  const Stream* (*get_stream_profile)(const StreamList*, int index,
                                      Error**) = library["rs2_get_stream_profile"];
  void (*delete_stream_profiles_list)(StreamList*) = library["rs2_delete_stream_profiles_list"];
  void (*get_stream_profile_data)(const Stream*, StreamKind*, Format*, int* index, int* id, int* rate_hz,
                                  Error**) = library["rs2_get_stream_profile_data"];
  void (*get_video_stream_intrinsics)(const Stream*, Intrinsics*,
                                      Error**) = library["rs2_get_video_stream_intrinsics"];

  int (*pipeline_poll_for_frames)(Pipeline*, Frame**,
                                  Error**) = library["rs2_pipeline_poll_for_frames"];  // 0: none is available
  int (*is_frame_extendable_to)(const Frame*, Extension, Error**) = library["rs2_is_frame_extendable_to"];
  int (*embedded_frames_count)(Frame*, Error**) = library["rs2_embedded_frames_count"];
  Frame* (*extract_frame)(Frame*, int index,
                          Error**) = library["rs2_extract_frame"];  // the caller releases it
  void (*release_frame)(Frame*) = library["rs2_release_frame"];
  const Stream* (*get_frame_stream_profile)(const Frame*, Error**) = library["rs2_get_frame_stream_profile"];
  const void* (*get_frame_data)(const Frame*, Error**) = library["rs2_get_frame_data"];
  int (*get_frame_width)(const Frame*, Error**) = library["rs2_get_frame_width"];
  int (*get_frame_height)(const Frame*, Error**) = library["rs2_get_frame_height"];
  int (*get_frame_stride_in_bytes)(const Frame*, Error**) = library["rs2_get_frame_stride_in_bytes"];
  double (*get_frame_timestamp)(const Frame*, Error**) = library["rs2_get_frame_timestamp"];  // ms
  unsigned long long (*get_frame_number)(const Frame*, Error**) = library["rs2_get_frame_number"];
  // Functions that older versions lack. A function that is missing is null.
  int (*get_frame_data_size)(const Frame*, Error**) = library.optional("rs2_get_frame_data_size");
  void (*project_point_to_pixel)(float pixel[2], const Intrinsics*,
                                 const float point[3]) = library.optional("rs2_project_point_to_pixel");
  void (*deproject_pixel_to_point)(float point[3], const Intrinsics*, const float pixel[2],
                                   float depth) = library.optional("rs2_deproject_pixel_to_point");

 private:
  int checked_version() const;
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
