#include "core/dissertation/tool/dynamics/tool_pose.h"

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

}  // namespace remote_touch
