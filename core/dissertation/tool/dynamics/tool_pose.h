// Poses of a rigid tool and the small motions between them, (6.1), (6.2). A generalised displacement, which
// the dissertation calls an acceleration, consists of a translation (three metres) and a rotation (three
// radians) per unit step. A rotation is a rotation vector in the world frame; its exponential map is applied
// from the left.
#pragma once

#include <optional>

#include "core/points/rotation.h"
#include "core/points/vector.h"
#include "core/rendering/frame.h"

namespace remote_touch {

using Vector6 = Eigen::Matrix<double, 6, 1>;

// The position of the tool's centre of mass, and the orientation that transforms tool coordinates T to the
// world W.
struct ToolPose {
  Vec3 p_W = Vec3::Zero();
  Eigen::Quaterniond q_WT = Eigen::Quaterniond::Identity();  // a unit quaternion

  bool operator==(const ToolPose& other) const {
    return p_W == other.p_W && q_WT.coeffs() == other.q_WT.coeffs();
  }
};

// Returns the pose of a tool that the device holds by its centre of mass. Returns nullopt if the device is
// not finite, more than 1000 km away along an axis, or without an orientation.
std::optional<ToolPose> device_pose(const DeviceState& device);

ToolPose moved(const ToolPose& pose, const Vector6& a_g);
// Returns the displacement (6.2) that moves one pose to the other in a unit step, in world axes.
Vector6 displacement(const ToolPose& from, const ToolPose& to);

// Returns the same displacement in other axes; q transforms coordinates in the present axes to the new ones.
Vector6 rotated(const Eigen::Quaterniond& q, const Vector6& a_g);

// Returns an upper bound of the displacement of any point of the tool, |a| + |alpha| reach.
double max_point_displacement_m(const Vector6& a_g, double reach_m);
// Returns the displacement, scaled down so that this bound is at most max_m.
Vector6 capped(const Vector6& a_g, double reach_m, double max_m);

}  // namespace remote_touch
