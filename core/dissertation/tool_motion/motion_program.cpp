#include "core/dissertation/tool_motion/motion_program.h"

#include <Eigen/Eigenvalues>

namespace remote_touch {

namespace {

// The slack s of all rows is kSlackScale z and costs z^2 / 2 + kSlackCost z. Per metre that is far more than
// any contact can gain, because a desired motion is metres long at most. So the slack stays zero if the rows
// are feasible.
constexpr double kSlackScale = 0.01, kSlackCost = 0.1;

}  // namespace

MotionProgram::MotionProgram(const ToolParameters& parameters, const VoxelTool& tool)
    : MotionProgram(parameters.motion_metric == MotionMetric::tool
                        ? tool.inertia_m2
                        : even_inertia_m2(parameters.gyration_radius_m)) {}

MotionProgram::MotionProgram(const Eigen::Matrix3d& inertia_m2)
    : rigid_(kMaxContacts), elastic_(kMaxContacts + 1) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia_m2);
  root_ = axes.operatorSqrt();
  inverse_root_ = axes.operatorInverseSqrt();
}

Vector6 MotionProgram::row_of(const ToolContact& contact) const {
  Row row;
  row << contact.n_T, inverse_root_ * contact.r_T.cross(contact.n_T);  // (6.3), a row of J M^(-1/2)
  return row;
}

// Adds all rows at once, with the same operations as row_of() in the same order, so that the bits are the
// same. If that fails, adds the rows one by one and leaves out those that the program rejects.
void MotionProgram::add_rows(std::span<const ToolContact> contacts) {
  rigid_.clear();
  const std::size_t count = contacts.size();
  if (count <= static_cast<std::size_t>(kMaxContacts)) {
    double inverse_root[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) inverse_root[i][k] = inverse_root_(i, k);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &r = contacts[i].r_T, &n = contacts[i].n_T;
      const double x = r.y() * n.z() - r.z() * n.y(), y = r.z() * n.x() - r.x() * n.z(),
                   z = r.x() * n.y() - r.y() * n.x();
      for (int k = 0; k < 3; ++k) {
        column_[k][i] = n[k];
        column_[3 + k][i] = inverse_root[k][0] * x + (inverse_root[k][1] * y + inverse_root[k][2] * z);
      }
      depth_m_[i] = contacts[i].depth_m;
      number_[i] = static_cast<int>(i);
    }
    if (rigid_.add_all({column_[0], column_[1], column_[2], column_[3], column_[4], column_[5]}, depth_m_,
                       static_cast<int>(count)))
      return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int row = rigid_.size();
    if (rigid_.add(row_of(contacts[i]), contacts[i].depth_m)) number_[row] = static_cast<int>(i);
  }
}

ConstrainedMotion MotionProgram::read(const Vector6& y, int active_count, const int* active,
                                      const double* multiplier, std::span<const ToolContact> contacts) const {
  ConstrainedMotion motion;
  motion.a_g << y.head<3>(), inverse_root_ * y.tail<3>();  // back from M^(1/2) a_g
  for (int i = 0; i < active_count; ++i) {
    if (!(multiplier[i] > 0)) continue;
    const ToolContact& contact = contacts[static_cast<std::size_t>(number_[active[i]])];
    ++motion.active_count;
    motion.push_T += multiplier[i] * contact.n_T;
    motion.side += multiplier[i] * contact.side;
  }
  return motion;
}

ConstrainedMotion MotionProgram::solve(const Vector6& desired_T, std::span<const ToolContact> contacts) {
  Vector6 target;
  target << desired_T.head<3>(), root_ * desired_T.tail<3>();  // M^(1/2) a_gu, so that (6.4) is a distance
  add_rows(contacts);                                          // (6.5): J a_g >= d
  const ProgramResult<6> result = rigid_.nearest(target);      // (6.4); (6.7) if a_gu = 0, (6.6)
  if (result.status == ProgramStatus::optimal)
    return read(result.y, result.active_count, result.active, result.multiplier, contacts);

  using Vector7 = Eigen::Matrix<double, 7, 1>;
  elastic_.clear();
  Vector7 row7, target7;
  for (int row = 0; row < rigid_.size(); ++row) {
    const ToolContact& contact = contacts[static_cast<std::size_t>(number_[row])];
    row7 << row_of(contact), kSlackScale;
    elastic_.add(row7, contact.depth_m);
  }
  row7 << Vector6::Zero(), 1;
  elastic_.add(row7, 0);  // the slack is never negative
  target7 << target, -kSlackCost;
  ProgramResult<7> loosened = elastic_.nearest(target7);
  int kept = 0;  // number of active rows, not counting the row of the slack
  for (int i = 0; i < loosened.active_count; ++i) {
    if (loosened.active[i] == rigid_.size()) continue;
    loosened.active[kept] = loosened.active[i], loosened.multiplier[kept++] = loosened.multiplier[i];
  }
  ConstrainedMotion motion = read(loosened.y.head<6>(), kept, loosened.active, loosened.multiplier, contacts);
  motion.is_relaxed = true;
  const bool has_motion = loosened.status == ProgramStatus::optimal && motion.a_g.allFinite();
  if (!has_motion) motion.a_g.setZero();
  motion.failed = !has_motion || result.status == ProgramStatus::stalled;
  return motion;
}

}  // namespace remote_touch
