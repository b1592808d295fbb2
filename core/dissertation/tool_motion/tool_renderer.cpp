#include "core/dissertation/tool_motion/tool_renderer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/dissertation/tool_motion/tool_pose.h"

namespace remote_touch {

ToolRenderer::ToolRenderer(const ToolParameters& parameters, const std::shared_ptr<const VoxelTool>& tool,
                           const Kernels& kernels)
    : ToolRenderer(parameters, tool, kernels, make_tool_motion(parameters, *tool)) {}

ToolRenderer::ToolRenderer(const ToolParameters& parameters, std::shared_ptr<const VoxelTool> tool,
                           const Kernels& kernels, std::unique_ptr<ToolMotion> rule)
    : p_(parameters),
      tool_(std::move(tool)),
      kernels_(kernels),
      contacts_(tool_, parameters, kernels),
      motion_(std::move(rule)),
      velocity_(parameters.max_prediction_s),
      slave_(parameters.slave_command) {
  assert(validate(parameters).empty());
}

namespace {

struct PreparedToolFrame final : FramePreparation {
  TiledCloud tiles;
  std::shared_ptr<const FramePreparation> for_rule;
};

std::shared_ptr<const PreparedToolFrame> prepared_tool_frame(const Frame& frame, const ToolMotion& rule,
                                                             double merged_disk_m, const Kernels& kernels) {
  const auto made = std::make_shared<PreparedToolFrame>();
  PointCloud buffer;
  const PointCloud& cloud = frame.points->every_point(kernels, buffer);
  made->tiles.assign(cloud, merged_disk_m);
  made->for_rule = rule.prepared(cloud);
  return made;
}

}  // namespace

void ToolRenderer::prepare(Frame& frame) const {
  frame.prepared = prepared_tool_frame(frame, *motion_, used_merged_disk_m(p_), kernels_);
}

void ToolRenderer::reserve(std::size_t points) {
  contacts_.reserve(points);
}

void ToolRenderer::take_points(std::shared_ptr<const TiledCloud> points) {
  contacts_.on_frame(std::move(points));
  is_measured_ = false;
  updated_ = true;
}

void ToolRenderer::replace_points(std::shared_ptr<const TiledCloud> points) {
  take_points(std::move(points));
}

void ToolRenderer::displace(const Vector6& by) {
  if (by.isZero(0)) return;  // avoids rounding of the pose
  pose_ = moved(pose_, by);
  frame_correction_m_ += by.head<3>();
}

void ToolRenderer::on_frame(const Frame& frame, std::shared_ptr<const TiledCloud> points,
                            const ToolSurfaceMotion& motion) {
  if (!order_.accept_if_newer(frame)) return;
  take_points(std::move(points));
  frame_arrived_s_ = frame.arrives_s;
  displace(motion.displacement);
  measured_rate_per_s_ = motion.rate_per_s;
  velocity_.on_measured(frame.captured_s, motion.rate_per_s.head<3>().dot(normal_W_), normal_W_);
}

void ToolRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  auto prepared = std::dynamic_pointer_cast<const PreparedToolFrame>(frame.prepared);
  if (!prepared) prepared = prepared_tool_frame(frame, *motion_, used_merged_disk_m(p_), kernels_);
  take_points({prepared, &prepared->tiles});
  motion_->on_frame(prepared->for_rule);
  frame_arrived_s_ = frame.arrives_s;
  if (!p_.velocity_estimate) return;
  const Vec3 correction = velocity_.on_frame(frame.captured_s, normal_W_);  // (4.3)
  pose_.p_W += correction;
  frame_correction_m_ += correction;
}

// Applies changed settings. When the estimate is switched on again, it starts from zero.
void ToolRenderer::parameters_changed() {
  if (!p_.velocity_estimate) velocity_ = SurfaceVelocity(p_.max_prediction_s);
}

// Moves the tool by one tick of 6.2.5.
void ToolRenderer::follow(const ToolPose& device, RenderOutput& out) {
  const ToolMotionReport report = motion_->move(pose_, device, contacts_, std::exchange(updated_, false));
  velocity_.on_step(report.first_step_m);  // (4.13)
  is_held_ = report.active_count > 0;
  allowed_W_ = report.allowed_W;
  take_report(report, normal_W_, out);
}

// Returns the pose of the tool for the coupling. The surface that holds the tool continues along v_hat
// between frames, and the tool would continue with it, (4.15). So the force rises evenly instead of by a step
// at each frame.
ToolPose ToolRenderer::coupled_pose(double time_s) const {
  ToolPose pose = allowed_W_.isZero(0) ? pose_ : moved(pose_, allowed_W_);
  const bool is_known = p_.velocity_estimate || measured_rate_per_s_.has_value();
  if (!is_known || !is_held_ || p_.velocity_force == VelocityForce::none) return pose;
  const double since_frame_s = std::min(time_s - frame_arrived_s_, velocity_.horizon_s());
  const double sign = p_.velocity_force == VelocityForce::minus ? 1 : -1;  // 1: u_hat = HIP - P - v t
  if (measured_rate_per_s_)
    return measured_rate_per_s_->isZero(0) ? pose : moved(pose, sign * since_frame_s * *measured_rate_per_s_);
  pose.p_W += sign * since_frame_s * velocity_.vector();
  return pose;
}

RenderOutput ToolRenderer::step(const DeviceState& device, double time_s) {
  RenderOutput out;
  out.frame_index = order_.newest();
  out.frame_correction_m = std::exchange(frame_correction_m_, Vec3::Zero());
  out.tool.emplace();
  const std::optional<ToolPose> goal = device_pose(device);
  if (!goal) {
    out.status = RenderStatus::device_not_finite;  // the tool rests and the force is zero
  } else {
    if (!placed_) pose_ = *goal, placed_ = true;
    if (order_.newest() < 0) {
      pose_ = *goal;
      out.converged = true;
      out.status = RenderStatus::no_frame;
    } else {
      follow(*goal, out);
    }
    const Wrench wrench = coupling_wrench(coupling_of(p_, p_.stiffness_N_per_m), tool_->inertia_m2,
                                          coupled_pose(time_s), *goal);
    out.force_N = wrench.force_N;
    out.tool->torque_Nm = wrench.torque_Nm;
  }
  out.proxy_W = pose_.p_W;
  if (placed_) out.slave_W = slave_.command_W(pose_, goal);
  out.tool->orientation_W = pose_.q_WT;
  out.normal_W = normal_W_;
  out.surface_velocity_m_per_s = velocity_.m_per_s();
  measure(out);
  out.status = order_.status(out.status);
  return out;
}

// Writes the contacts at the end of the tick to the output. This query does not count in the budget of
// detections, because the method does not need it.
void ToolRenderer::measure(RenderOutput& out) {
  if (!is_measured_ || !(pose_ == measured_at_)) {
    touched_ = contacts_.touched(pose_);
    measured_at_ = pose_, is_measured_ = true;
  }
  out.state = touched_.state;
  out.nearest_distance_m = touched_.nearest_distance_m;
  out.contact_count = touched_.points;
  out.tool->contact_clusters = touched_.clusters;
  out.tool->tool_penetration_m = std::max(0.0, -touched_.nearest_distance_m);
  out.tool->disabled_points = contacts_.finder().cloud().count_without_normal();
}

}  // namespace remote_touch
