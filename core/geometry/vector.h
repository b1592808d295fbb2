// Positions, directions and rigid transforms: Eigen in double precision, metres. A name carries its frame:
// p_W is a position in the world frame W, X_WC transforms camera coordinates C to W.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace remote_touch {

using Vec3 = Eigen::Vector3d;
using RigidTransform = Eigen::Isometry3d;

}  // namespace remote_touch
