#include "core/points/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace remote_touch {

std::uint32_t colour_of_float(std::uint32_t bits) {
  constexpr std::uint32_t kComputedNan = 0xFFC00000;
  const std::uint32_t alpha = bits >> 24;
  const bool has_colour = (alpha == 0 || alpha == 0xFF) && bits != kComputedNan;
  return has_colour ? bits & 0xFFFFFF : kNoColour;
}

HueSaturationLightness hue_saturation_lightness(std::uint32_t rgb) {
  const int red = rgb >> 16 & 0xFF, green = rgb >> 8 & 0xFF, blue = rgb & 0xFF;
  const int high = std::max({red, green, blue}), low = std::min({red, green, blue});
  const double chroma = high - low, sum = high + low;
  HueSaturationLightness colour;
  colour.lightness = sum / 510;
  if (high == low) return colour;
  colour.saturation = chroma / (255 - std::abs(sum - 255));
  double sixth = 0;
  if (high == red)
    sixth = (green - blue) / chroma + (green < blue ? 6 : 0);
  else if (high == green)
    sixth = (blue - red) / chroma + 2;
  else
    sixth = (red - green) / chroma + 4;
  colour.hue_deg = 60 * sixth;
  return colour;
}

// Each channel has its own hue: 0, 120 or 240 degrees. Its value is full while the hue is within 60 degrees
// of its own, and falls linearly to the minimum at 120 degrees.
std::uint32_t rgb(const HueSaturationLightness& colour) {
  const double half_chroma = colour.saturation * std::min(colour.lightness, 1 - colour.lightness);
  std::uint32_t value = 0;
  for (const double own_deg : {0.0, 120.0, 240.0}) {
    const double off_deg = std::abs(colour.hue_deg - own_deg), away_deg = std::min(off_deg, 360 - off_deg);
    const double level = colour.lightness + half_chroma * std::clamp((90 - away_deg) / 30, -1.0, 1.0);
    value = value << 8 | static_cast<std::uint32_t>(std::floor(255 * level + 0.5));
  }
  return value;
}

Vec3 unproject(const CameraIntrinsics& camera, double u, double v, double z_m) {
  return {(u - camera.cx) * z_m / camera.fx, (v - camera.cy) * z_m / camera.fy, z_m};
}

std::string size_text(const CameraIntrinsics& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels";
}

namespace {

void require_size(const DepthImage& depth, const CameraIntrinsics& camera) {
  if (depth.width != camera.width || depth.height != camera.height)
    throw std::invalid_argument("depth image: " + std::to_string(depth.width) + " x " +
                                std::to_string(depth.height) + " pixels: expected the camera's " +
                                size_text(camera));
  if (depth.z_m.size() != camera.pixels())
    throw std::invalid_argument("depth image: " + std::to_string(depth.z_m.size()) +
                                " depths: expected one for each of " + size_text(camera));
}

}  // namespace

PointCloud cloud_from_depth(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC) {
  require_size(depth, camera);
  PointCloud cloud;
  const std::size_t count = depth.z_m.size();
  cloud.x.resize(count), cloud.y.resize(count), cloud.z.resize(count);
  // A pixel projects back onto itself up to rounding; 1e-6 px covers it for every image size in use.
  cloud.image = ImageLayout{camera, X_WC, 1e-6};
#pragma omp parallel for schedule(static)
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * depth.width + u;
      const Vec3 p_W = X_WC * unproject(camera, u, v, depth.z_m[i]);  // NaN depth gives a NaN point
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
    }
  }
  return cloud;
}

}  // namespace remote_touch
