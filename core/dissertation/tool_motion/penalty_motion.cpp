#include "core/dissertation/tool_motion/penalty_motion.h"

#include <Eigen/Cholesky>
#include <utility>

namespace remote_touch {

namespace {

constexpr int kFullPoints = 10;  // if more points push, all are scaled as if this many did

struct PreparedVoxmap final : FramePreparation {
  PreparedVoxmap(const PointCloud& cloud, double voxel_m) : map(cloud, voxel_m) {}
  Voxmap map;
};

}  // namespace

Parameters parameters(ToolPenaltyParameters& p) {
  const Parameters own = {
      {"force_law", choice(p.force_law, {"distance-field", "voxmap"}), 0, 0,
       "distance-field: points of the cloud in the distance field of the tool; voxmap: points of the tool in a voxmap of the cloud, with tangent planes, as McNeely 1999"},
      {"voxmap_voxel_m", &p.voxmap_voxel_m, 5e-4, 0.05,
       "for force_law = voxmap: size of a voxel, and spacing of the points on the tool; not below the spacing of the cloud"},
      {"point_stiffness_N_per_m", &p.point_stiffness_N_per_m, 1, 1e6,
       "k_p: force of a point per depth; if more than 10 points touch, their sum is scaled as if 10 did"},
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each half a voxel or less; a tick that needs more sets budget_exhausted"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
  };
  return appended(own, parameters(p.coupling));
}

ToolParameters tool_parameters(const ToolPenaltyParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::voxels;  // points touch, and not disks
  tool.rest_threshold_m = p.rest_threshold_m;
  return tool;
}

void PenaltyMotion::Push::add(const Vec3& r_T, const Vec3& n_T, double depth_m, double k_p_N_per_m) {
  Vector6 line;
  line << n_T, r_T.cross(n_T);
  ++points;
  wrench_T += k_p_N_per_m * depth_m * line;
  stiffness_T += k_p_N_per_m * line * line.transpose();
}

// Returns the step in world axes. The linearisation: a displacement of the tool reduces the depth of a point
// by the dot product of the point's line and the displacement.
Vector6 PenaltyMotion::balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const {
  const double k = p_.coupling.stiffness_N_per_m;
  const double turning = k * p_.coupling.gyration_radius_m * p_.coupling.gyration_radius_m;
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
    Push push = this->push(pose, contacts);
    if (push.points > kFullPoints) {
      const double fraction = double(kFullPoints) / push.points;
      push.wrench_T *= fraction, push.stiffness_T *= fraction;
    }
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

PenaltyMotion::Push FieldPenalty::push(const ToolPose& pose, const ContactList& contacts) const {
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
    all.add(p_T, n_T, depth_m, p_.point_stiffness_N_per_m);
  }
  return all;
}

std::shared_ptr<const FramePreparation> VoxmapPenalty::prepared(const PointCloud& cloud) const {
  return std::make_shared<const PreparedVoxmap>(cloud, p_.voxmap_voxel_m);
}

void VoxmapPenalty::on_frame(const std::shared_ptr<const FramePreparation>& prepared) {
  const auto made = std::dynamic_pointer_cast<const PreparedVoxmap>(prepared);
  map_ = made ? std::shared_ptr<const Voxmap>(made, &made->map) : nullptr;
}

PenaltyMotion::Push VoxmapPenalty::push(const ToolPose& pose, const ContactList&) const {
  Push all;
  if (!map_) return all;
  const Eigen::Matrix3d R_WT = pose.q_WT.toRotationMatrix();
  for (std::size_t i = 0; i < shell_.size(); ++i) {
    const Vec3 p_W = pose.p_W + R_WT * shell_.p_T[i];
    const std::optional<Vec3> middle_W = map_->surface_middle_W(p_W);
    if (!middle_W) continue;
    const double depth_m = (R_WT * shell_.n_T[i]).dot(*middle_W - p_W);
    if (depth_m > 0) all.add(shell_.p_T[i], shell_.n_T[i], depth_m, p_.point_stiffness_N_per_m);
  }
  return all;
}

std::unique_ptr<ToolMotion> make_penalty_motion(const ToolPenaltyParameters& parameters,
                                                const VoxelTool& tool) {
  if (parameters.force_law == PenaltyLaw::voxmap) return std::make_unique<VoxmapPenalty>(parameters, tool);
  return std::make_unique<FieldPenalty>(parameters, tool);
}

}  // namespace remote_touch
