// Positions on a tool, and the motion with which surfaces carry it.
#pragma once

#include <span>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch {

// Positions on the surface of a tool, in a few groups. Each group is small enough for one patch of a tracked
// sheet. The positions are in the tool frame. Nothing is allocated after construction.
class ToolPositions {
 public:
  struct Group {
    Vec3 middle_T = Vec3::Zero();
    double radius_m = 0;  // distance of its farthest position from the middle
    std::size_t first = 0, count = 0;
  };

  // Selects at most kMax positions on the surface of the mesh, spread evenly: each one is the farthest from
  // those before it. It stops when every sampled position of the surface is within group_radius_m / 8 of a
  // selected one. Then it divides them into the smallest number of groups with radii up to group_radius_m,
  // but at most max_groups groups.
  static constexpr std::size_t kMax = 256;
  ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups);

  std::span<const Vec3> all() const { return positions_T_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const Vec3> of(const Group& group) const { return all().subspan(group.first, group.count); }

 private:
  void divide(std::size_t groups);

  std::vector<Vec3> positions_T_;  // group by group
  std::vector<Group> groups_;
};

// Estimate of the motion of a tool that surfaces carry. The motion of each surface is measured along its
// normal only.

// A position where a surface holds the tool, and the motion of the surface there along its unit normal.
struct CarriedPosition {
  Vec3 p_W, normal_W;
  double moved_m = 0, error_m = 0;  // error_m: standard error of moved_m
  double weight = 1;
};

// Least squares over positions p_k for a displacement t of their weighted mean c and a rotation vector w
// about it: n_k . (t + w x (p_k - c)) = d_k. The motion is zero in directions that the positions do not
// determine. These are the directions in the space of (t, lever w) in which the mean square of the rows is
// below kObservable. So a single position gives a displacement along its normal, a row of positions adds a
// rotation about one axis, and a face adds rotations about two. Displacement within a face and rotation about
// its normal remain zero. Positions are summed in the order of add(). Allocates nothing.
class CarriedMotion {
 public:
  // lever_m: a rotation counts as the displacement that it causes at this distance from the mean.
  explicit CarriedMotion(double lever_m) : lever_m_(lever_m) {}
  static constexpr double kObservable = 0.1;
  void clear() { *this = CarriedMotion(lever_m_); }
  void add(const CarriedPosition& position);
  bool empty() const { return !(weight_ > 0); }

  struct Result {
    Vector6 motion = Vector6::Zero();  // (displacement, rotation vector) of the body in m and rad, world axes
    Vector6 shrunk = Vector6::Zero();  // the same: `expected` plus the change that noise does not explain
    bool known = false;
  };
  // Returns the motion as that of a body whose centre is at about_W. expected: predicted motion of the same
  // body. known is false if there are no positions.
  Result about(const Vec3& about_W, const Vector6& expected = Vector6::Zero()) const;

 private:
  double lever_m_;
  double weight_ = 0, error_m_ = 0;
  Vec3 first_W_ = Vec3::Zero(), sum_m_ = Vec3::Zero();  // sums are relative to the first position
  Eigen::Matrix<double, 6, 6> rows_ = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 right_ = Vector6::Zero();
};

}  // namespace remote_touch
