#include "core/tool/motion/penalty_motion.h"

#include <Eigen/Cholesky>

namespace remote_touch {

namespace {

constexpr int kFullPoints = 10;  // more points than these push no more in sum

}  // namespace

Parameters parameters(ToolPenaltyParameters& p) {
  return {
      {"point_stiffness_N_per_m", &p.point_stiffness_N_per_m, 1, 1e6,
       "k_p: force of a point on the tool per depth in it; where more than 10 points touch, they push as 10"},
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each half a voxel or less; a tick that needs more sets budget_exhausted"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 1, 10000, "stiffness of the virtual coupling"},
      {"gyration_radius_m", &p.gyration_radius_m, 1e-3, 1,
       "rotational stiffness = stiffness times this squared"},
      {"max_force_N", &p.max_force_N, 0, 1000,
       "maximum magnitude of the force; larger forces are scaled down to it"},
      {"max_torque_Nm", &p.max_torque_Nm, 0, 100,
       "maximum magnitude of the torque; larger torques are scaled down to it"},
  };
}

ToolParameters tool_parameters(const ToolPenaltyParameters& p) {
  ToolParameters tool;
  tool.contact_rule = TouchRule::voxels;  // points touch, and not disks
  tool.rest_threshold_m = p.rest_threshold_m;
  tool.stiffness_N_per_m = p.stiffness_N_per_m, tool.gyration_radius_m = p.gyration_radius_m;
  tool.max_force_N = p.max_force_N, tool.max_torque_Nm = p.max_torque_Nm;
  return tool;
}

PenaltyMotion::Push PenaltyMotion::push(const ToolPose& pose, const ContactList& contacts) const {
  const TouchFinder& finder = contacts.finder();
  const TiledCloud& cloud = finder.cloud();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  Push all;
  for (const std::uint32_t point : finder.within(pose, 0)) {
    const Vec3 n_W = cloud.normal(point);
    const Vec3 p_T = R_TW * (cloud.point(point) - pose.p_W);
    const FieldSample at = sample_field(finder.tool(), p_T);
    const double depth_m = -at.distance_m;
    if (!(depth_m > 0)) continue;
    const Vec3 n_T = n_W.allFinite() ? Vec3(R_TW * n_W) : Vec3(-at.gradient_T.normalized());
    Vector6 line;
    line << n_T, p_T.cross(n_T);
    ++all.points;
    all.wrench_T += p_.point_stiffness_N_per_m * depth_m * line;
    all.stiffness_T += p_.point_stiffness_N_per_m * line * line.transpose();
  }
  if (all.points <= kFullPoints) return all;
  const double fraction = double(kFullPoints) / all.points;
  all.wrench_T *= fraction, all.stiffness_T *= fraction;
  return all;
}

// World axes. The depth of a point falls by its line times the displacement of the tool.
Vector6 PenaltyMotion::balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const {
  const double k = p_.stiffness_N_per_m, turning = k * p_.gyration_radius_m * p_.gyration_radius_m;
  Vector6 spring;
  spring << k, k, k, turning, turning, turning;
  const Vector6 wanted_T = rotated(pose.q_WT.conjugate(), displacement(pose, device));
  Eigen::Matrix<double, 6, 6> stiffness = push.stiffness_T;
  stiffness.diagonal() += spring;
  const Vector6 step_T = stiffness.ldlt().solve(spring.cwiseProduct(wanted_T) + push.wrench_T);
  return capped(rotated(pose.q_WT, step_T), reach_m_, max_step_m_);
}

ToolMotionReport PenaltyMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  while (!report.at_rest && report.steps < p_.steps_per_tick) {
    const Push push = this->push(pose, contacts);
    const Vector6 step = balancing_step(pose, device, push);
    ++report.detections, ++report.steps;
    report.active_count = push.points;
    report.push_W = pose.q_WT * Vec3(push.wrench_T.head<3>());
    report.at_rest = max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m;
    pose = push.points == 0 && report.at_rest ? device : moved(pose, step);
  }
  report.first_step_m = pose.p_W - start_W;
  return report;
}

}  // namespace remote_touch
