#include "core/dissertation/tool/motion/look_ahead_motion.h"

#include <algorithm>

#include "core/dissertation/tool/motion/progress.h"

namespace remote_touch {

namespace {

constexpr double kCollision_m = LookAheadProgram::kCollision_m;

// A tick ends after this number of successive detections without progress. Otherwise the tool could move back
// and forth by tiny steps forever on a noisy surface.
constexpr int kLookAheadPatience = 8;

ContactState state_of(const NearContacts& near) {
  if (near.deepest_m > kCollision_m) return ContactState::entrenched;
  return near.deepest_m > -kCollision_m ? ContactState::contact : ContactState::free;
}

Vec3 touched_direction(const NearContacts& near) {
  Vec3 sum_T = Vec3::Zero();
  for (const ToolContact& contact : near.contacts)
    if (contact.depth_m > -kCollision_m) sum_T += contact.n_T;
  return sum_T;
}

}  // namespace

// Returns the step that one detection allows, and reports the contacts that hold it. A step is normally
// limited to max_step_m. Points that a frame put deep into the tool would then need many steps, so a step may
// also be as long as the deepest position is deep. No position is jumped over: everything within that
// distance of the deepest position is tool, so this position stays in the tool or comes to its surface. If
// the step runs into something beyond the look-ahead, the next detection finds it.
Vector6 LookAheadMotion::step_of(const LookAheadProgram::Detection& detection, const ToolPose& pose,
                                 ToolMotionReport& report) {
  report.active_count = detection.motion.active_count;
  report.push_W = pose.q_WT * detection.motion.push_T;
  if (detection.near.contacts.empty()) return detection.a_g;
  if (!settling_ && detection.motion.side != 0) side_ = detection.motion.side > 0 ? 1 : -1;
  return capped(detection.a_g, reach_m_, std::max(p_.max_step_m, settling_ ? detection.near.deepest_m : 0));
}

ToolMotionReport LookAheadMotion::move(ToolPose& pose, const ToolPose& device, NearContactSource& source,
                                       bool updated, int detections) {
  ToolMotionReport report;
  report.detections = detections;
  const Vec3 start_W = pose.p_W;
  bool same_state = true;
  ContactState first = ContactState::free;
  settling_ |= updated;
  MotionProgress progress(p_.rest_threshold_m, kLookAheadPatience);
  int stopped = 0;  // successive detections after which the tool could not move
  while (true) {
    const Vector6 a_gu = displacement(pose, device);
    const LookAheadProgram::Detection detection = program_.detect(pose, a_gu, source, settling_ ? side_ : 0);
    const NearContacts& near = detection.near;
    ++report.detections;
    if (near.deepest_m <= kCollision_m) settling_ = false;
    if (near.contacts.empty()) side_ = 1;  // the tool has left the surface that held it
    if (report.detections == detections + 1) first = state_of(near);
    same_state = same_state && state_of(near) == first;

    report.touch_W = pose.q_WT * touched_direction(near);
    const double remaining_m = max_point_displacement_m(a_gu, reach_m_);
    if (near.contacts.empty() && remaining_m <= p_.look_ahead_m && source.clear_fraction(pose, a_gu) == 1) {
      // No contact is as near as the device.
      report.steps += pose == device ? 0 : 1;
      pose = device;
      if (same_state) report.first_step_m = pose.p_W - start_W;
      report.active_count = 0, report.push_W.setZero();
      report.at_rest = true;
      return report;
    }
    const Vector6 a_g = step_of(detection, pose, report);
    progress.update(remaining_m);
    const bool stops = max_point_displacement_m(a_g, reach_m_) <= p_.rest_threshold_m ||
                       (near.deepest_m <= kCollision_m && progress.has_ended()) ||
                       stopped >= kLookAheadPatience;
    report.at_rest = stops && !detection.motion.failed;
    if (stops || report.detections >= p_.detections_per_tick) break;
    // Points that a frame put into the tool do not stop it in this tick, because it has to leave them first.
    const double clear = settling_ && updated ? 1 : source.clear_fraction(pose, a_g);
    stopped = clear * max_point_displacement_m(a_g, reach_m_) <= p_.rest_threshold_m ? stopped + 1 : 0;
    pose = clear == 1 && a_g == a_gu ? device : moved(pose, clear * a_g);
    ++report.steps;
    if (same_state) report.first_step_m = pose.p_W - start_W;  // includes the step that ends the first state
  }
  return report;
}

}  // namespace remote_touch
