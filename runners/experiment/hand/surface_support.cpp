#include "runners/experiment/hand/surface_support.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/numeric/order_statistic.h"

namespace remote_touch {

double supported_depth(const DepthImage& image, int u, int v, const CameraIntrinsics& camera,
                       const Support& support) {
  if (u < 0 || v < 0 || u >= image.width || v >= image.height) return std::nan("");
  const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
  if (!(std::isfinite(z) && z > 0)) return std::nan("");
  const int across = reach_px(image, camera.fx, support.margin_m, z);
  const int down = reach_px(image, camera.fy, support.margin_m, z);
  if (u <= across || v <= down || u + across >= image.width || v + down >= image.height) return std::nan("");
  std::vector<double> seen;
  for (int y = v - down; y <= v + down; ++y) {
    for (int x = u - across; x <= u + across; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
      // NaN fails both comparisons, so a hole ends the search too.
      const bool joined = std::abs(image.z_m[i] - image.z_m[i - 1]) <= support.edge_jump_m &&
                          std::abs(image.z_m[i] - image.z_m[i - image.width]) <= support.edge_jump_m;
      if (!joined) return std::nan("");
      seen.push_back(image.z_m[i]);
    }
  }
  return median_in_place(seen);
}

int reach_px(const DepthImage& image, double focal_px, double length_m, double depth_m) {
  if (!(depth_m > 0)) return 1;
  const double most = std::max({1, image.width, image.height});
  return static_cast<int>(std::clamp(focal_px * length_m / depth_m, 1.0, most));
}

std::optional<ImagePixel> nearest_supported(const DepthImage& image, const ImagePixel& to,
                                            const CameraIntrinsics& camera, const Support& support) {
  std::optional<ImagePixel> nearest;
  long least = std::numeric_limits<long>::max();
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const long across = u - to.column, down = v - to.row, squared = across * across + down * down;
      if (squared >= least || std::isnan(supported_depth(image, u, v, camera, support))) continue;
      least = squared;
      nearest = ImagePixel{v, u};
    }
  return nearest;
}

namespace {

bool is_measured(const DepthImage& image, int u, int v) {
  return std::isfinite(image.z_m[static_cast<std::size_t>(v) * image.width + u]);
}

// Returns true if a hole in the image is at most one pixel away, also diagonally.
bool is_rim(const DepthImage& image, int u, int v) {
  for (int y = std::max(0, v - 1); y <= std::min(image.height - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(image.width - 1, u + 1); ++x)
      if (!is_measured(image, x, y)) return true;
  return false;
}

}  // namespace

// Distances are in pixels along a row.
DepthImage bridged(const DepthImage& image, const CameraIntrinsics& camera, double hole_m) {
  constexpr double kMaxReach_px = 64;  // bounds the work for points close to the lens
  const double row_distance = camera.fx / camera.fy;
  DepthImage closed = image;
  std::vector<double> distance_squared(image.z_m.size(), std::numeric_limits<double>::infinity());
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
      if (!(std::isfinite(z) && z > 0) || !is_rim(image, u, v)) continue;
      const double reach = std::min(0.5 * hole_m * camera.fx / z, kMaxReach_px);
      const int across = static_cast<int>(reach);
      const int down = static_cast<int>(std::min(reach / row_distance, kMaxReach_px));
      for (int y = std::max(0, v - down); y <= std::min(image.height - 1, v + down); ++y)
        for (int x = std::max(0, u - across); x <= std::min(image.width - 1, u + across); ++x) {
          const double below = (y - v) * row_distance, squared = (x - u) * (x - u) + below * below;
          const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
          if (squared > reach * reach || std::isfinite(image.z_m[i]) || squared > distance_squared[i])
            continue;
          if (squared == distance_squared[i] && z >= closed.z_m[i]) continue;
          distance_squared[i] = squared, closed.z_m[i] = z;
        }
    }
  return closed;
}

const DepthImage& BridgeableImage::closed() {
  if (!closed_) closed_ = bridged(measured_, camera_, hole_m_);
  return *closed_;
}

double nearest_depth(const DepthImage& image, const PixelWindow& window) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int v = std::max(0, window.first_row); v <= std::min(image.height - 1, window.last_row); ++v)
    for (int u = std::max(0, window.first_column); u <= std::min(image.width - 1, window.last_column); ++u) {
      const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
      if (z < nearest) nearest = z;  // not if NaN
    }
  return nearest;
}

double median_depth(const DepthImage& image, const PixelWindow& window) {
  std::vector<double> depths;
  for (int v = std::max(0, window.first_row); v <= std::min(image.height - 1, window.last_row); ++v)
    for (int u = std::max(0, window.first_column); u <= std::min(image.width - 1, window.last_column); ++u)
      if (is_measured(image, u, v))
        depths.push_back(image.z_m[static_cast<std::size_t>(v) * image.width + u]);
  return depths.empty() ? std::nan("") : median_in_place(depths);
}

double in_front_of(double depth_m, double clearance_m) {
  return std::max(depth_m - clearance_m, 0.5 * depth_m);
}

std::string millimetres(double length_m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", 1e3 * length_m);
  return text;
}

}  // namespace remote_touch
