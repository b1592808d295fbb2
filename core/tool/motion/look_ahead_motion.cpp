#include "core/tool/motion/look_ahead_motion.h"

#include <algorithm>

#include "core/tool/motion/progress.h"

namespace remote_touch {

namespace {

// Deeper than this the tool is in a collision; less is what a linear constraint leaves on a bent surface.
constexpr double kCollision_m = 1e-4;

// Looks without progress that end a tick: on noisy surfaces the tool can go to and fro by a hair for ever.
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

// The admissible step in world axes, and what held it: out of a collision, (6.7), else towards the device,
// (6.4). In a wedge no motion leads out of all; the tool then follows the device as far as it may.
Vector6 LookAheadMotion::step_towards(const Vector6& a_gu, const ToolPose& pose, const NearContacts& near,
                                      ToolMotionReport& report) {
  if (near.contacts.empty()) {
    report.active_count = 0, report.push_W.setZero();
    return capped(a_gu, reach_m_, p_.look_ahead_m);
  }
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  const bool collides = near.deepest_m > kCollision_m;
  ConstrainedMotion motion = program_.solve(collides ? Vector6(Vector6::Zero()) : desired_T, near.contacts);
  if (collides && motion.elastic) motion = program_.solve(desired_T, near.contacts);
  report.active_count = motion.active_count;
  report.push_W = pose.q_WT * motion.push_T;
  if (!settling_ && motion.side != 0) side_ = motion.side > 0 ? 1 : -1;
  // Out of what a frame put deep into the tool steps of max_step_m would be many. A step may be as long
  // as the deepest place is deep: all within that distance of it is tool, so the place stays in the tool or
  // comes to its surface, and is not jumped over. What the step runs into beyond the look-ahead the next look
  // finds.
  const double max_m = std::max(p_.max_step_m, settling_ ? near.deepest_m : 0);
  return capped(rotated(pose.q_WT, motion.a_g), reach_m_, max_m);
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
  int stopped = 0;  // looks in a row after which the tool could not move
  while (true) {
    const NearContacts near = source.near(pose, settling_ ? side_ : 0);
    ++report.detections;
    if (near.deepest_m <= kCollision_m) settling_ = false;
    if (near.contacts.empty()) side_ = 1;  // what held the tool is left behind
    if (report.detections == detections + 1) first = state_of(near);
    same_state = same_state && state_of(near) == first;

    report.touch_W = pose.q_WT * touched_direction(near);
    const Vector6 a_gu = displacement(pose, device);
    const double remaining_m = max_point_displacement_m(a_gu, reach_m_);
    if (near.contacts.empty() && remaining_m <= p_.look_ahead_m && source.clear_fraction(pose, a_gu) == 1) {
      // Nothing is as near as the device.
      report.steps += pose == device ? 0 : 1;
      pose = device;
      if (same_state) report.first_step_m = pose.p_W - start_W;
      report.active_count = 0, report.push_W.setZero();
      report.at_rest = true;
      return report;
    }
    const Vector6 a_g = step_towards(a_gu, pose, near, report);
    progress.update(remaining_m);
    report.at_rest = max_point_displacement_m(a_g, reach_m_) <= p_.rest_threshold_m ||
                     (near.deepest_m <= kCollision_m && progress.has_ended()) ||
                     stopped >= kLookAheadPatience;
    if (report.at_rest || report.detections >= p_.detections_per_tick) break;
    // What a frame put into the tool is left first.
    const double clear = settling_ && updated ? 1 : source.clear_fraction(pose, a_g);
    stopped = clear * max_point_displacement_m(a_g, reach_m_) <= p_.rest_threshold_m ? stopped + 1 : 0;
    pose = clear == 1 && a_g == a_gu ? device : moved(pose, clear * a_g);
    ++report.steps;
    if (same_state) report.first_step_m = pose.p_W - start_W;  // with the step that ends the first state
  }
  return report;
}

}  // namespace remote_touch
