// The functions of the k4a interface that its adapter calls. The interface is that of the Azure Kinect;
// Orbbec's wrapper for the Femto has it as well. It is declared here from its documentation, so no header of
// the vendors is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "runners/libraries/shared_library.h"

namespace remote_touch::k4a {

struct CaptureOfLibrary;
struct DeviceOfLibrary;
struct ImageOfLibrary;

using Device = DeviceOfLibrary*;
using Capture = CaptureOfLibrary*;
using Image = ImageOfLibrary*;

enum Result : int { succeeded = 0, failed = 1 };
enum WaitResult : int { wait_succeeded = 0, wait_failed = 1, wait_timeout = 2 };
enum DepthMode : int { nfov_2x2_binned = 1, nfov_unbinned = 2, wfov_2x2_binned = 3, wfov_unbinned = 4 };
enum Fps : int { fps_15 = 1, fps_30 = 2 };
enum ColourResolution : int { colour_off = 0 };
enum Camera : int { depth_camera = 0 };
enum ImageFormat : int { depth16 = 4 };
enum LogLevel : int { log_error = 1 };

struct Configuration {
  int colour_format = 0;
  ColourResolution colour_resolution = colour_off;
  DepthMode depth_mode = nfov_unbinned;
  Fps camera_fps = fps_30;
  bool synchronized_images_only = false;
  std::int32_t depth_delay_off_colour_us = 0;
  int wired_sync_mode = 0;  // 0: the camera works without others
  std::uint32_t subordinate_delay_off_master_us = 0;
  bool disable_streaming_indicator = false;
};
static_assert(sizeof(Configuration) == 36 && offsetof(Configuration, depth_mode) == 8 &&
              offsetof(Configuration, depth_delay_off_colour_us) == 20 &&
              offsetof(Configuration, disable_streaming_indicator) == 32);

struct Float2 {
  float x, y;
};
struct Float3 {
  float x, y, z;
};

// Only functions of the library write and read it, and the adapter maps points with them. So the adapter does
// not depend on the layout (1032 bytes in version 1.4), nor on the lens model.
struct alignas(16) Calibration {
  std::byte bytes[8192];
};

struct K4aLibrary {
  K4aLibrary();  // throws InputError if it is not found

  // Returns the library's message about its first error since the last call, in one line; empty if there was
  // none. The message may come from any thread and device, because the library has one log.
  std::string pop_first_error() const;

  SharedLibrary library;
  std::uint32_t (*device_get_installed_count)() = library["k4a_device_get_installed_count"];
  Result (*device_open)(std::uint32_t index, Device* device) = library["k4a_device_open"];
  void (*device_close)(Device) = library["k4a_device_close"];
  int (*device_get_serialnum)(Device, char* serial,
                              std::size_t* size) = library["k4a_device_get_serialnum"];  // 0: succeeded
  Result (*device_get_calibration)(Device, DepthMode, ColourResolution,
                                   Calibration*) = library["k4a_device_get_calibration"];
  Result (*device_start_cameras)(Device, const Configuration*) = library["k4a_device_start_cameras"];
  void (*device_stop_cameras)(Device) = library["k4a_device_stop_cameras"];
  WaitResult (*device_get_capture)(Device, Capture*,
                                   std::int32_t timeout_ms) = library["k4a_device_get_capture"];
  Result (*calibration_2d_to_3d)(const Calibration*, const Float2* pixel, float depth_mm, Camera source,
                                 Camera target, Float3* point_mm,
                                 int* is_valid) = library["k4a_calibration_2d_to_3d"];
  Result (*calibration_3d_to_2d)(const Calibration*, const Float3* point_mm, Camera source, Camera target,
                                 Float2* pixel, int* is_valid) = library["k4a_calibration_3d_to_2d"];
  Image (*capture_get_depth_image)(Capture) =
      library["k4a_capture_get_depth_image"];  // null: none; the caller releases it
  void (*capture_release)(Capture) = library["k4a_capture_release"];
  std::uint8_t* (*image_get_buffer)(Image) = library["k4a_image_get_buffer"];
  std::size_t (*image_get_size)(Image) = library["k4a_image_get_size"];
  ImageFormat (*image_get_format)(Image) = library["k4a_image_get_format"];
  int (*image_get_width_pixels)(Image) = library["k4a_image_get_width_pixels"];
  int (*image_get_height_pixels)(Image) = library["k4a_image_get_height_pixels"];
  int (*image_get_stride_bytes)(Image) = library["k4a_image_get_stride_bytes"];
  std::uint64_t (*image_get_device_timestamp_us)(Image) = library["k4a_image_get_device_timestamp_usec"];
  void (*image_release)(Image) = library["k4a_image_release"];
  // A function that some versions lack. It is null if it is missing.
  using LogCallback = void(void* context, LogLevel, const char* file, int line, const char* message);
  Result (*set_debug_message_handler)(LogCallback*, void* context,
                                      LogLevel min_level) = library.optional("k4a_set_debug_message_handler");
};

// Handles that are released once. The library has to outlive them.
struct Close {
  const K4aLibrary* k4a;
  void operator()(Device device) const { k4a->device_close(device); }
  void operator()(Capture capture) const { k4a->capture_release(capture); }
  void operator()(Image image) const { k4a->image_release(image); }
};
using OpenDevice = std::unique_ptr<DeviceOfLibrary, Close>;
using HeldCapture = std::unique_ptr<CaptureOfLibrary, Close>;
using HeldImage = std::unique_ptr<ImageOfLibrary, Close>;

}  // namespace remote_touch::k4a
