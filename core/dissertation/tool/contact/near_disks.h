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

#include "core/dissertation/tool/contact/column_block.h"
#include "core/dissertation/tool/contact/disk_contact.h"
#include "core/dissertation/tool/contact/touch_finder.h"

namespace remote_touch {

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
