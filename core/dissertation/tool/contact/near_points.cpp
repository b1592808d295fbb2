#include "core/dissertation/tool/contact/near_points.h"

#include <cmath>

#include "core/dissertation/tool/contact/posed_field.h"

namespace remote_touch {

void NearPoints::reserve(std::size_t padded_size) {
  groups_.reserve(padded_size), points_.grow(padded_size + kLanes);
  count_ = 0;
}

void NearPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                       double reach_m) {
  const GroupsInReach groups = groups_.within(finder, pose, reach_m);
  std::size_t outside_count = 0;
  count_ = kernels.tool.points_in_field(
      finder.cloud().columns(), groups.group, groups.count, posed_field(finder.tool(), pose),
      {reach_m, groups.passed_m}, groups.nearest_m, groups.is_new,
      {{points_[kX], points_[kY], points_[kZ]}, points_[kDistance], points_[kNumber]}, outside_count);
  groups_.on_measured();
  if (outside_count > 0) finish_outside(finder.tool(), reach_m);
}

// Completes the points for which the kernel wrote NaN, because they lie less than a cell outside the grid.
// Drops the points beyond reach_m.
void NearPoints::finish_outside(const VoxelTool& tool, double reach_m) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::isnan(distance_m(i))) points_[kDistance][i] = sample_field(tool, p_T(i)).distance_m;
    if (distance_m(i) > reach_m) continue;
    for (std::size_t column = 0; column < kColumns; ++column) points_[column][kept] = points_[column][i];
    ++kept;
  }
  count_ = kept;
}

}  // namespace remote_touch
