// The axis along which a cloud is thinnest: the eigenvector of the smallest eigenvalue of a symmetric matrix.
// It is computed by cyclic Jacobi rotations in plain double, because the results of Eigen's solver differ in
// the last bits between x86-64 levels.
#pragma once

#include <Eigen/Core>

#include "core/geometry/vector.h"

namespace remote_touch {

struct ThinnestAxis {
  Vec3 axis = Vec3::UnitX();  // unit; its sign has no meaning
  double smallest = 0;        // eigenvalue of this axis
  double middle = 0;          // next larger eigenvalue; if both are equal, the axis is not unique
};

// pre: the matrix is symmetric and finite. If a coordinate changes its sign, the signs of the off-diagonal
// elements of that coordinate change too. The axis is then the same, bit for bit, except for the sign of that
// coordinate.
ThinnestAxis thinnest_axis(const Eigen::Matrix3d& symmetric);

}  // namespace remote_touch
