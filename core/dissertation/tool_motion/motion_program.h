// Gauss' principle of least constraint for the tool, 6.2.3: the motion that the contacts allow and that is
// nearest to a desired one, in kinetic distance. It is computed in tool axes, where the inertia is constant.
//
// When the tool is at rest, M times the remaining displacement is a sum of contact normals. The wrench of the
// coupling (6.9) is also such a sum only if M has the gyration radius of the coupling,
// MotionMetric::coupling. Then the elastic energy is also the least that the contacts allow.
#pragma once

#include <span>

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/dissertation/tool_motion/quadratic_program.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_pose.h"

namespace remote_touch {

// A linear constraint (6.3): n.a + (r x n).alpha >= depth.
struct ToolContact {
  Vec3 r_T;        // vector from the centre of mass to the contact point
  Vec3 n_T;        // unit, out of the surface: the tool may move freely along +n
  double depth_m;  // d: positive if the point is inside the tool, negative while it is still outside
  double side;     // side of the surface that the tool is on: +1 the normal's, -1 the other, 0 not known
};

struct ConstrainedMotion {
  Vector6 a_g = Vector6::Zero();  // tool axes
  int active_count = 0;           // contacts that push: their multipliers are above 0
  Vec3 push_T = Vec3::Zero();     // sum of their multipliers times normals
  double side = 0;                // sum of their multipliers times sides
  bool is_relaxed = false;        // not all constraints could be met; all were relaxed by the same slack
  bool failed = false;            // a program stopped without a result: a_g may not be the nearest motion
};

// Returns the inertia of a body of 1 kg with the same gyration radius about every axis.
inline Eigen::Matrix3d even_inertia_m2(double gyration_radius_m) {
  return Eigen::Matrix3d::Identity() * gyration_radius_m * gyration_radius_m;
}

class MotionProgram {
 public:
  static constexpr int kMaxContacts = 256;

  // Uses the M that parameters.motion_metric selects.
  MotionProgram(const ToolParameters& parameters, const VoxelTool& tool);
  // inertia_m2: inertia of the body about its centre of mass, divided by its mass.
  explicit MotionProgram(const Eigen::Matrix3d& inertia_m2);

  // Solves (6.4), (6.5) for a desired motion in tool axes. (6.7), (6.8) is the same with a desired motion of
  // zero and depths of 1. If a wedge makes (6.5) infeasible, one slack variable relaxes every row, and the
  // objective is still the desired motion. The same is done if (6.5) stalls, which is reported as failed. If
  // the relaxed program fails too, the motion is zero and failed. Contacts beyond kMaxContacts are ignored.
  // Does not allocate.
  ConstrainedMotion solve(const Vector6& desired_T, std::span<const ToolContact> contacts);

 private:
  using Row = Vector6;
  void add_rows(std::span<const ToolContact> contacts);
  Row row_of(const ToolContact& contact) const;
  ConstrainedMotion read(const Vector6& y, int active_count, const int* active, const double* multiplier,
                         std::span<const ToolContact> contacts) const;

  Eigen::Matrix3d root_, inverse_root_;  // roots of the inertia for 1 kg: M^(1/2) of (6.4) and its inverse
  QuadraticProgram<6> rigid_;
  QuadraticProgram<7> elastic_;
  int number_[kMaxContacts] = {};  // index of the contact of each row
  double column_[6][kMaxContacts] = {}, depth_m_[kMaxContacts] = {};
};

}  // namespace remote_touch
