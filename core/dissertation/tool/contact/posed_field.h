// The field of a tool at a pose, for kernels, and bounds of its change between poses.
#pragma once

#include <algorithm>
#include <limits>

#include "core/dissertation/tool/contact/touch_finder.h"

namespace remote_touch {

inline constexpr double kMaxSearch_m = kFieldMargin_m - 1e-4;  // the field is searched no farther

// The tool has to outlive it.
PosedField posed_field(const VoxelTool& tool, const ToolPose& pose);

// Returns an upper bound of the change of the field, at a point of the world that is in the grid, between two
// poses: the slope of the field times the path of the point through it.
double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to);

// Returns the distance that is searched for a reach: the reach and some spare.
inline double searched_m(double reach_m, double spare_m) {
  return std::max(reach_m, std::min(reach_m + spare_m, kMaxSearch_m));
}

// Returns the distance beyond which a point cannot have come within reach_m while the field changed by
// change_m. Infinity if the search did not go so far.
inline double passed_m(double reach_m, double change_m) {
  const double passed = reach_m + change_m;
  return passed < kMaxSearch_m ? passed : std::numeric_limits<double>::infinity();
}

}  // namespace remote_touch
