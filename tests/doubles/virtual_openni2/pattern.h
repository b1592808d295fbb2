// The pattern that the virtual camera sees. Every pixel of every frame has a value of its own, so that a
// frame that is torn, turned round, repeated or shifted differs from the frame of its number.
#pragma once

#include <cstdint>
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

}  // namespace remote_touch::virtual_camera
