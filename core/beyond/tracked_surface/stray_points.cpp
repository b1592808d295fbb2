#include "core/beyond/tracked_surface/stray_points.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {
constexpr double kMinNeighbourFraction = 0.25;
constexpr double kMinNeighbours = 2;  // not counting the point itself
}  // namespace

// Returns the index of a column. Columns are one contact radius wide, with an empty one as a border on either
// side.
int StrayPoints::column(double coordinate) const {
  return 1 + static_cast<int>(std::clamp(coordinate + half_side_, 0.0, side_ - 3.0));
}

int StrayPoints::layer(double height) const {
  return 1 + static_cast<int>(std::clamp((height + half_height_) / thickness_, 0.0, layers_ - 3.0));
}

void StrayPoints::count(const PatchPoints& points, const PatchRegion& region, double sigma,
                        double per_unit_area) {
  half_side_ = region.radius, half_height_ = region.half_height;
  side_ = static_cast<int>(std::ceil(2 * half_side_)) + 2;
  thickness_ = std::max({0.5, sigma, 2 * half_height_ / 127});
  layers_ = static_cast<int>(std::ceil(2 * half_height_ / thickness_)) + 2;
  min_ = std::max(kMinNeighbours + 1, kMinNeighbourFraction * 9 * per_unit_area);
  std::fill_n(counts_.begin(), side_ * side_ * layers_, std::uint16_t{0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.is_member(i)) continue;
    const PatchPlace p = points.place(i);
    std::uint16_t& c =
        counts_[static_cast<std::size_t>((layer(p.h) * side_ + column(p.v)) * side_ + column(p.u))];
    if (c < 60000) ++c;
  }
}

bool StrayPoints::is_surface(const PatchPlace& p) const {
  double sum = 0;
  for (int l = layer(p.h) - 1; l <= layer(p.h) + 1; ++l)
    for (int v = column(p.v) - 1; v <= column(p.v) + 1; ++v)
      for (int u = column(p.u) - 1; u <= column(p.u) + 1; ++u)
        sum += counts_[static_cast<std::size_t>((l * side_ + v) * side_ + u)];
  return sum >= min_;
}

}  // namespace remote_touch
