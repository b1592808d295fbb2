// A rigid tool: its poses and the small motions between them, (6.1), (6.2), and its coupling to the device,
// (6.9). A generalised displacement, which the dissertation calls an
// acceleration, consists of a translation (three metres) and a rotation (three radians) per unit step. A
// rotation is a rotation vector in the world frame; its exponential map is applied from the left.
#pragma once

#include <limits>
#include <optional>

#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

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

// The commanded position of a slave robot with a tool, 5.2. Its orientation is that of the same pose.
class SlavePosition {
 public:
  explicit SlavePosition(SlaveCommand rule) : rule_(rule) {}
  // Returns the tool's position for SlaveCommand::rendered, and the device's for hip. If the device's pose is
  // not valid, hip repeats the last command; the result is NaN before the first one.
  // pre: the tool has been placed at a device pose.
  Vec3 command_W(const ToolPose& tool, const std::optional<ToolPose>& device) {
    if (rule_ == SlaveCommand::rendered) return tool.p_W;
    if (device) last_W_ = device->p_W;
    return last_W_;
  }

 private:
  const SlaveCommand rule_;
  Vec3 last_W_ = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

enum class TorqueRule { inverse_jacobian, printed };  // torque of (6.9)

// A spring between two poses.
struct WrenchSpring {
  double stiffness_N_per_m = 0;
  double gyration_radius_m = 0;  // rotational stiffness = stiffness times this squared
  double max_force_N = 0, max_torque_Nm = 0;
  TorqueRule torque_rule = TorqueRule::inverse_jacobian;
  Vec3 ratio{1, 1, 1}, rotational_ratio{1, 1, 1};  // stiffness factors along and about x, y, z of the world
};

// Returns the inverse left Jacobian J^-1 of a rotation vector phi: if R(phi') = exp(delta) R(phi), then phi'
// - phi = J^-1 delta for a small delta. Its transpose transforms the derivative of an energy by phi to a
// torque. pre: |phi| < 2 pi.
Eigen::Matrix3d inverse_left_jacobian(const Vec3& phi);

// Returns the wrench of (6.9), f = K M a_gu: a spring that pulls the hand from the device's pose towards the
// tool's. K is diagonal in world axes: k A along them and k r^2 B about them, where r is the gyration radius,
// and A and B are the diagonal matrices of the ratios. Let p be the vector from tool to device, and phi =
// log(R_device R_tool^T). The spring has the energy k p.A p / 2 + k r^2 phi.B phi / 2, and its torque on the
// hand is - J^-T k r^2 B phi. If B = I, J^-T has no effect. The printed torque is - k B I_W phi, where I_W is
// the inertia for 1 kg in world axes; it does not derive from an energy. Force and torque are limited to
// max_force_N and max_torque_Nm.
Wrench coupling_wrench(const WrenchSpring& spring, const Eigen::Matrix3d& inertia_m2, const ToolPose& tool,
                       const ToolPose& device);

}  // namespace remote_touch
