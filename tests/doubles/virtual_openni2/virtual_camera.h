// The virtual camera of OpenNI 2: the pattern that it sees, and functions that read how many frames it has
// sent, and that unplug it, for tests that must not depend on how long anything takes.
//
// Every pixel of every frame has a value of its own, so that a frame that is torn, turned round, repeated or
// shifted differs from the frame of its number.
#pragma once

#include <dlfcn.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace remote_touch::virtual_camera {

constexpr int kWidth = 640, kHeight = 480, kRate_hz = 30;
// The recorder's codec accepts depth up to the largest value that the driver reports.
constexpr int kMaxDepth = 10000;
constexpr float kDepthAcross_rad = 1.0f, kDepthDown_rad = 0.8f;
constexpr float kColourAcross_rad = 1.1f, kColourDown_rad = 0.85f;

// The first pixel holds the number. Some of the others hold no measurement.
inline std::uint16_t depth_at(int number, int u, int v) {
  if (u == 0 && v == 0) return static_cast<std::uint16_t>(number);
  if ((u + 3 * v + number) % 61 == 0) return 0;
  return static_cast<std::uint16_t>(400 + (7 * u + 13 * v + 31 * number) % 9600);
}

inline std::uint32_t colour_at(int number, int u, int v) {
  return static_cast<std::uint32_t>((number + 3 * u + 5 * v + 1000 * (u / 8)) & 0xffffff);
}

template <class Pixel>
std::vector<Pixel> image_of(Pixel (*pixel_at)(int, int, int), int number) {
  std::vector<Pixel> image(kWidth * kHeight);
  Pixel* to = image.data();
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) *to++ = pixel_at(number, u, v);
  return image;
}

inline std::vector<std::uint16_t> depth_image(int number) {
  return image_of(depth_at, number);
}
inline std::vector<std::uint32_t> colour_image(int number) {
  return image_of(colour_at, number);
}

// Calls the driver's function of this name if OpenNI 2 has loaded the driver. Otherwise returns Result().
template <class Result>
Result call_driver([[maybe_unused]] const char* function) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  const char* const file = REMOTE_TOUCH_VIRTUAL_OPENNI2 "/OpenNI2/Drivers/libVirtualCamera.so.0";
  const auto close = [](void* driver) { dlclose(driver); };
  const std::unique_ptr<void, decltype(close)> driver(dlopen(file, RTLD_LAZY | RTLD_NOLOAD), close);
  if (driver) return reinterpret_cast<Result (*)()>(dlsym(driver.get(), function))();
#endif
  return Result();
}

// Returns the number of the newest frame, depth and colour, that the library has received from the driver, or
// 0 if it has received none since the camera was opened.
inline int sent_frames() {
  return call_driver<int>("virtual_camera_sent");
}

// Makes the camera send no more frames and report that it was unplugged. A camera that is opened later is
// plugged in.
inline void unplug() {
  call_driver<void>("virtual_camera_unplug");
}

}  // namespace remote_touch::virtual_camera
