// The points of a cloud that a tool touches, 6.2.2: points that lie in voxels, and points outside the voxels
// whose distance is small enough. Every touched point is counted. The operations are those of voxel_tool.cpp
// and near_disks.cpp, in the same order.
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

constexpr long kInterior = 2;  // the value of Voxel::interior

// Reads the voxels of cells, one by one.
inline Flags voxels_at(const CellTable& table, Counts cell) {
  Flags voxels;
  for (int lane = 0; lane < kDoubles; ++lane)
    voxels[lane] = static_cast<std::uint8_t>(table.value[cell[lane]]);  // 0 to 2
  return voxels;
}

// Returns the lanes whose disks may be as near as `touch`. The slope of the field in the plane of a normal n
// is at most the length of its gradient times the larger of 1 and |1 - n.n|.
inline Flags can_touch(const PointColumns& points, std::size_t i, double fraction, const TouchLimits& limits,
                       Doubles distance) {
  constexpr double kRounding = 1 + 1e-9;
  const Doubles3 n{load(points.nx + i), load(points.ny + i), load(points.nz + i)};
  const Doubles off = magnitude(1 - dot(n, n)), steep = off < 1 ? broadcast(1) : off;
  const Doubles radius = fraction * load(points.spacing + i) + load(points.extent + i);
  return ~(distance > limits.touch + kRounding * limits.slope * (steep * radius));  // true without a normal
}

class Summary {
 public:
  explicit Summary(TouchedSummary& out) : out_(out) {}

  // Counts the touched lanes and stores the numbers of their clusters.
  void add(Flags touched, Flags cluster) {
    const Packing all(touched);
    if (all.count() == 0) return;
    out_.point_count += all.count();
    const Packing others(touched & (cluster != last_cluster_));  // neighbours mostly follow each other
    if (others.count() == 0) return;
    others.put((Doubles)cluster, reinterpret_cast<double*>(out_.cluster + out_.clusters));
    out_.clusters += others.count();
    last_cluster_ = static_cast<long>(out_.cluster[out_.clusters - 1]);
  }
  void add_unclear(Flags unclear, std::size_t first) {
    if (!is_any(unclear)) return;
    for (std::size_t lane = 0; lane < kDoubles; ++lane)
      if (unclear[lane]) out_.unclear[out_.unclear_count++] = static_cast<std::uint32_t>(first + lane);
  }

 private:
  TouchedSummary& out_;
  long last_cluster_ = -1;
};

}  // namespace

void touched_points(const PointColumns& points, const std::uint32_t* groups, std::size_t group_count,
                    DiskShape shape, const PosedField& f, const CellTable& voxels, const TouchLimits& limits,
                    GroupDistances distances, TouchedSummary& out) {
  constexpr double kInfinite = __builtin_inf();
  out.point_count = out.clusters = out.unclear_count = 0;
  Summary summary(out);
  Doubles least_of_all = broadcast(kInfinite);
  Flags inside{};
  for (std::size_t g = 0; g < group_count; ++g) {
    if (distances.nearest[g] > limits.passed) continue;
    Doubles least_of_group = broadcast(kInfinite);
    for (std::size_t i = kLanes * std::size_t{groups[g]}; i < kLanes * (std::size_t{groups[g]} + 1);
         i += kDoubles) {
      const PositionsInField positions = positions_at(points, i, f);
      const Doubles distance = positions.at.distance;
      least_of_group = distance < least_of_group ? distance : least_of_group;
      const Flags reached = distance <= limits.reach;
      if (!is_any(reached)) continue;
      const Flags known = reached & positions.at.is_known;
      const Doubles counted = known ? distance : broadcast(kInfinite);
      least_of_all = counted < least_of_all ? counted : least_of_all;
      const Flags voxel = (known & positions.at.in_cell & (distance <= limits.voxels))
                              ? voxels_at(voxels, positions.at.cell)
                              : Flags{};
      inside |= voxel == kInterior;
      Flags touched = voxel != 0, unclear = reached & ~known;
      const Flags may = known & ~touched & can_touch(points, i, shape.fraction, limits, distance);
      if (is_any(may)) {
        const DisksInField disks = disks_at(points, i, shape.fraction, f, positions.at);
        const Flags near = may & (disks.lower <= limits.touch);
        touched |= near & (distance <= limits.touch);
        unclear |= near & ~(distance <= limits.touch) & ~is_flat(disks.slope, disks.radius, disks.extent);
      }
      summary.add(touched, cell_number(positions.p_T, shape.cells_per_m));
      summary.add_unclear(unclear, i);
    }
    if (distances.is_new) distances.nearest[g] = least(least_of_group);
  }
  out.nearest = least(least_of_all);
  out.is_inside = is_any(inside);
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
