// The field of a tool at a pose, for kernels, and how far it can change between poses.
#pragma once

#include <algorithm>
#include <limits>

#include "core/tool/contact/touch_finder.h"

namespace remote_touch {

inline constexpr double kMaxSearch_m = kFieldMargin_m - 1e-4;  // farther than this no field is searched

// The tool has to outlive it.
PosedField posed_field(const VoxelTool& tool, const ToolPose& pose);

// Upper bound of how much the field can have changed, at a point of the world that is in the grid, between
// two poses: its slope times the way of the point through it.
double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to);

// What is searched for a reach, with some to spare.
inline double searched_m(double reach_m, double spare_m) {
  return std::max(reach_m, std::min(reach_m + spare_m, kMaxSearch_m));
}

// No point can have come within reach_m that was farther away than this before the field changed so much.
inline double passed_m(double reach_m, double change_m) {
  const double passed = reach_m + change_m;
  return passed < kMaxSearch_m ? passed : std::numeric_limits<double>::infinity();
}

}  // namespace remote_touch
