#include "core/dissertation/tool/motion/continuous_motion.h"

#include <algorithm>

namespace remote_touch {

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
