// What a pose touches of a cloud, every point counted.
//
// Groups of points are kept from one pose to the next (kept_groups.h). Most points are told by the voxel that
// they lie in, or by how far away they are; the nearest place of a disk is searched where nothing else tells.
#pragma once

#include <limits>

#include "core/rendering/renderer.h"
#include "core/tool/contact/kept_groups.h"
#include "core/tool/contact/touch_finder.h"

namespace remote_touch {

struct Touched {
  ContactState state = ContactState::free;  // entrenched: some points are in interior voxels
  int points = 0;
  int clusters = 0;               // 10 mm cells of the tool frame with such points
  double nearest_distance_m = 0;  // smallest field value of a point; infinite beyond the reach
};

class TouchedPoints {
 public:
  static constexpr double kTouch_m = 1e-4;  // a disk closer to the tool than this is touched

  // with_disks: the disks of points are touched as well, not only points in voxels.
  TouchedPoints(double disk_radius_ratio, bool with_disks)
      : disk_radius_ratio_(disk_radius_ratio), touch_m_(with_disks ? kTouch_m : kNever_m) {}

  void on_frame() { groups_.on_frame(); }  // a new cloud of the finder, whose size is reserved
  void reserve(std::size_t padded_size);   // for clouds of that size
  // Of the points whose field value is reach_m or less: those in shell and interior voxels, if they are
  // within voxels_m, and those whose disks are touched. pre: reach_m <= kFieldMargin_m - 2e-4.
  Touched query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
                double voxels_m);

 private:
  static constexpr double kNever_m = -std::numeric_limits<double>::infinity();

  void add_unclear(const TouchFinder& finder, const ToolPose& pose, const TouchLimits& limits, Touched& all);

  const double disk_radius_ratio_, touch_m_;
  KeptGroups groups_;
  Buffer<std::uint32_t> unclear_;
  Buffer<std::uint64_t> clusters_;
  std::size_t cluster_count_ = 0, unclear_count_ = 0;
};

}  // namespace remote_touch
