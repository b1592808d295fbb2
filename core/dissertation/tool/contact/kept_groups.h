// Keeps the groups of points that are near a tool, so that not every pose needs a new search.
//
// If the cloud has a packed() one, the groups are those of that one.
//
// A search also finds groups that lie a little beyond the reach. All of them are kept, and are only measured
// again, as long as the tool has moved so little that no other point can have come within reach. A kept group
// is skipped if it was so far away at the search that none of its points can have come within reach.
#pragma once

#include <cstdint>

#include "core/dissertation/tool/contact/posed_field.h"
#include "core/dissertation/tool/contact/touch_finder.h"
#include "core/search/gathered_points.h"

namespace remote_touch {

// The groups that a kernel has to measure. A group whose nearest_m is above passed_m has no point within
// reach. If is_new is true, the kernel writes the nearest_m of all others.
struct GroupsInReach {
  const std::uint32_t* group;
  std::size_t count;
  double* nearest_m;  // least field value of the points of each group, or a lower bound of it
  bool is_new;
  double passed_m;
};

class KeptGroups {
 public:
  static constexpr double kSpare_m = 4e-4;  // distance beyond the reach that is searched too

  void on_frame() { searched_m_ = -1; }   // call it for each new cloud of the finder
  void reserve(std::size_t padded_size);  // reserves memory for clouds of this size
  // Returns groups that contain all points whose field value is reach_m or less, in order. Valid until the
  // next call. pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  GroupsInReach within(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void on_measured();  // call it after the kernel, if it measured all groups

 private:
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void drop_far_groups();

  Buffer<std::uint32_t> groups_;
  Buffer<double> nearest_m_;  // least field value of each group at searched_at_, or a lower bound
  std::size_t count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // not all groups were measured since the search
};

}  // namespace remote_touch
