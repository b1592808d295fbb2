// Gauss' least constraints for the tool, 6.2.3: the motion nearest to a wanted one, in kinetic distance, that
// the contacts allow. In tool axes, where the inertia does not change.
#pragma once

#include <span>

#include "core/solve/quadratic_program.h"
#include "core/tool/dynamics/tool_pose.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

// A linear constraint (6.3): n.a + (r x n).alpha >= depth.
struct ToolContact {
  Vec3 r_T;        // from the centre of mass to the place of contact
  Vec3 n_T;        // unit, the way out: where the tool may move freely
  double depth_m;  // d: positive inside the tool, negative before it is touched
  double side;     // +1 where n is the normal of the cloud, -1 where it is opposed to it, 0 without a normal
};

struct ConstrainedMotion {
  Vector6 a_g = Vector6::Zero();  // tool axes
  int active_count = 0;           // contacts that push
  Vec3 push_T = Vec3::Zero();     // sum of their multipliers times normals
  double side = 0;                // sum of their multipliers times sides
  bool elastic = false;           // the constraints contradict each other: they were loosened, all alike
};

class MotionProgram {
 public:
  static constexpr int kMaxContacts = 256;

  explicit MotionProgram(const VoxelTool& tool);

  // (6.4), (6.5) for a wanted motion in tool axes; (6.7), (6.8) is the same with a wish of zero and depths of
  // 1. Where a wedge makes (6.5) infeasible, the wish stays and one slack loosens every row. Contacts beyond
  // kMaxContacts are ignored. Does not allocate.
  ConstrainedMotion solve(const Vector6& desired_T, std::span<const ToolContact> contacts);

 private:
  using Row = Vector6;
  Row row_of(const ToolContact& contact) const;
  ConstrainedMotion read(const Vector6& y, int active_count, const int* active, const double* multiplier,
                         std::span<const ToolContact> contacts) const;

  Eigen::Matrix3d root_, inverse_root_;  // of the inertia for 1 kg, so M^(1/2) of (6.4)
  QuadraticProgram<6> rigid_;
  QuadraticProgram<7> elastic_;
  int number_[kMaxContacts] = {};  // of the contact behind each row
};

}  // namespace remote_touch
