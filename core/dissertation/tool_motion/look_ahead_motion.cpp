#include "core/dissertation/tool_motion/look_ahead_motion.h"

#include <algorithm>
#include <limits>

#include "core/dissertation/tool_motion/tool_renderer.h"

namespace remote_touch {
namespace {

constexpr double kAll_m = std::numeric_limits<double>::infinity();
constexpr double kSpare = 1.25;  // the next motion can be somewhat longer than the last

}  // namespace

static_assert(LookAheadProgram::kMinFirst_m > LookAheadProgram::kCollision_m, "every collision is seen");

// Computes the motion from the contacts in `detection`. A wedge allows no motion that leads out of all of
// them. Then the tool follows the device as far as they allow.
void LookAheadProgram::solve(const ToolPose& pose, const Vector6& a_gu, Detection& detection) {
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  const bool collides = detection.near.deepest_m > kCollision_m;
  detection.motion = program_.solve(collides ? Vector6(Vector6::Zero()) : desired_T, detection.near.contacts);
  if (collides && detection.motion.is_relaxed)
    detection.motion = program_.solve(desired_T, detection.near.contacts);
  detection.a_g = rotated(pose.q_WT, detection.motion.a_g);
}

LookAheadProgram::Detection LookAheadProgram::detect(const ToolPose& pose, const Vector6& a_gu,
                                                     NearContactSource& source, double side) {
  Detection detection;
  for (double within_m = first_m_;;) {
    detection.near = source.near(pose, side, within_m);
    const bool is_all = detection.near.within_m == kAll_m;
    if (detection.near.contacts.empty()) {
      within_m = first_m_ = kAll_m;
      if (!is_all) continue;
      detection.a_g = capped(a_gu, reach_m_, look_ahead_m_);
      return detection;
    }
    solve(pose, a_gu, detection);
    const double motion_m = max_point_displacement_m(detection.a_g, contact_reach_m_);
    first_m_ = std::max(kMinFirst_m, kSpare * motion_m);
    if (is_all || motion_m < detection.near.within_m) return detection;
    within_m = std::max(first_m_, 2 * within_m);
  }
}

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

namespace {

constexpr double kNotFound_m = -1;

// Returns the maximum number of steps out. It leaves detections for a check of the other direction, the way
// back and the motion itself.
int max_steps(int detections_per_tick) {
  return std::max(0, (detections_per_tick - 4) / 3);
}

Vector6 translation(const Vec3& by_W) {
  Vector6 a_g = Vector6::Zero();
  a_g.head<3>() = by_W;
  return a_g;
}

}  // namespace

ContinuousMotion::ContinuousMotion(const ToolParameters& parameters, const VoxelTool& tool)
    : near_(parameters, tool),
      step_m_(0.99 * near_.max_motion_m()),  // so that rounding does not shorten it
      frame_reach_m_(std::min(parameters.frame_reach_m, step_m_ * max_steps(parameters.detections_per_tick))),
      motion_(parameters, tool, tool.reach_m) {}

// Returns the contacts of a pose if no point is in the tool. Points are checked first, because that takes
// less time than contacts if there is one.
std::optional<NearContacts> ContinuousMotion::contacts_if_clear(const ToolPose& pose) {
  if (near_.has_points_inside(pose)) return {};
  const NearContacts near = near_.near(pose, 0);
  return near.deepest_m <= ContinuousContacts::kGap_m ? std::optional(near) : std::nullopt;
}

// True if a surface is close on the side that held the tool, and no point is in the tool.
bool ContinuousMotion::is_supported(const ToolPose& pose) {
  const Vec3 push_T = pose.q_WT.conjugate() * push_W_;
  const std::optional<NearContacts> near = contacts_if_clear(pose);
  return near && std::any_of(near->contacts.begin(), near->contacts.end(),
                             [&](const auto& contact) { return contact.n_T.dot(push_T) > 0.5; });
}

// Moves the pose out to the first position that is supported. Returns the distance, or kNotFound_m if there
// is none.
double ContinuousMotion::leave(ToolPose& pose, int& detections) {
  for (double done_m = 0;;) {
    ++detections;
    if (is_supported(pose)) return done_m;
    const double step_m = std::min(step_m_, frame_reach_m_ - done_m);
    const Vector6 a_g = translation(step_m * push_W_);
    if (!(step_m > 0) || near_.fraction_ahead(pose, a_g, motion_.side()) < 1) return kNotFound_m;
    pose = moved(pose, a_g);
    done_m += step_m;
  }
}

// Moves the pose by up to distance_m towards the points that held the tool, until one stops it. Returns the
// distance.
double ContinuousMotion::approach(ToolPose& pose, double distance_m, int& detections) {
  double done_m = 0;
  while (done_m < distance_m) {
    const double step_m = std::min(step_m_, distance_m - done_m);
    const Vector6 a_g = translation(-step_m * push_W_);
    ++detections;
    const double clear = near_.clear_fraction(pose, a_g);
    pose = moved(pose, clear * a_g);
    done_m += clear * step_m;
    if (clear < 1) break;
  }
  return done_m;
}

void ContinuousMotion::come_from_outside(ToolPose& pose, ToolMotionReport& report) {
  ToolPose outside = pose;
  const double out_m = leave(outside, report.detections);
  if (out_m <= 0) return;
  // If no point is in the tool, the surface has left it. It may have moved away from the tool, so that
  // direction is checked as well.
  if (contacts_if_clear(pose)) {
    ToolPose ahead = pose;
    if (approach(ahead, out_m, report.detections) < out_m) return;
  }
  approach(outside, out_m, report.detections);
  report.first_step_m = outside.p_W - pose.p_W;
  pose = outside;
}

ToolMotionReport ContinuousMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                        bool updated) {
  near_.begin(contacts);
  ToolMotionReport before;
  if (updated && !push_W_.isZero(0) && frame_reach_m_ > 0) come_from_outside(pose, before);
  near_.begin(contacts);
  ToolMotionReport report = motion_.move(pose, device, near_, updated, before.detections);
  if (!before.first_step_m.isZero(0)) report.first_step_m = before.first_step_m;
  push_W_ = report.active_count > 0 && !report.push_W.isZero(0) ? report.push_W.normalized() : Vec3::Zero();
  return report;
}

}  // namespace remote_touch
