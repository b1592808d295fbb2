// Counts the points of a cloud that the tool touches at a pose. Every point is counted by itself.
//
// Groups of points are kept from one pose to the next (kept_groups.h). The voxel in which a point lies, or
// its distance, classifies most points. Only for the others, the nearest position on the disk is searched.
#pragma once

#include <limits>
#include <span>

#include "core/dissertation/tool/contact/column_block.h"
#include "core/dissertation/tool/contact/kept_groups.h"
#include "core/dissertation/tool/contact/touch_finder.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

struct Touched {
  ContactState state = ContactState::free;  // entrenched: some points are in interior voxels
  int points = 0;
  int clusters = 0;               // number of 10 mm cells of the tool frame with touched points
  double nearest_distance_m = 0;  // smallest field value of a point; infinite beyond the reach
};

class TouchedPoints {
 public:
  static constexpr double kTouch_m = 1e-4;  // a disk closer to the tool than this is touched

  // Counts points in voxels. If with_disks is true, points whose disk touches the tool count too.
  TouchedPoints(double disk_radius_ratio, bool with_disks)
      : disk_radius_ratio_(disk_radius_ratio), touch_m_(with_disks ? kTouch_m : kNever_m) {
    points_.grow(kPortion), disks_.grow(kPortion + kLanes), contacts_.grow(kPortion);
  }

  void on_frame() { groups_.on_frame(); }  // call it for each new cloud of the finder
  void reserve(std::size_t padded_size);   // reserves memory for clouds of this size
  // Counts the touched points among those whose field value is reach_m or less. A point is touched if it lies
  // in a shell or interior voxel and its field value is voxels_m or less, or if its disk touches the tool.
  // pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  Touched query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
                double voxels_m);

 private:
  static constexpr double kNever_m = -std::numeric_limits<double>::infinity();

  void add_unclear(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                   const TouchLimits& limits, Touched& all);
  void search_disks(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                    std::span<const std::uint32_t> numbers);
  void add_single(std::uint32_t number, const TouchFinder& finder, const ToolPose& pose,
                  const TouchLimits& limits, Touched& all);
  void add_touched(const Vec3& p_T, ContactState state, Touched& all);

  const double disk_radius_ratio_, touch_m_;
  KeptGroups groups_;
  Buffer<std::uint32_t> unclear_;
  // The disks of some unclear points, and the distances of their nearest positions; NaN: not known.
  static constexpr std::size_t kPortion = 256;
  ColumnBlock<8> points_;
  ColumnBlock<16> disks_;
  Buffer<ContactNumbers> contacts_;
  Vec3 disk_p_T(std::size_t i) const { return {disks_[0][i], disks_[1][i], disks_[2][i]}; }
  Buffer<std::uint64_t> clusters_;
  std::size_t cluster_count_ = 0, unclear_count_ = 0;
};

}  // namespace remote_touch
