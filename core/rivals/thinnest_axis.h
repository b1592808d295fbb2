// The axis along which a cloud is thinnest: the eigenvector of the smallest eigenvalue of a symmetric matrix,
// by cyclic Jacobi rotations in plain double. Eigen's solver differs in the last bits between x86-64 levels.
#pragma once

#include <Eigen/Core>

#include "core/geometry/vector.h"

namespace remote_touch {

struct ThinnestAxis {
  Vec3 axis = Vec3::UnitX();  // unit; its sign has no meaning
  double smallest = 0;        // eigenvalue that belongs to it
  double middle = 0;          // the next larger one: if both are equal the axis is not unique
};

// pre: symmetric and finite. A matrix whose off-diagonal elements change their signs together with a
// coordinate gives the same axis with that coordinate's sign changed, bit for bit.
ThinnestAxis thinnest_axis(const Eigen::Matrix3d& symmetric);

}  // namespace remote_touch
