#include "core/beyond/tracked_surface/carried_motion.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "core/beyond/tracked_surface/shrinkage.h"

namespace remote_touch {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Converts a motion (t, lever w) of a body about one position to the same motion about another, `by` away
// from it.
Matrix6 transport(const Vec3& by, double lever_m) {
  Matrix6 m = Matrix6::Identity();  // t' = t + w x by
  m.block<3, 3>(0, 3) << 0, by.z(), -by.y(), -by.z(), 0, by.x(), by.y(), -by.x(), 0;
  m.block<3, 3>(0, 3) /= lever_m;
  return m;
}

}  // namespace

void CarriedMotion::add(const CarriedPosition& position) {
  if (empty()) first_W_ = position.p_W;
  const Vec3 r = position.p_W - first_W_;
  Vector6 row;
  row << position.normal_W, r.cross(position.normal_W) / lever_m_;
  rows_ += position.weight * row * row.transpose();
  right_ += position.weight * position.moved_m * row;
  weight_ += position.weight;
  sum_m_ += position.weight * r;
  error_m_ += position.weight * position.error_m;
}

CarriedMotion::Result CarriedMotion::about(const Vec3& about_W, const Vector6& expected) const {
  Result result;
  if (empty()) return result;
  const Vec3 middle = sum_m_ / weight_;
  // Rows about the first position are converted to rows about the mean: row . x = row . T^-1 x'.
  const Matrix6 back = transport(-middle, lever_m_);
  const Matrix6 a = back.transpose() * rows_ * back / weight_;
  const Vector6 b = back.transpose() * right_ / weight_;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(a);
  const Vec3 centre = about_W - first_W_ - middle;
  Vector6 before = expected;
  before.tail<3>() *= lever_m_;
  before = transport(-centre, lever_m_) * before;
  Vector6 x = Vector6::Zero(), shrunk_x = Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value >= kObservable)) continue;
    const Vector6 axis = eigen.eigenvectors().col(k);
    const double along = axis.dot(b) / value, before_along = axis.dot(before);
    const double error_m = error_m_ / weight_ / std::sqrt(value);
    x += along * axis, shrunk_x += (before_along + shrunk(along - before_along, error_m)) * axis;
  }
  for (auto& [from, to] :
       {std::pair<const Vector6&, Vector6&>(x, result.motion), {shrunk_x, result.shrunk}}) {
    to = transport(centre, lever_m_) * from;
    to.tail<3>() /= lever_m_;
  }
  result.known = true;
  return result;
}

}  // namespace remote_touch
