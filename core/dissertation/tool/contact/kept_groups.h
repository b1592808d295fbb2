// The groups of points that a tool can have within reach, for one pose after the other.
//
// A search finds a few more groups than lie within reach. They are kept, and only measured again while the
// tool has moved so little that no other point can have come within reach. A kept group is skipped if it has
// been so far away that none of its points can have come within reach either.
#pragma once

#include <cstdint>

#include "core/dissertation/tool/contact/posed_field.h"
#include "core/dissertation/tool/contact/touch_finder.h"
#include "core/search/gathered_points.h"

namespace remote_touch {

// The groups for a kernel to measure. It writes nearest_m if is_new is true, else it reads nearest_m: groups
// whose value is more than passed_m have no point within reach.
struct GroupsInReach {
  const std::uint32_t* group;
  std::size_t count;
  double* nearest_m;  // least field value of the points of each group
  bool is_new;
  double passed_m;
};

class KeptGroups {
 public:
  static constexpr double kSpare_m = 4e-4;  // distance beyond the reach that is searched too

  void on_frame() { searched_m_ = -1; }   // the finder has a new cloud, whose size is reserved
  void reserve(std::size_t padded_size);  // reserves memory for clouds of this size
  // Returns the groups that hold all points whose field value is reach_m or less, in order. Valid until the
  // next call. pre: reach_m <= kFieldMargin_m - 2e-4.
  GroupsInReach within(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void on_measured();  // call it after the kernel

 private:
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void drop_far_groups();

  Buffer<std::uint32_t> groups_;
  Buffer<double> nearest_m_;  // least field value of each group at searched_at_
  std::size_t count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // the groups were not measured since the search
};

}  // namespace remote_touch
