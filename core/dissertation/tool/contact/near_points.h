// Finds the points near a tool as single points: none is merged, and none is a disk.
#pragma once

#include "core/dissertation/tool/contact/column_block.h"
#include "core/dissertation/tool/contact/kept_groups.h"
#include "core/dissertation/tool/contact/touch_finder.h"

namespace remote_touch {

class NearPoints {
 public:
  void on_frame() { groups_.on_frame(), count_ = 0; }  // call it for each new cloud
  void reserve(std::size_t padded_size);               // reserves memory for clouds of this size
  // Finds the points of the finder's cloud whose field value is reach_m or less, in the order of the packed()
  // cloud's tiles. pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m);
  // Does the same, but leaves out some of the points that are certain to keep way.touch during the motion,
  // and some of those with a normal away from way.ahead_W. pre: way.far is reach_m.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, const SlabWay& way);

  // Returns true if the field value of a point is below value_m. The search covers points up to search_m, so
  // that the next query does not need one. The points of the last query are lost. pre: value_m <= search_m,
  // and as above.
  bool has_below(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double value_m,
                 double search_m);

  std::size_t size() const { return count_; }
  Vec3 p_T(std::size_t i) const { return {points_[kX][i], points_[kY][i], points_[kZ][i]}; }
  double distance_m(std::size_t i) const { return points_[kDistance][i]; }  // the field there
  // Index of the point in the packed() cloud of the finder's.
  std::uint32_t number(std::size_t i) const { return static_cast<std::uint32_t>(points_[kNumber][i]); }

 private:
  enum Column { kX, kY, kZ, kDistance, kNumber, kColumns };
  void measure(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
               const GroupsInReach& groups);
  void finish_outside(const VoxelTool& tool, double reach_m);

  KeptGroups groups_;
  struct OnWay {
    Buffer<std::uint32_t> index, group;
    Buffer<double> nearest_m;
  };
  OnWay on_way_;
  ColumnBlock<kColumns> points_;
  std::size_t count_ = 0;
};

}  // namespace remote_touch
