#include "core/rivals/inner_sphere_motion.h"

#include <Eigen/Cholesky>
#include <utility>

namespace remote_touch {

namespace {

// Weight of the earlier steps in the sum to which the next step is compared.
constexpr double kTrend = 0.5;

}  // namespace

Parameters parameters(InnerSphereParameters& p) {
  const Parameters own = {
      {"inner_spheres", &p.inner_spheres, 1, kMaxInnerSpheres,
       "largest number of spheres that fill the tool without overlap; fewer if no more of 0.9 voxels fit"},
      {"volume_stiffness_N_per_m3", &p.volume_stiffness_N_per_m3, 1e3, 1e13,
       "k_V: force of a sphere per volume of its part in the scene"},
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each half a voxel or less; a tick that needs more sets budget_exhausted"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
  };
  return appended(own, parameters(p.coupling));
}

ToolParameters tool_parameters(const InnerSphereParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::voxels;  // points touch, and not disks
  tool.rest_threshold_m = p.rest_threshold_m;
  return tool;
}

InnerSphereMotion::InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool)
    : InnerSphereMotion(
          parameters, tool,
          std::make_shared<const InnerSpheres>(make_inner_spheres(tool, parameters.inner_spheres))) {}

InnerSphereMotion::InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool,
                                     std::shared_ptr<const InnerSpheres> spheres)
    : p_(parameters),
      reach_m_(tool.reach_m),
      max_step_m_(0.5 * tool.grid.size_m),
      query_(std::move(spheres)) {}

// Returns the step in world axes. The linearisation: a displacement of the tool moves the cut of each sphere,
// which changes the volume by the area of the cut times the motion along the normal.
Vector6 InnerSphereMotion::balancing_step(const ToolPose& pose, const ToolPose& device,
                                          const SpherePenetration& in) const {
  const double k = p_.coupling.stiffness_N_per_m, k_V = p_.volume_stiffness_N_per_m3;
  const double turning = k * p_.coupling.gyration_radius_m * p_.coupling.gyration_radius_m;
  Vector6 spring;
  spring << k, k, k, turning, turning, turning;
  const Vector6 wanted_T = rotated(pose.q_WT.conjugate(), displacement(pose, device));
  Eigen::Matrix<double, 6, 6> stiffness = k_V * in.slope_T;
  stiffness.diagonal() += spring;
  return rotated(pose.q_WT, stiffness.ldlt().solve(spring.cwiseProduct(wanted_T) + k_V * in.wrench_T));
}

bool InnerSphereMotion::turns_back(const Vector6& step, const Vector6& trend) const {
  return step.head<3>().dot(trend.head<3>()) + reach_m_ * reach_m_ * step.tail<3>().dot(trend.tail<3>()) < 0;
}

// Points that enter and leave spheres can move the balance to and fro forever. So the limit of the steps is
// halved whenever a step in contact turns back, until it is below the rest threshold.
ToolMotionReport InnerSphereMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                         bool) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  double limit_m = max_step_m_;
  Vector6 trend = Vector6::Zero();
  while (!report.at_rest && report.steps < p_.steps_per_tick) {
    const SpherePenetration in = query_.penetration(pose, contacts.finder());
    Vector6 step = balancing_step(pose, device, in);
    if (in.spheres > 0 && turns_back(step, trend)) limit_m *= 0.5;
    step = capped(step, reach_m_, limit_m);
    trend = kTrend * trend + step;
    ++report.detections, ++report.steps;
    report.active_count = in.spheres;
    report.push_W = pose.q_WT * Vec3(in.wrench_T.head<3>());
    report.at_rest = max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m;
    pose = in.spheres == 0 && report.at_rest ? device : moved(pose, step);
  }
  report.first_step_m = pose.p_W - start_W;
  return report;
}

}  // namespace remote_touch
