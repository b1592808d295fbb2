#include "runners/experiment/sessions/sensed_points.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace remote_touch {

void SensedPoints::add_image(const SensorFrame& frame, double metres_per_unit) {
  std::uint64_t measured = 0;
  std::uint16_t nearest = std::numeric_limits<std::uint16_t>::max(), farthest = 0;
  for (const std::uint16_t depth : frame.depth) {
    measured += depth != 0 ? 1 : 0;
    nearest = depth != 0 ? std::min(nearest, depth) : nearest;
    farthest = std::max(farthest, depth);
  }
  points_ += frame.depth.size(), measured_ += measured;
  if (measured == 0) return;
  nearest_m_ = std::min(nearest_m_, nearest * metres_per_unit);
  farthest_m_ = std::max(farthest_m_, farthest * metres_per_unit);
}

void SensedPoints::add_cloud(const SensorFrame& frame, std::size_t numbers_per_point) {
  points_ += frame.points.size() / numbers_per_point;
  for (std::size_t at = 0; at + numbers_per_point <= frame.points.size(); at += numbers_per_point) {
    const float* const p = frame.points.data() + at;
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    ++measured_;
    nearest_m_ = std::min<double>(nearest_m_, p[2]);
    farthest_m_ = std::max<double>(farthest_m_, p[2]);
  }
}

void SensedPoints::add(const SensorFrame& frame, const SensorView& view) {
  ++frames_;
  if (view.cloud)
    add_cloud(frame, view.cloud->numbers_per_point());
  else
    add_image(frame, view.metres_per_unit);
  are_clouds_ = view.cloud.has_value(), has_colours_ = view.has_colour;
}

std::string SensedPoints::text() const {
  const double share = points_ > 0 ? 100 * static_cast<double>(measured_) / static_cast<double>(points_) : 0;
  char measured[80], range[80];
  std::snprintf(measured, sizeof measured, "%.3g %% of %llu points measured", share,
                static_cast<unsigned long long>(points_));
  std::string text = measured;
  if (measured_ > 0) {
    std::snprintf(range, sizeof range, ", %s %.3g to %.3g m", are_clouds_ ? "z" : "depth", nearest_m_,
                  farthest_m_);
    text += range;
  }
  return text + (has_colours_ ? ", with colours" : ", without colours");
}

std::string layout_text(const SensorView& view) {
  if (view.cloud) return "clouds of points";
  return std::to_string(view.camera.width) + " x " + std::to_string(view.camera.height) + " pixels";
}

}  // namespace remote_touch
