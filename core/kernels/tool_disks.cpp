// Surface disks near a tool, 6.2.2: their positions, the trilinear distance field there, and a lower bound of
// the distance of any position on a disk. The operations are those of voxel_tool.cpp and near_disks.cpp, in
// the same order.
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// Returns 1 if x is positive, else 0. It is computed from the sign of -x.
inline Flags is_positive(Doubles x) {
  return (Flags)(0 - x) < 0 ? Flags{} + 1 : Flags{};
}

// Appends the lanes of `may` that are within the limits to the columns, from index `to` on. Returns their
// number.
inline std::size_t put_disks(const PositionsInField& positions, const DisksInField& disks, Flags may,
                             const DiskLimits& limits, double cells_per_m, const DiskColumns& out,
                             std::size_t to) {
  const Packing packing(may & ((disks.lower <= limits.lower) | ~positions.at.is_known));
  const std::size_t count = packing.count();
  if (count == 0) return 0;
  const Doubles3 &p = positions.p_T, &n = disks.n_T, &g = positions.at.gradient_T;
  const auto put_three = [&](const Doubles3& a, double* const(&columns)[3]) {
    packing.put(a.x, columns[0] + to), packing.put(a.y, columns[1] + to), packing.put(a.z, columns[2] + to);
  };
  put_three(p, out.p_T), put_three(n, out.n_T), put_three(g, out.gradient_T);
  const Doubles distance = positions.at.distance, lower = disks.lower;
  packing.put(disks.radius, out.radius + to);
  packing.put(disks.extent, out.extent + to);
  packing.put(distance, out.distance + to);
  packing.put(disks.slope, out.slope + to);
  packing.put(positions.at.is_known ? lower : broadcast(__builtin_nan("")), out.lower + to);
  const Flags is_exact = (lower <= limits.search) & is_flat(disks.slope, disks.radius, disks.extent);
  packing.put(is_exact ? distance : lower, out.bound + to);
  const Flags octant = is_positive(g.x) << 2 | is_positive(g.y) << 1 | is_positive(g.z);
  packing.put((Doubles)(cell_number(p, cells_per_m) << 3 | octant), out.cell + to);
  return count;
}

}  // namespace

std::size_t disks_in_field(const PointColumns& points, std::size_t count, DiskShape shape,
                           const PosedField& f, const DiskLimits& limits, GroupDistances groups,
                           const DiskColumns& out, std::size_t& outside_count) {
  std::size_t found = 0;
  outside_count = 0;
  for (std::size_t i = 0; i < count; i += kLanes) {
    double& of_group = groups.nearest[i / kLanes];
    if (!groups.is_new && of_group > limits.passed) continue;
    Doubles min = broadcast(1e300);
    for (std::size_t part = i; part < i + kLanes && part < count; part += kDoubles) {
      const PositionsInField positions = positions_at(points, part, f);
      const Flags is_point = lane_numbers() < static_cast<long>(count - part);
      const Flags outside = is_point & ~positions.at.is_known;
      min = positions.at.distance < min ? positions.at.distance : min;
      const Flags may = (is_point & (positions.at.distance <= limits.reach)) | outside;
      if (!is_any(may)) continue;
      found += put_disks(positions, disks_at(points, part, shape.fraction, f, positions.at), may, limits,
                         shape.cells_per_m, out, found);
      outside_count += Packing(outside).count();
    }
    if (groups.is_new) of_group = least(min);
  }
  return found;
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
