#include "core/dissertation/sphere_tree/sphere_tree_renderer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/dissertation/tool/dynamics/wrench_coupling.h"
#include "core/rendering/frame_order.h"

namespace remote_touch {

namespace {

double reach_m(const SphereTree& spheres) {
  double reach = 0;
  for (const Sphere& leaf : spheres.leaves()) reach = std::max(reach, leaf.centre.norm() + leaf.radius_m);
  return reach;
}

ContactState state_of(double gap_m) {
  if (gap_m < -RegionContacts::kTouch_m) return ContactState::entrenched;
  return gap_m < RegionContacts::kTouch_m ? ContactState::contact : ContactState::free;
}

}  // namespace

Parameters region_parameters(ToolParameters& p) {
  return without(parameters(p),
                 {"contact_rule", "free_accuracy_m", "exit_accuracy_m", "disk_radius_ratio", "merged_disk_m",
                  "frame_reach_m", "velocity_estimate", "max_prediction_s", "velocity_force"});
}

Parameters SphereTreeRenderer::live_parameters() {
  return live_ones(region_parameters(p_));
}

SphereTreeRenderer::SphereTreeRenderer(const ToolParameters& parameters,
                                       std::shared_ptr<const VoxelTool> tool,
                                       const std::shared_ptr<const SphereTree>& spheres,
                                       const Kernels& kernels)
    : p_(parameters),
      tool_(std::move(tool)),
      kernels_(kernels),
      contacts_(spheres, parameters.look_ahead_m, kernels),
      motion_(parameters, *tool_, reach_m(*spheres)),
      slave_(parameters.slave_command) {}

void SphereTreeRenderer::prepare(Frame& frame) const {
  frame.prepared = prepared_form<RegionTree>(*frame.points, kernels_);
}

void SphereTreeRenderer::reserve(std::size_t points) {
  contacts_.reserve(points);
}

void SphereTreeRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  contacts_.on_frame(form_of<RegionTree>(frame, kernels_));
  updated_ = true;
}

// Moves the tool by one tick of the quasi-static motion, 7.4.2.
void SphereTreeRenderer::follow(const ToolPose& device, RenderOutput& out) {
  const ToolMotionReport report = motion_.move(pose_, device, contacts_, std::exchange(updated_, false));
  take_report(report, normal_W_, out);
}

RenderOutput SphereTreeRenderer::step(const DeviceState& device, double) {
  RenderOutput out;
  out.frame_index = order_.newest();
  out.tool.emplace();
  const std::optional<ToolPose> target = device_pose(device);
  if (!target) {
    out.status = RenderStatus::device_not_finite;  // the tool rests and the force is zero
  } else {
    if (!placed_) pose_ = *target, placed_ = true;
    if (order_.newest() < 0) {
      pose_ = *target;
      out.converged = true;
      out.status = RenderStatus::no_frame;
    } else {
      follow(*target, out);
    }
  }
  const RegionTouch touch = contacts_.touched(pose_, p_.stiffness_N_per_m);
  if (target) {
    const Wrench wrench =
        coupling_wrench(coupling_of(p_, touch.stiffness_N_per_m), tool_->inertia_m2, pose_, *target);
    out.force_N = wrench.force_N;
    out.tool->torque_Nm = wrench.torque_Nm;
  }
  out.proxy_W = pose_.p_W;
  if (placed_) out.slave_W = slave_.command_W(pose_, target);
  out.tool->orientation_W = pose_.q_WT;
  out.normal_W = normal_W_;
  out.state = state_of(touch.nearest_distance_m);
  out.nearest_distance_m = touch.nearest_distance_m;
  out.contact_count = touch.leaf_pairs;
  out.tool->contact_clusters = touch.touching_leaf_count;
  out.tool->tool_penetration_m = std::max(0.0, -touch.nearest_distance_m);
  out.status = order_.status(out.status);
  return out;
}

}  // namespace remote_touch
