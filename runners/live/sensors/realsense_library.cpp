#include "runners/live/sensors/realsense_library.h"

#include "core/parameters/input_error.h"

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

void find_devices(RealSenseLibrary& rs2) {
  const SharedLibrary& library = rs2.library;
  library.find("rs2_create_context", rs2.create_context);
  library.find("rs2_delete_context", rs2.delete_context);
  library.find("rs2_query_devices", rs2.query_devices);
  library.find("rs2_get_device_count", rs2.get_device_count);
  library.find("rs2_delete_device_list", rs2.delete_device_list);
  library.find("rs2_create_device", rs2.create_device);
  library.find("rs2_delete_device", rs2.delete_device);
  library.find("rs2_get_device_info", rs2.get_device_info);
  library.find("rs2_supports_device_info", rs2.supports_device_info);
  library.find("rs2_create_device_hub", rs2.create_device_hub);
  library.find("rs2_delete_device_hub", rs2.delete_device_hub);
  library.find("rs2_device_hub_is_device_connected", rs2.device_hub_is_device_connected);
  library.find("rs2_query_sensors", rs2.query_sensors);
  library.find("rs2_get_sensors_count", rs2.get_sensors_count);
  library.find("rs2_delete_sensor_list", rs2.delete_sensor_list);
  library.find("rs2_create_sensor", rs2.create_sensor);
  library.find("rs2_delete_sensor", rs2.delete_sensor);
  library.find("rs2_is_sensor_extendable_to", rs2.is_sensor_extendable_to);
  library.find("rs2_get_depth_scale", rs2.get_depth_scale);
}

void find_pipeline(RealSenseLibrary& rs2) {
  const SharedLibrary& library = rs2.library;
  library.find("rs2_create_pipeline", rs2.create_pipeline);
  library.find("rs2_delete_pipeline", rs2.delete_pipeline);
  library.find("rs2_create_config", rs2.create_config);
  library.find("rs2_delete_config", rs2.delete_config);
  library.find("rs2_config_enable_device", rs2.config_enable_device);
  library.find("rs2_config_enable_stream", rs2.config_enable_stream);
  library.find("rs2_pipeline_start_with_config", rs2.pipeline_start_with_config);
  library.find("rs2_pipeline_stop", rs2.pipeline_stop);
  library.find("rs2_pipeline_profile_get_device", rs2.pipeline_profile_get_device);
  library.find("rs2_pipeline_profile_get_streams", rs2.pipeline_profile_get_streams);
  library.find("rs2_delete_pipeline_profile", rs2.delete_pipeline_profile);
  library.find("rs2_get_stream_profiles_count", rs2.get_stream_profiles_count);
  library.find("rs2_get_stream_profile", rs2.get_stream_profile);
  library.find("rs2_delete_stream_profiles_list", rs2.delete_stream_profiles_list);
  library.find("rs2_get_stream_profile_data", rs2.get_stream_profile_data);
  library.find("rs2_get_video_stream_intrinsics", rs2.get_video_stream_intrinsics);
}

void find_frames(RealSenseLibrary& rs2) {
  const SharedLibrary& library = rs2.library;
  library.find("rs2_pipeline_poll_for_frames", rs2.pipeline_poll_for_frames);
  library.find("rs2_is_frame_extendable_to", rs2.is_frame_extendable_to);
  library.find("rs2_embedded_frames_count", rs2.embedded_frames_count);
  library.find("rs2_extract_frame", rs2.extract_frame);
  library.find("rs2_release_frame", rs2.release_frame);
  library.find("rs2_get_frame_stream_profile", rs2.get_frame_stream_profile);
  library.find("rs2_get_frame_data", rs2.get_frame_data);
  library.find("rs2_get_frame_width", rs2.get_frame_width);
  library.find("rs2_get_frame_height", rs2.get_frame_height);
  library.find("rs2_get_frame_stride_in_bytes", rs2.get_frame_stride_in_bytes);
  library.find("rs2_get_frame_timestamp", rs2.get_frame_timestamp);
  library.find("rs2_get_frame_number", rs2.get_frame_number);
  library.find_optional("rs2_get_frame_data_size", rs2.get_frame_data_size);
  library.find_optional("rs2_project_point_to_pixel", rs2.project_point_to_pixel);
  library.find_optional("rs2_deproject_pixel_to_point", rs2.deproject_pixel_to_point);
}

}  // namespace

RealSenseLibrary::RealSenseLibrary() : library(realsense_lookup()) {
  library.find("rs2_get_api_version", get_api_version);
  library.find("rs2_get_error_message", get_error_message);
  library.find("rs2_get_failed_function", get_failed_function);
  library.find("rs2_free_error", free_error);
  version = Calls(*this, library.file())("does not report its version", get_api_version);
  if (version / 10000 != kMajor)
    throw InputError(library.file(), "is version " + version_text() + " of its interface: expected " +
                                         std::to_string(kMajor) + ".x");
  find_devices(*this);
  find_pipeline(*this);
  find_frames(*this);
}

std::string RealSenseLibrary::version_text() const {
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
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

}  // namespace remote_touch::rs2
