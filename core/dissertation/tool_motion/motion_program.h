// The constrained motion of the tool, 6.2.3, as a quadratic program, and the solver of such programs.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/mesh/voxel_tool.h"

namespace remote_touch {

enum class ProgramStatus {
  optimal = 0,
  infeasible = 1,  // no point fulfils all rows
  stalled = 2      // the step limit was reached, and y violates rows; or the target or y is not finite
};

template <int N>
struct ProgramResult {
  ProgramStatus status = ProgramStatus::optimal;
  Eigen::Matrix<double, N, 1> y = Eigen::Matrix<double, N, 1>::Zero();
  int active_count = 0;       // number of active rows, at most N; they are linearly independent
  int active[N] = {};         // their indices, from 0 in the order of add()
  double multiplier[N] = {};  // 0 or more for each active row: y - target = sum of multiplier x row
  int iterations = 0;         // passes over all rows
};

// Minimises |y - target|^2 / 2 subject to row . y >= bound for every row.
//
// The length of a row does not matter. If the status is optimal, (bound - row . y) / |row| is below 1e-13
// times the largest coordinate of target and y, apart from the rounding of y itself. It may be up to 5e-13
// times that coordinate if rows contradict each other by no more than this. The distance of y from the active
// rows is below 1e-13 times that coordinate. Rows that differ by less than 1e-8 from a combination of active
// rows count as that combination.
template <int N>
class QuadraticProgram {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit QuadraticProgram(int capacity);

  void clear();
  int size() const { return count_; }
  int capacity() const { return capacity_; }
  // Returns false and does not add the row if it or its bound is not finite, or if capacity() is reached. A
  // row of zeros is accepted: it has no effect if its bound is 0 or less, and makes the program infeasible if
  // its bound is positive.
  bool add(const Vector& row, double bound);
  // The same for `count` rows at once, with the same bits: coordinate k of row i is column[k][i]. Returns
  // false and adds no row if one of them is zero, not finite, too large or too small, if size() is odd, or if
  // capacity() is not enough. pre: the columns and bounds are readable up to the next even number of rows.
  bool add_all(const double* const (&column)[N], const double* bounds, int count);
  // Returns stalled and y = 0 for a target that is not finite or has a coordinate above 1e150. If the status
  // is infeasible, y is the position at which the method found the contradiction, and the active rows are
  // those at that position.
  ProgramResult<N> nearest(const Vector& target) const;

 private:
  struct Violation {
    double distance;  // distance to the row's half space
    int row;
  };
  Violation max_violation(const double* y) const;

  int capacity_, stride_, count_ = 0;
  std::vector<double> rows_;    // unit rows, stored column by column; stride_ is the padded capacity
  std::vector<double> bounds_;  // divided by the row's length; minus infinity after the last
  std::vector<double> lengths_;
};

extern template class QuadraticProgram<6>;
extern template class QuadraticProgram<7>;

// Gauss' principle of least constraint for the tool, 6.2.3: the motion that the contacts allow and that is
// nearest to a desired one, in kinetic distance. It is computed in tool axes, where the inertia is constant.
//
// When the tool is at rest, M times the remaining displacement is a sum of contact normals. The wrench of the
// coupling (6.9) is also such a sum only if M has the gyration radius of the coupling,
// MotionMetric::coupling. Then the elastic energy is also the least that the contacts allow.

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
