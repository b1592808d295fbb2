#include "core/dissertation/tool_motion/tool_renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/rigid_tool.h"

namespace remote_touch {
namespace {

// The rule as printed, 6.2.3 to 6.2.5. Points in shell voxels are contacts, and points in interior voxels are
// collisions. The tool moves in sub-steps of half a voxel so that no contact is missed.

class VoxelMotion final : public ToolMotion {
 public:
  VoxelMotion(const ToolParameters& parameters, const VoxelTool& tool)
      : p_(parameters),
        reach_m_(tool.reach_m),
        sub_step_m_(0.5 * tool.grid.size_m),
        program_(parameters, tool) {}
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  struct PoseQuery {  // state and contacts of a pose
    ContactState state = ContactState::free;
    std::span<const ToolContact> contacts;
  };
  PoseQuery query(const ToolPose& pose, ContactList& contacts, ToolMotionReport& report) const;
  struct DesiredStep {
    Vector6 a_g;
    bool trapped = false;  // no motion leads out of all collisions
    bool failed = false;   // ConstrainedMotion::failed
  };
  DesiredStep desired_step(const ToolPose& pose, const Vector6& a_gu, const PoseQuery& here,
                           ToolMotionReport& report);
  bool advance(ToolPose& pose, PoseQuery& here, const Vector6& a_g, const ToolPose* goal,
               ContactList& contacts, ToolMotionReport& report) const;
  bool spent(const ToolMotionReport& report) const { return report.detections >= p_.detections_per_tick; }

