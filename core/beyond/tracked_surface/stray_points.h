// Points of a patch that are not of its sheet: other surfaces, or outliers.
#pragma once

#include <cstdint>
#include <vector>

#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// Distinguishes the two by density: around each point of a surface, in a layer as thick as the noise, there
// are at least a fair fraction of the sheet's points per area.
class StrayPoints {
 public:
  // per_unit_area: members in a square of one contact radius.
  void count(const PatchPoints& points, const PatchRegion& region, double sigma, double per_unit_area);
  // pre: the point is no member.
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
