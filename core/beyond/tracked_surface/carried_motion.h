// Estimate of the motion of a tool that surfaces carry. The motion of each surface is measured along its
// normal only.
#pragma once

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/geometry/vector.h"

namespace remote_touch {

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
