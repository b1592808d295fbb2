#include "runners/experiment/sessions/sensor_frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"

namespace remote_touch {
namespace {

// Normalises a normal, because its length is not exactly 1 after rounding to floats.
Vec3 unit(const Vec3& n) {
  return n / n.norm();
}

PointCloud cloud_of_points(const SensorFrame& frame, const CloudLayout& layout, const RigidTransform& X_WC) {
  PointCloud cloud;
  const std::size_t step = layout.numbers_per_point();
  for (std::size_t at = 0; at + step <= frame.points.size(); at += step) {
    const auto vector = [&](std::size_t i) {
      return Vec3(frame.points[at + i], frame.points[at + i + 1], frame.points[at + i + 2]);
    };
    if (layout.has_normals)
      cloud.append(X_WC * vector(0), X_WC.linear() * unit(vector(3)));
    else
      cloud.append(X_WC * vector(0));
  }
  cloud.grid_columns = layout.grid_columns;
  cloud.colour = frame.colour;
  return cloud;
}

}  // namespace

bool is_complete(const SensorFrame& frame, const SensorView& view) {
  const std::size_t step = view.cloud ? view.cloud->numbers_per_point() : 1;
  const std::size_t points = view.cloud ? frame.points.size() / step : view.camera.pixels();
  const bool has_points = view.cloud ? frame.points.size() % step == 0 : frame.depth.size() == points;
  return has_points && (!view.has_colour || frame.colour.size() == points);
}

PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC) {
  if (view.cloud) return cloud_of_points(frame, *view.cloud, X_WC);
  DepthImage depth{view.camera.width, view.camera.height, {}};
  depth.z_m.reserve(frame.depth.size());
  for (const std::uint16_t units : frame.depth)
    depth.z_m.push_back(units == 0 ? std::numeric_limits<double>::quiet_NaN() : units * view.metres_per_unit);
  PointCloud cloud = cloud_from_depth(depth, view.camera, X_WC);
  cloud.colour = frame.colour;
  return cloud;
}

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
  assert(is_complete(frame, view));
  ++frames_;
  if (view.cloud)
    add_cloud(frame, view.cloud->numbers_per_point());
  else
    add_image(frame, view.metres_per_unit);
  are_clouds_ = view.cloud.has_value(), has_colours_ = view.has_colour;
}

std::string SensedPoints::text() const {
  const double share = points_ > 0 ? 100 * static_cast<double>(measured_) / static_cast<double>(points_) : 0;
  std::string text =
      formatted("%.3g %% of %llu points measured", share, static_cast<unsigned long long>(points_));
  if (measured_ > 0)
    text += formatted(", %s %.3g to %.3g m", are_clouds_ ? "z" : "depth", nearest_m_, farthest_m_);
  return text + (has_colours_ ? ", with colours" : ", without colours");
}

std::string layout_text(const SensorView& view) {
  if (view.cloud) return "clouds of points";
  return std::to_string(view.camera.width) + " x " + std::to_string(view.camera.height) + " pixels";
}

}  // namespace remote_touch
