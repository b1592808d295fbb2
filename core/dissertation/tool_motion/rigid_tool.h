// A rigid tool: the settings of its renderer, 6.3, its poses and the small motions between them, (6.1),
// (6.2), and its coupling to the device, (6.9). A generalised displacement, which the dissertation calls an
// acceleration, consists of a translation (three metres) and a rotation (three radians) per unit step. A
// rotation is a rotation vector in the world frame; its exponential map is applied from the left.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// The rule by which contacts limit the motion. look_ahead: constraints from the distance field. voxels: 6.2.3
// to 6.2.5 as printed. continuous: as look_ahead, with certified steps.
enum class ContactRule { look_ahead, voxels, continuous };
enum class TorqueRule { inverse_jacobian, printed };  // torque of (6.9)
enum class MotionMetric { tool, coupling };           // M of (6.4)

// Settings of the 6-DOF renderer, including the choices between different readings of an equation.
struct ToolParameters {
  ContactRule contact_rule = ContactRule::look_ahead;
  int detections_per_tick = 60;
  double max_step_m = 1e-3;       // s_max
  double free_accuracy_m = 1e-4;  // epsilon_f
  double exit_accuracy_m = 1e-4;  // epsilon_c
  double look_ahead_m = 2e-3;
  double disk_radius_ratio = 0.75;
  double merged_disk_m = 2e-3;
  double frame_reach_m = 0.02;
  double rest_threshold_m = 1e-6;
  double stiffness_N_per_m = 600;  // K of (6.9) for a tool of 1 kg
  double gyration_radius_m = 0.03;
  Vec3 stiffness_ratio{1, 1, 1};             // diagonal of K: factors along the world axes
  Vec3 rotational_stiffness_ratio{1, 1, 1};  // factors about the world axes
  double max_force_N = 20;
  double max_torque_Nm = 1;
  TorqueRule torque_rule = TorqueRule::inverse_jacobian;
  MotionMetric motion_metric = MotionMetric::tool;
  bool velocity_estimate = false;  // not in the dissertation
  double max_prediction_s = 0.1;
  VelocityForce velocity_force = VelocityForce::minus;
  SlaveCommand slave_command = SlaveCommand::rendered;
};

Parameters parameters(ToolParameters& p);
// Returns merged_disk_m for the rules that merge disks, else 0. It is also 0 if points have no disks, because
// merged points would then leave gaps.
double used_merged_disk_m(const ToolParameters& p);
std::string validate(const ToolParameters& p);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m. It does not cover points that have a stiffness of their own.
inline double max_stiffness_N_per_m(const ToolParameters& p) {
  return p.stiffness_N_per_m * p.stiffness_ratio.maxCoeff();
}

// The settings of the coupling (6.9) with the same stiffness in all directions. The methods for comparison
// share them. The members mean the same as those of ToolParameters.
struct EvenCoupling {
  double stiffness_N_per_m = 600, gyration_radius_m = 0.03;
  double max_force_N = 20, max_torque_Nm = 1;
};

Parameters parameters(EvenCoupling& p);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m, for the settings of a method that has this coupling.
template <class Settings>
requires requires(const Settings& s) {
  s.coupling.stiffness_N_per_m;
}
double max_stiffness_N_per_m(const Settings& s) {
  return s.coupling.stiffness_N_per_m;
}
// Returns tool settings with this coupling and without merged disks; the other settings have their defaults.
ToolParameters tool_parameters(const EvenCoupling& p);

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

// A spring between two poses.
struct WrenchSpring {
  double stiffness_N_per_m = 0;
  double gyration_radius_m = 0;  // rotational stiffness = stiffness times this squared
  double max_force_N = 0, max_torque_Nm = 0;
  TorqueRule torque_rule = TorqueRule::inverse_jacobian;
  Vec3 ratio{1, 1, 1}, rotational_ratio{1, 1, 1};  // stiffness factors along and about x, y, z of the world
};

// Returns the coupling (6.9) between tool and device, with this stiffness.
inline WrenchSpring coupling_of(const ToolParameters& p, double stiffness_N_per_m) {
  return {stiffness_N_per_m, p.gyration_radius_m,         p.max_force_N, p.max_torque_Nm, p.torque_rule,
          p.stiffness_ratio, p.rotational_stiffness_ratio};
}

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
