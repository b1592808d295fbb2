#include "core/dissertation/tool_motion/god_object_motion.h"

#include <algorithm>

#include "core/dissertation/tool_motion/tool_motion.h"

namespace remote_touch {

namespace {

// A contact counts as touched if its distance exceeds the gap by no more than this.
constexpr double kTouching_m = 1e-6;
// A contact at which more than this distance is missing was put there by a frame.
constexpr double kTolerance_m = 2 * ContinuousContacts::kGap_m;
// A tick ends after this number of successive steps without progress, or of steps that contacts stop at once.
constexpr int kGodObjectPatience = 8;

}  // namespace

Parameters parameters(ToolGodObjectParameters& p) {
  const Parameters own = {
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each up to the first new contact; a tick that needs more sets budget_exhausted"},
      {"max_step_m", &p.max_step_m, 1e-5, 2e-3, "maximum displacement of any point of the tool in a step"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
      {"disk_radius_ratio", &p.disk_radius_ratio, 0, 2,
       "each point is a disk, a small face of the scene; its radius is this value times the point spacing; 0: points only"},
  };
  return appended(own, parameters(p.coupling));
}

std::string validate(const ToolGodObjectParameters& p) {
  if (10 * p.rest_threshold_m > p.max_step_m)
    return "rest_threshold_m = " + std::to_string(p.rest_threshold_m) +
           ": expected a tenth of max_step_m or less";
  return {};
}

ToolParameters tool_parameters(const ToolGodObjectParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::continuous;  // disks are counted
  tool.max_step_m = p.max_step_m;
  tool.rest_threshold_m = p.rest_threshold_m;
  tool.disk_radius_ratio = p.disk_radius_ratio;
  return tool;
}

GodObjectMotion::GodObjectMotion(const ToolGodObjectParameters& parameters, const VoxelTool& tool)
    : p_(parameters),
      reach_m_(tool.reach_m),
      max_step_m_(parameters.max_step_m),
      near_(tool_parameters(parameters), tool),
      program_(even_inertia_m2(parameters.coupling.gyration_radius_m)) {
  touched_.reserve(static_cast<std::size_t>(MotionProgram::kMaxContacts));
}

void GodObjectMotion::gather_touched(const NearContacts& near) {
  touched_.clear();
  for (ToolContact contact : near.contacts) {
    if (contact.depth_m < -kTouching_m) continue;
    if (settling_ || contact.depth_m > kTolerance_m) contact.depth_m = 0;
    touched_.push_back(contact);
  }
}

Vector6 GodObjectMotion::constrained(const Vector6& a_gu, const ToolPose& pose, ToolMotionReport& report) {
  report.active_count = 0, report.push_W.setZero();
  has_failed_ = false;
  if (touched_.empty()) return a_gu;
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  ConstrainedMotion motion = program_.solve(desired_T, touched_);
  if (motion.is_relaxed) {  // two walls leave no room for the gap; J a >= 0 is always feasible, with a = 0
    for (ToolContact& contact : touched_) contact.depth_m = 0;
    motion = program_.solve(desired_T, touched_);
  }
  has_failed_ = motion.failed;
  report.active_count = motion.active_count;
  report.push_W = pose.q_WT * motion.push_T;
  if (!settling_ && motion.side != 0) side_ = motion.side > 0 ? 1 : -1;
  return rotated(pose.q_WT, motion.a_g);
}

// The new contact can be with a disk or with a point.
double GodObjectMotion::free_fraction(const Vector6& a_c, const ToolPose& pose, const NearContacts& near) {
  const Vector6 a_T = rotated(pose.q_WT.conjugate(), a_c);
  const Vec3 shift_T = a_T.head<3>(), turn_T = a_T.tail<3>();
  double free = near_.clear_fraction(pose, a_c);
  for (const ToolContact& contact : near.contacts) {
    if (contact.depth_m >= -kTouching_m) continue;
    const double approach_m = -contact.n_T.dot(shift_T) - contact.r_T.cross(contact.n_T).dot(turn_T);
    if (approach_m > -contact.depth_m) free = std::min(free, -contact.depth_m / approach_m);
  }
  return free;
}

ToolMotionReport GodObjectMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                       bool updated) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  MotionProgress progress(p_.rest_threshold_m, kGodObjectPatience);
  int stopped = 0;
  bool is_stopped = false;  // a new contact ended the last step
  near_.begin(contacts);
  settling_ |= updated;
  while (true) {
    const NearContacts near = near_.near(pose, settling_ ? side_ : 0);
    ++report.detections;
    if (near.deepest_m <= kTolerance_m) settling_ = false;
    if (near.contacts.empty()) side_ = 1;  // the tool has left the surface that held it
    gather_touched(near);
    const Vector6 a_gu = displacement(pose, device);
    // An error of second order can end the touch of the contact that ended the last step. It holds the tool
    // all the same, so the report stays.
    const bool is_off = is_stopped && touched_.empty();
    const Vector6 a_c = is_off ? a_gu : constrained(a_gu, pose, report);
    report.allowed_W = a_c;
    progress.update(max_point_displacement_m(a_gu, reach_m_));
    const bool stops = max_point_displacement_m(a_c, reach_m_) <= p_.rest_threshold_m ||
                       progress.has_ended() || stopped >= kGodObjectPatience;
    report.at_rest = stops && !has_failed_;
    if (stops || report.steps >= p_.steps_per_tick) break;
    const Vector6 step = capped(a_c, reach_m_, max_step_m_);
    const double free = free_fraction(step, pose, near);
    is_stopped = free < 1;
    stopped = free * max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m ? stopped + 1 : 0;
    pose = free == 1 && step == a_gu ? device : moved(pose, free * step);
    ++report.steps;
    if (report.steps == 1) report.first_step_m = pose.p_W - start_W;
  }
  if (report.at_rest) report.allowed_W.setZero();  // contacts prevent all that is left
  return report;
}

}  // namespace remote_touch