  const ToolParameters p_;
  const double reach_m_, sub_step_m_;
  MotionProgram program_;
};

// A tick ends after this number of successive steps in contact without progress, because contact and
// collision can alternate forever.
constexpr int kVoxelPatience = 4;

VoxelMotion::PoseQuery VoxelMotion::query(const ToolPose& pose, ContactList& contacts,
                                          ToolMotionReport& report) const {
  ++report.detections;
  const VoxelContacts found = contacts.in_voxels(pose);
  Vec3 touch_T = Vec3::Zero();
  for (const ToolContact& contact : found.contacts) touch_T += contact.n_T;
  report.touch_W = pose.q_WT * touch_T;
  if (found.collided) return {ContactState::entrenched, found.contacts};
  return {found.touched ? ContactState::contact : ContactState::free, found.contacts};
}

// Returns the desired step from here: (6.2) when free, (6.4) in contact, (6.7) in a collision.
VoxelMotion::DesiredStep VoxelMotion::desired_step(const ToolPose& pose, const Vector6& a_gu,
                                                   const PoseQuery& here, ToolMotionReport& report) {
  report.active_count = 0, report.push_W.setZero();
  // The step is no longer than the budget of detections allows.
  if (here.state == ContactState::free) return {capped(a_gu, reach_m_, p_.detections_per_tick * sub_step_m_)};
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  ConstrainedMotion motion;
  bool trapped = false;
  if (here.state == ContactState::contact) {
    motion = program_.solve(desired_T, here.contacts);
  } else {
    motion = program_.solve(Vector6::Zero(), here.contacts);
    trapped = motion.is_relaxed;
    const double motion_m = max_point_displacement_m(motion.a_g, reach_m_);
    if (trapped)  // a wedge: the tool stays between the points and follows the device
      motion = program_.solve(desired_T, here.contacts);
    else if (motion_m > 0)  // the length of (6.7) has no meaning
      motion.a_g *= p_.max_step_m / motion_m;
  }
  report.active_count = motion.active_count;
  report.push_W = pose.q_WT * motion.push_T;
  return {capped(rotated(pose.q_WT, motion.a_g), reach_m_, p_.max_step_m), trapped, motion.failed};
}

// Moves along a displacement in sub-steps, to its end or until the state changes; bisection then finds the
// change. A change from contact to free does not end the motion. If the budget is used up, the tool stays at
// the last pose that was queried and accepted. Returns true if the tool reached the end.
bool VoxelMotion::advance(ToolPose& pose, PoseQuery& here, const Vector6& a_g, const ToolPose* goal,
                          ContactList& contacts, ToolMotionReport& report) const {
  const ToolPose start = pose;
  const double motion_m = max_point_displacement_m(a_g, reach_m_);
  const int sub_steps = std::max(1, static_cast<int>(std::ceil(motion_m / sub_step_m_)));
  const ContactState from = here.state;
  const auto at = [&](double fraction) {
    return fraction == 1 && goal ? *goal : moved(start, fraction * a_g);
  };
  double before = 0;  // fraction of the displacement up to which the state was the old one
  for (int i = 1; i <= sub_steps; ++i) {
    if (spent(report)) return false;
    const double fraction = i == sub_steps ? 1 : static_cast<double>(i) / sub_steps;
    PoseQuery there = query(at(fraction), contacts, report);
    if (there.state == from || (from == ContactState::contact && there.state == ContactState::free)) {
      pose = at(fraction), here = there, before = fraction;
      continue;
    }
    // The tool is put at the end `after` of the interval. It is the touching end on the way into contact,
    // 6.2.5, and the end outside on the way out of a collision. One detection is reserved for this pose, in
    // case the last query was at the other end.
    double after = fraction;
    bool seen = true;  // the last query was at `after`
    const double accuracy = from == ContactState::entrenched ? p_.exit_accuracy_m : p_.free_accuracy_m;
    while ((after - before) * motion_m > accuracy && report.detections + 1 < p_.detections_per_tick) {
      const double middle = 0.5 * (before + after);
      const PoseQuery between = query(at(middle), contacts, report);
      seen = between.state != from;
      (seen ? after : before) = middle;
      if (seen) there = between;
    }
    pose = at(after);
    here = seen ? there : query(pose, contacts, report);  // lists are those of the last pose queried
    return false;
  }
  return true;
}

ToolMotionReport VoxelMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  PoseQuery here = query(pose, contacts, report);
  const ContactState first = here.state;
  bool same_state = true;
  MotionProgress progress(p_.rest_threshold_m, kVoxelPatience);
  while (true) {
    const Vector6 a_gu = displacement(pose, device);
    const DesiredStep desired = desired_step(pose, a_gu, here, report);
    const double left = max_point_displacement_m(a_gu, reach_m_);
    if (here.state == ContactState::contact) progress.update(left);
    const bool may_rest = here.state != ContactState::entrenched || desired.trapped;
    const bool stops = (may_rest && max_point_displacement_m(desired.a_g, reach_m_) <= p_.rest_threshold_m) ||
                       (here.state == ContactState::contact && progress.has_ended());
    report.at_rest = stops && !desired.failed;
    if (here.state == ContactState::free && left <= p_.rest_threshold_m) pose = device;
    if (stops || spent(report)) break;
    const bool arrives = here.state == ContactState::free && desired.a_g == a_gu;
    report.at_rest =
        advance(pose, here, desired.a_g, arrives ? &device : nullptr, contacts, report) && arrives;
    ++report.steps;
    // The step that ends the first state belongs to it.
    if (same_state) report.first_step_m = pose.p_W - start_W;
    same_state = same_state && here.state == first;
    if (report.at_rest) break;
  }
  return report;
}

class LookAheadOnPoints final : public ToolMotion {
 public:
  LookAheadOnPoints(const ToolParameters& parameters, const VoxelTool& tool)
      : motion_(parameters, tool, tool.reach_m) {}
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                        bool updated) override {
    return motion_.move(pose, device, contacts, updated);
  }

 private:
  LookAheadMotion motion_;
};

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

std::unique_ptr<ToolMotion> make_tool_motion(const ToolParameters& parameters, const VoxelTool& tool) {
  switch (parameters.contact_rule) {
    case ContactRule::voxels:
      return std::make_unique<VoxelMotion>(parameters, tool);
    case ContactRule::continuous:
      return std::make_unique<ContinuousMotion>(parameters, tool);
    case ContactRule::look_ahead:
      break;
  }
  return std::make_unique<LookAheadOnPoints>(parameters, tool);
}

void take_report(const ToolMotionReport& report, Vec3& normal_W, RenderOutput& out) {
  assert(out.tool);
  constexpr double kNoDirection = 1e-9;  // a sum of normals that cancel each other
  if (!report.push_W.isZero(0))
    normal_W = report.push_W.normalized();
  else if (report.touch_W.norm() > kNoDirection)
    normal_W = report.touch_W.normalized();
  out.steps = report.steps;
  out.converged = report.at_rest;
  out.tool->active_constraints = report.active_count;
  out.tool->detections = report.detections;
  out.tool->budget_exhausted = !report.at_rest;
}

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
