#include "core/dissertation/tool/motion/look_ahead_program.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

namespace {

constexpr double kAll_m = std::numeric_limits<double>::infinity();
constexpr double kSpare = 1.25;  // the next motion can be somewhat longer than the last

}  // namespace

static_assert(LookAheadProgram::kMinFirst_m > LookAheadProgram::kCollision_m, "every collision is seen");

// Computes the motion from the contacts in `look`. A wedge allows no motion that leads out of all of them.
// Then the tool follows the device as far as they allow.
void LookAheadProgram::solve(const ToolPose& pose, const Vector6& a_gu, Look& look) {
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  const bool collides = look.near.deepest_m > kCollision_m;
  look.motion = program_.solve(collides ? Vector6(Vector6::Zero()) : desired_T, look.near.contacts);
  if (collides && look.motion.elastic) look.motion = program_.solve(desired_T, look.near.contacts);
  look.a_g = rotated(pose.q_WT, look.motion.a_g);
}

LookAheadProgram::Look LookAheadProgram::look(const ToolPose& pose, const Vector6& a_gu,
                                              NearContactSource& source, double side) {
  Look look;
  for (double within_m = first_m_;;) {
    look.near = source.near(pose, side, within_m);
    const bool is_all = look.near.within_m == kAll_m;
    if (look.near.contacts.empty()) {
      within_m = first_m_ = kAll_m;
      if (!is_all) continue;
      look.a_g = capped(a_gu, reach_m_, look_ahead_m_);
      return look;
    }
    solve(pose, a_gu, look);
    const double motion_m = max_point_displacement_m(look.a_g, contact_reach_m_);
    first_m_ = std::max(kMinFirst_m, kSpare * motion_m);
    if (is_all || motion_m < look.near.within_m) return look;
    within_m = std::max(first_m_, 2 * within_m);
  }
}

}  // namespace remote_touch
