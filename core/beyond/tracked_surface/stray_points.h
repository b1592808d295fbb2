// Points of a patch that do not belong to its sheet: points of other surfaces, or outliers.
#pragma once

#include <cstdint>
#include <vector>

#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// Distinguishes the two by density. A point belongs to a surface if the number of points per area around it,
// in layers at least as thick as the noise, is at least a quarter of the sheet's, and if there are at least
// two other points.
class StrayPoints {
 public:
  // Counts the points that are no members. per_unit_area: number of members in a square of one contact
  // radius.
  void count(const PatchPoints& points, const PatchRegion& region, double sigma, double per_unit_area);
  // Returns true if the point belongs to a surface. pre: the point is no member.
  bool is_surface(const PatchPlace& p) const;

 private:
  int column(double coordinate) const;
  int layer(double height) const;

  double half_side_ = 0, half_height_ = 0, thickness_ = 1, min_ = 0;
  int side_ = 0, layers_ = 0;
  std::vector<std::uint16_t> counts_ = std::vector<std::uint16_t>(kMaxCount);
  static constexpr std::size_t kMaxCount = 18 * 18 * 130;
};

}  // namespace remote_touch
