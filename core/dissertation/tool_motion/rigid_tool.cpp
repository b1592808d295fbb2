#include "core/dissertation/tool_motion/rigid_tool.h"

#include "core/points/vector.h"

namespace remote_touch {

namespace {

constexpr double kMaxHipDistance_m = 1e6;  // same limit as for the proxy: no hand is farther away
}

std::optional<ToolPose> device_pose(const DeviceState& device) {
  const bool usable = device.position_W.allFinite() &&
                      device.position_W.cwiseAbs().maxCoeff() <= kMaxHipDistance_m &&
                      device.orientation_W.coeffs().allFinite() && device.orientation_W.norm() > 0.5;
  if (!usable) return {};
  return ToolPose{device.position_W, device.orientation_W.normalized()};
}

ToolPose moved(const ToolPose& pose, const Vector6& a_g) {
  return {pose.p_W + a_g.head<3>(), (rotation(a_g.tail<3>()) * pose.q_WT).normalized()};
}

Vector6 displacement(const ToolPose& from, const ToolPose& to) {
  Vector6 a_gu;
  a_gu << to.p_W - from.p_W, rotation_vector(to.q_WT * from.q_WT.conjugate());
  return a_gu;
}

Vector6 rotated(const Eigen::Quaterniond& q, const Vector6& a_g) {
  Vector6 other;
  other << q * a_g.head<3>(), q * a_g.tail<3>();
  return other;
}

double max_point_displacement_m(const Vector6& a_g, double reach_m) {
  return a_g.head<3>().norm() + a_g.tail<3>().norm() * reach_m;
}

Vector6 capped(const Vector6& a_g, double reach_m, double max_m) {
  const double motion_m = max_point_displacement_m(a_g, reach_m);
  return motion_m > max_m ? Vector6(a_g * (max_m / motion_m)) : a_g;
}

namespace {

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Eigen::Matrix3d inverse_left_jacobian(const Vec3& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d cross = cross_matrix(phi);
  // c = 1/a^2 - cot(a/2)/(2a) for the angle a; 1/12 in the limit a = 0
  const auto [sine, cosine] = sin_cos(0.5 * angle);
  const double c =
      angle < 1e-4 ? 1.0 / 12 + angle * angle / 720 : (1 - 0.5 * angle * cosine / sine) / (angle * angle);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + c * cross * cross;
}

Wrench coupling_wrench(const WrenchSpring& spring, const Eigen::Matrix3d& inertia_m2, const ToolPose& tool,
                       const ToolPose& device) {
  const Vector6 a_gu = displacement(tool, device);
  const Vec3 phi = a_gu.tail<3>();
  const double k = spring.stiffness_N_per_m;
  Vec3 torque;
  if (spring.torque_rule == TorqueRule::printed) {
    const Vec3 turned = tool.q_WT * (inertia_m2 * (tool.q_WT.conjugate() * phi));
    torque = k * spring.rotational_ratio.cwiseProduct(turned);
  } else {
    const double rotational = k * spring.gyration_radius_m * spring.gyration_radius_m;
    torque =
        inverse_left_jacobian(phi).transpose() * (rotational * spring.rotational_ratio.cwiseProduct(phi));
  }
  return {limited_length(-k * spring.ratio.cwiseProduct(a_gu.head<3>()), spring.max_force_N),
          limited_length(-torque, spring.max_torque_Nm)};
}

}  // namespace remote_touch
