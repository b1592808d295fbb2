#include "core/dissertation/tool/contact/posed_field.h"

namespace remote_touch {

PosedField posed_field(const VoxelTool& tool, const ToolPose& pose) {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  PosedField field;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) field.R_TW[axis][k] = R_TW(axis, k);
    field.p_W[axis] = pose.p_W[axis];
    field.origin_T[axis] = tool.grid.origin_T[axis];
    field.cells[axis] = tool.grid.cells[static_cast<std::size_t>(axis)];
  }
  field.node = tool.distance_m.data();
  field.size = tool.grid.size_m;
  return field;
}

double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to) {
  const double turn = 2 * (to.q_WT * from.q_WT.conjugate()).vec().norm();  // chord: 2 sin(angle / 2)
  return finder.max_slope() * ((to.p_W - from.p_W).norm() + turn * finder.grid_reach_m());
}

}  // namespace remote_touch
