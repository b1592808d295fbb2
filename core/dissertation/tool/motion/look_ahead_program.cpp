#include "core/dissertation/tool/motion/look_ahead_program.h"

#include <algorithm>
#include <limits>

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

}  // namespace remote_touch
