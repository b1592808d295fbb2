// The points near a tool as disks in its field.
//
// The points are kept from one pose to the next: a few more are searched than lie within reach, and while the
// tool has moved so little that no other point can have come within reach, these are measured again; but not
// those of groups that have been so far away that none of them can have come within reach either.
#pragma once

#include <bit>
#include <limits>
#include <span>
#include <vector>

#include "core/tool/contact/column_block.h"
#include "core/tool/contact/disk_contact.h"
#include "core/tool/contact/touch_finder.h"

namespace remote_touch {

// Keeps the result: a query for the same pose again costs nothing.
class NearDisks {
 public:
  // What is searched beyond the reach.
  static constexpr double kSpare_m = 4e-4;
  static constexpr double kSearch_m = 3e-4;  // a disk closer than this has its nearest place searched

  NearDisks(double disk_radius_ratio, double cell_m)
      : disk_radius_ratio_(disk_radius_ratio), cells_per_m_(1 / cell_m) {}

  // Allocates unless reserved. The cloud has to outlive the queries; it is the finder's, or fewer points.
  void on_frame(const TiledCloud& cloud);
  void reserve(std::size_t padded_size);  // for clouds of that size
  // The disks whose centres are within reach_m and whose lower bounds are max_lower_m or less, none without a
  // cloud; in the order of the cloud's tiles. pre: reach_m <= kFieldMargin_m - 2e-4.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
             double max_lower_m = std::numeric_limits<double>::infinity());

  std::size_t size() const { return count_; }
  double lower_m(std::size_t i) const { return disks_[kLower][i]; }  // lower_bound_m()
  // No place of the disk is nearer than this to a convex tool; where nothing is left to search, none as near.
  double bound_m(std::size_t i) const { return disks_[kBound][i]; }
  double distance_m(std::size_t i) const { return disks_[kDistance][i]; }
  Vec3 p_T(std::size_t i) const { return three(kPlace, i); }
  // cell_and_octant() of its centre and the direction against the gradient, in which a contact there would
  // push.
  std::uint64_t cell(std::size_t i) const { return std::bit_cast<std::uint64_t>(disks_[kCell][i]); }
  // Appends the contacts of the disks with these numbers: of those whose lower bound is more than kSearch_m
  // far_contact(), of others near_contact() at their nearest place.
  void append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                       const Kernels& kernels, double side, std::vector<ToolContact>& contacts);
  SurfaceDisk disk(std::size_t i) const {
    return {p_T(i),
            three(kNormal, i),
            disks_[kRadius][i],
            {distance_m(i), three(kGradient, i)},
            disks_[kExtent][i]};
  }
  // How many points are kept: more than the disks that they make.
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
  // The points kept, and where and how far they were searched.
  ColumnBlock<kPointColumns> points_;
  Buffer<double> nearest_;  // of each group of kLanes points, the least distance there
  std::size_t point_count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // nothing was measured since

  PosedField field_{};
  ColumnBlock<kDiskColumns> disks_;
  std::size_t count_ = 0;
  Buffer<ContactNumbers> contacts_;
  bool is_known_ = false;  // the columns are valid for:
  ToolPose pose_;
  double reach_m_ = 0, max_lower_m_ = 0;
};

}  // namespace remote_touch
