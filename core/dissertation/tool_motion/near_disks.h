// Computes the points near a tool as disks in the tool's field.
//
// A search also finds points that lie a little beyond the reach. All of them are kept, and are only measured
// again, as long as the tool has moved so little that no other point can have come within reach. A kept group
// of points is skipped if it was so far away at the search that none of its points can have come within
// reach.
#pragma once

#include <bit>
#include <limits>
#include <span>
#include <vector>

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch {

// The look-ahead rule treats a point of a cloud as a small disk in the plane of its normal, so that corners
// of the tool do not sink between the points of a surface. Not in the dissertation.

// The disk of a point in the tool frame. A point without a normal (NaN) has no disk and is used as a point.
struct SurfaceDisk {
  Vec3 p_T, n_T;
  double radius_m;
  FieldSample at;       // the field at its centre
  double extent_m = 0;  // extent of the points that it represents, contact_thinning.h; 0: one point

  bool has_normal() const { return n_T.allFinite(); }
};

// True if a field of this slope in the plane of a disk counts as flat. No position on the disk is searched
// then.
inline bool is_flat(double slope, double radius_m, double extent_m) {
  return slope < disk_search::kFlatSlope && (extent_m == 0 || slope * radius_m < disk_search::kFlatDepth_m);
}

// Returns a lower bound of the distance from the disk to the tool, if the field is nowhere steeper than at
// the centre.
double lower_bound_m(const SurfaceDisk& disk);

struct DiskPosition {
  Vec3 p_T;
  FieldSample at;
  bool at_rim = false;
};

// Returns the position on the disk that is nearest to the tool, or deepest in it.
DiskPosition nearest_position(const VoxelTool& tool, const SurfaceDisk& disk);

// Returns the constraint of a disk at its nearest position; its distance is the field there. If that position
// lies within the disk, n is the disk's normal, on the side that the field gives. n comes from the tool's
// surface if the position is at the rim, if the disk meets the tool edge-on, or for a point; but if the tool
// is flush with the disk, n is the disk's normal again. known_side is +1 or -1 of the normal; 0: not known.
// If the position is inside the tool, known_side overrides the field and the rim, because a frame can put
// points anywhere in the tool, and the field does not show from which side they came.
ToolContact near_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPosition& nearest,
                         double known_side);
// Returns the constraint of a disk that is too far from the tool to be worth a search: at its centre, with
// its lower bound as distance.
ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m);

// The result is kept: another query for the same pose costs nothing.
class NearDisks {
 public:
  // Distance beyond the reach that is searched too.
  static constexpr double kSpare_m = 4e-4;
  static constexpr double kSearch_m = 3e-4;  // a search for the nearest position is made on closer disks only

  NearDisks(double disk_radius_ratio, double cell_m)
      : disk_radius_ratio_(disk_radius_ratio), cells_per_m_(1 / cell_m) {}

  // Sets the cloud: the finder's cloud, or fewer points that represent it. It has to outlive the queries.
  // Allocates unless reserve() was called for its size.
  void on_frame(const TiledCloud& cloud);
  void reserve(std::size_t padded_size);  // reserves memory for clouds of this size
  // Finds the disks whose centres are within reach_m and whose lower bounds are max_lower_m or less, in the
  // order of the cloud's tiles; no disks if there is no cloud. pre: reach_m <= kFieldMargin_m - 2e-4.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
             double max_lower_m = std::numeric_limits<double>::infinity());

  std::size_t size() const { return count_; }
  double lower_m(std::size_t i) const { return disks_[kLower][i]; }  // lower_bound_m()
  // Returns a lower bound of the distance from the disk to a convex tool. It is distance_m() if no search is
  // needed: lower_m() is kSearch_m or less, and the disk is flat in the field. Otherwise it is lower_m().
  double bound_m(std::size_t i) const { return disks_[kBound][i]; }
  double distance_m(std::size_t i) const { return disks_[kDistance][i]; }
  Vec3 p_T(std::size_t i) const { return three(kPlace, i); }
  // Returns cell_and_octant() of the disk's centre and of the direction against the gradient, in which a
  // contact there would push.
  std::uint64_t cell(std::size_t i) const { return std::bit_cast<std::uint64_t>(disks_[kCell][i]); }
  // Appends the contacts of the disks with these numbers: far_contact() if the lower bound is more than
  // kSearch_m, else near_contact() at the nearest position.
  void append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                       const Kernels& kernels, double side, std::vector<ToolContact>& contacts);
  SurfaceDisk disk(std::size_t i) const {
    return {p_T(i),
            three(kNormal, i),
            disks_[kRadius][i],
            {distance_m(i), three(kGradient, i)},
            disks_[kExtent][i]};
  }
  // Returns the number of points that the last search found; not all of them become disks.
  std::size_t kept_points() const { return point_count_; }

 private:
  enum PointColumn { kX, kY, kZ, kNx, kNy, kNz, kSpacing, kPointExtent, kPointColumns };
  enum DiskColumn {
    kPlace = 0,
    kNormal = 3,
    kGradient = 6,
    kRadius = 9,
    kExtent,
    kDistance,
    kSlope,
    kLower,
    kBound,
    kCell,
    kDiskColumns
  };
  Vec3 three(std::size_t first, std::size_t i) const {
    return {disks_[first][i], disks_[first + 1][i], disks_[first + 2][i]};
  }
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  DiskColumns columns() const;
  void finish_outside(const VoxelTool& tool, const DiskLimits& limits);
  void copy(std::size_t from, std::size_t to);

  const double disk_radius_ratio_, cells_per_m_;
  const TiledCloud* cloud_ = nullptr;
  // The kept points, and the pose and the reach of their search.
  ColumnBlock<kPointColumns> points_;
  Buffer<double> nearest_;  // least field value of each group of kLanes points at searched_at_
  std::size_t point_count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // the points were not measured since the search

  PosedField field_{};
  ColumnBlock<kDiskColumns> disks_;
  std::size_t count_ = 0;
  Buffer<ContactNumbers> contacts_;
  bool is_known_ = false;  // the columns are valid for the pose and limits below
  ToolPose pose_;
  double reach_m_ = 0, max_lower_m_ = 0;
};

}  // namespace remote_touch
