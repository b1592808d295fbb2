#include "core/dissertation/tool/contact/near_points.h"

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool/contact/posed_field.h"

namespace remote_touch {

void NearPoints::reserve(std::size_t padded_size) {
  groups_.reserve(padded_size), points_.grow(padded_size + kLanes);
  on_way_.index.grow(padded_size / kLanes + 1), on_way_.group.grow(padded_size / kLanes + 1);
  on_way_.nearest_m.grow(padded_size / kLanes + 1);
  count_ = 0;
}

void NearPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                       double reach_m) {
  measure(finder, kernels, pose, reach_m, groups_.within(finder, pose, reach_m));
  groups_.on_measured();
}

void NearPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                       const SlabWay& way) {
  if (!finder.cloud().packed().has_slabs()) return query(finder, kernels, pose, way.far);
  const GroupsInReach all = groups_.within(finder, pose, way.far);
  const PosedField field = posed_field(finder.tool(), pose);
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.count; ++i) {
    on_way_.index[count] = static_cast<std::uint32_t>(i);
    count += all.nearest_m[i] > all.passed_m ? 0 : 1;
  }
  for (const int parts : {1, 2, 4})
    count = kernels.tool.slabs_on_way(finder.cloud().packed().slabs(), all.group, on_way_.index.data(), count,
                                      field, finder.slopes(), way, parts, all.nearest_m,
                                      all.passed_m - way.far, on_way_.index.data());
  for (std::size_t i = 0; i < count; ++i) {
    on_way_.group[i] = all.group[on_way_.index[i]];
    on_way_.nearest_m[i] = all.nearest_m[on_way_.index[i]];
  }
  measure(finder, kernels, pose, way.far,
          {on_way_.group.data(), count, on_way_.nearest_m.data(), all.is_new, all.passed_m});
  for (std::size_t i = 0; all.is_new && i < count; ++i)
    all.nearest_m[on_way_.index[i]] = on_way_.nearest_m[i];
  groups_.on_measured();
}

// Measures the points in portions, because the first portion of a surface in the tool mostly has one.
bool NearPoints::has_below(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                           double value_m, double search_m) {
  constexpr std::size_t kPortion = 64;
  const GroupsInReach all = groups_.within(finder, pose, search_m);
  const double passed_m = all.passed_m - search_m + value_m;
  for (std::size_t first = 0; first < all.count; first += kPortion) {
    measure(finder, kernels, pose, value_m,
            {all.group + first, std::min(kPortion, all.count - first), all.nearest_m + first, all.is_new,
             passed_m});
    for (std::size_t i = 0; i < count_; ++i)
      if (distance_m(i) < value_m) return true;
  }
  groups_.on_measured();
  return false;
}

void NearPoints::measure(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                         double reach_m, const GroupsInReach& groups) {
  std::size_t outside_count = 0;
  count_ = kernels.tool.points_in_field(
      finder.cloud().packed().columns(), groups.group, groups.count, posed_field(finder.tool(), pose),
      {reach_m, groups.passed_m}, groups.nearest_m, groups.is_new,
      {{points_[kX], points_[kY], points_[kZ]}, points_[kDistance], points_[kNumber]}, outside_count);
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
