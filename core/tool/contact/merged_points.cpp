#include "core/tool/contact/merged_points.h"

#include <algorithm>
#include <numbers>

namespace remote_touch {

namespace {

constexpr double kMaxArea = 4;  // of the disk around the points, by the area that belongs to them

}  // namespace

std::optional<MergedPoint> merged_point(std::span<const CloudPoint> points, double spacing_m, double flat_m) {
  MergedPoint all{Vec3::Zero(), Vec3::Zero(), 0};
  for (const CloudPoint& point : points) all.p_W += point.p_W, all.n_W += point.n_W;
  const double length = all.n_W.norm(), count = static_cast<double>(points.size());
  if (!(length > 0.5 * count)) return {};  // false for NaN
  all.p_W /= count, all.n_W /= length;
  for (const CloudPoint& point : points) {
    const Vec3 offset = point.p_W - all.p_W;
    const double height_m = std::abs(offset.dot(all.n_W)) + spacing_m * (point.n_W - all.n_W).norm();
    if (height_m > flat_m) return {};
    all.extent_m = std::max(all.extent_m, offset.norm());
  }
  if (points.size() < 2) return {};
  const double area_m2 = std::numbers::pi * all.extent_m * all.extent_m;
  if (area_m2 > kMaxArea * count * spacing_m * spacing_m) return {};
  return all;
}

}  // namespace remote_touch
