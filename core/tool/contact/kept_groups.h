// The groups of points that a tool can have within reach, for one pose after the other.
//
// They are kept: a few more are searched than lie within reach, and while the tool has moved so little that
// no other point can have come within reach, these are measured again; but not those that have been so far
// away that none of their points can have come within reach either.
#pragma once

#include <cstdint>

#include "core/search/gathered_points.h"
#include "core/tool/contact/posed_field.h"
#include "core/tool/contact/touch_finder.h"

namespace remote_touch {

// What a kernel measures. It writes nearest_m if is_new, else it reads it: groups whose nearest is more than
// passed_m have no point within reach.
struct GroupsInReach {
  const std::uint32_t* group;
  std::size_t count;
  double* nearest_m;  // of each, the least field value of its points
  bool is_new;
  double passed_m;
};

class KeptGroups {
 public:
  static constexpr double kSpare_m = 4e-4;  // what is searched beyond the reach

  void on_frame() { searched_m_ = -1; }   // a new cloud of the finder, whose size is reserved
  void reserve(std::size_t padded_size);  // for clouds of that size
  // Those that hold all points whose field value is reach_m or less, in order. Valid until the next call.
  // pre: reach_m <= kFieldMargin_m - 2e-4.
  GroupsInReach within(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void on_measured();  // after the kernel

 private:
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void drop_far_groups();

  Buffer<std::uint32_t> groups_;
  Buffer<double> nearest_m_;  // of each group, where they were searched
  std::size_t count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // nothing was measured since the search
};

}  // namespace remote_touch
