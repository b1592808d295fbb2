#include "scenarios/camera/baseline_shadow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace remote_touch {

namespace {

// One row of the image. ahead[u] = d - u is the same all along a line towards the device: a surface that
// crosses the value of a point, to the right of the point, hides it from the device.
class ImageRow {
 public:
  ImageRow(const double* z_m, int width, double focal_baseline_px_m, double edge_jump_m)
      : z_m_(z_m), width_(width), edge_jump_m_(edge_jump_m) {
    const auto size = static_cast<std::size_t>(width);
    ahead_.resize(size), most_ahead_.resize(size + 1, -std::numeric_limits<double>::infinity());
    for (int u = width - 1; u >= 0; --u) {
      ahead_[u] =
          is_measured(u) ? focal_baseline_px_m / z_m[u] - u : -std::numeric_limits<double>::infinity();
      most_ahead_[u] = std::max(most_ahead_[u + 1], ahead_[u] + 0.5);
    }
  }

  bool is_in_shadow(int u) const {
    // No surface on the right is so near that the line to the device passes behind a part of it.
    if (!is_measured(u) || most_ahead_[u + 1] < ahead_[u]) return false;
    if (is_connected(u) && ahead_[u + 1] >= ahead_[u]) return true;  // it turns its back to the device
    for (int w = u + 1; w < width_ && most_ahead_[w] >= ahead_[u]; ++w)
      if (is_crossed_before(w, ahead_[u]) || is_crossed_after(w, ahead_[u])) return true;
    return false;
  }

 private:
  bool is_measured(int u) const { return z_m_[u] > 0; }  // false for NaN
  // True if the pixels u and u + 1 see the same surface.
  bool is_connected(int u) const { return u + 1 < width_ && std::abs(z_m_[u] - z_m_[u + 1]) <= edge_jump_m_; }
  // True if the surface of pixel w crosses the line in the half pixel before w, where it begins.
  bool is_crossed_before(int w, double line) const {
    return !is_connected(w - 1) && ahead_[w] <= line && line <= ahead_[w] + 0.5;
  }
  // True if the surface of pixel w crosses the line before pixel w + 1, or before its end behind w.
  bool is_crossed_after(int w, double line) const {
    const double here = ahead_[w], next = is_connected(w) ? ahead_[w + 1] : here - 0.5;
    return std::min(here, next) <= line && line <= std::max(here, next);
  }

  const double* z_m_;
  int width_;
  double edge_jump_m_;
  std::vector<double> ahead_;       // -infinity where nothing is measured
  std::vector<double> most_ahead_;  // largest value of this pixel and those to its right, with their borders
};

}  // namespace

std::vector<char> baseline_shadow(const DepthImage& depth, double focal_baseline_px_m, double edge_jump_m) {
  std::vector<char> hidden(depth.z_m.size(), 0);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < depth.height; ++v) {
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width);
    const ImageRow row(&depth.z_m[first], depth.width, focal_baseline_px_m, edge_jump_m);
    for (int u = 0; u < depth.width; ++u) hidden[first + static_cast<std::size_t>(u)] = row.is_in_shadow(u);
  }
  return hidden;
}

}  // namespace remote_touch
