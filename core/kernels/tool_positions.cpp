// Detection of the points near a tool, 6.2.2, and the trilinear distance field at them. The operations are
// those of voxel_tool.cpp, in the same order.
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

std::size_t points_in_field(const PointColumns& points, const std::uint32_t* groups, std::size_t group_count,
                            const PosedField& f, const PointLimits& limits, GroupDistances distances,
                            const PositionColumns& out, std::size_t& outside_count) {
  std::size_t found = 0;
  outside_count = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    if (distances.nearest[g] > limits.passed) continue;
    Doubles min = broadcast(1e300);
    const std::size_t first = kLanes * std::size_t{groups[g]};
    for (std::size_t i = first; i < first + kLanes; i += kDoubles) {
      const PositionsInField positions = positions_at(points, i, f);
      const Doubles distance = positions.at.distance;
      min = distance < min ? distance : min;
      const Flags reached = distance <= limits.reach;
      if (!is_any(reached)) continue;
      const Packing packing(reached);
      packing.put(positions.p_T.x, out.p_T[0] + found), packing.put(positions.p_T.y, out.p_T[1] + found);
      packing.put(positions.p_T.z, out.p_T[2] + found);
      packing.put(positions.at.is_known ? distance : broadcast(__builtin_nan("")), out.distance + found);
      Doubles number;
      for (std::size_t lane = 0; lane < kDoubles; ++lane) number[lane] = static_cast<double>(i + lane);
      packing.put(number, out.number + found);
      found += packing.count();
      outside_count += Packing(reached & ~positions.at.is_known).count();
    }
    if (distances.is_new) distances.nearest[g] = least(min);
  }
  return found;
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
