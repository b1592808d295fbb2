#include "core/dissertation/tool_motion/tool_motion.h"

#include <cmath>

#include "core/dissertation/tool_motion/look_ahead_motion.h"

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

}  // namespace remote_touch
