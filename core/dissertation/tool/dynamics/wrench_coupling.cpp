#include "core/dissertation/tool/dynamics/wrench_coupling.h"

#include "core/points/vector.h"

namespace remote_touch {
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
