// Counts the points of a cloud that a pose touches, each point by itself.
//
// Groups of points are kept from one pose to the next (kept_groups.h). Most points are classified by the
// voxel that they lie in, or by their distance. The nearest position on a disk is searched only if these do
// not decide.
#pragma once

#include <limits>

#include "core/dissertation/tool/contact/kept_groups.h"
#include "core/dissertation/tool/contact/touch_finder.h"
#include "core/rendering/renderer.h"

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

  // Points with a touched disk count too if with_disks is true, not only points in voxels.
  TouchedPoints(double disk_radius_ratio, bool with_disks)
      : disk_radius_ratio_(disk_radius_ratio), touch_m_(with_disks ? kTouch_m : kNever_m) {}

  void on_frame() { groups_.on_frame(); }  // the finder has a new cloud, whose size is reserved
  void reserve(std::size_t padded_size);   // reserves memory for clouds of this size
  // Counts the touched points among those whose field value is reach_m or less: points in shell and interior
  // voxels, if they are within voxels_m, and points whose disks are touched. pre: reach_m <= kFieldMargin_m -
  // 2e-4.
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
