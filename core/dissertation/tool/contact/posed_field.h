// The field of a tool at a pose, for kernels, and bounds of its change between poses.
#pragma once

#include <algorithm>
#include <limits>

#include "core/dissertation/tool/contact/touch_finder.h"

namespace remote_touch {

inline constexpr double kMaxSearch_m = kFieldMargin_m - 1e-4;  // the search has no larger reach

// The tool has to outlive it.
PosedField posed_field(const VoxelTool& tool, const ToolPose& pose);

// Returns an upper bound of the change of the field, between two poses, at a point that is fixed in the world
// and in the grid: the slope of the field times the path of the point through the grid.
double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to);

// Returns the distance up to which points are searched: reach_m plus spare_m, but no more than kMaxSearch_m
// unless reach_m is.
inline double searched_m(double reach_m, double spare_m) {
  return std::max(reach_m, std::min(reach_m + spare_m, kMaxSearch_m));
}

// Returns the field value above which a point cannot have come within reach_m while the field changed by
// change_m. Returns infinity if the search did not reach so far.
inline double passed_m(double reach_m, double change_m) {
  const double passed = reach_m + change_m;
  return passed < kMaxSearch_m ? passed : std::numeric_limits<double>::infinity();
}

}  // namespace remote_touch
