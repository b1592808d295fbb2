#include "core/tool/motion/continuous_motion.h"

#include <algorithm>

namespace remote_touch {

ContinuousMotion::ContinuousMotion(const ToolParameters& parameters, const VoxelTool& tool)
    : near_(parameters, tool),
      step_m_(0.99 * near_.max_motion_m()),  // so that rounding does not shorten it
      // There and back, and then the motion itself.
      frame_reach_m_(std::min(parameters.frame_reach_m, step_m_ * (parameters.detections_per_tick / 3))),
      motion_(parameters, tool, tool.reach_m) {}

// Some contact is where it was, and none is in the tool.
bool ContinuousMotion::is_still_held(const NearContacts& near, const ToolPose& pose) const {
  if (near.deepest_m > ContinuousContacts::kGap_m) return false;
  const Vec3 push_T = pose.q_WT.conjugate() * push_W_;
  return std::any_of(near.contacts.begin(), near.contacts.end(), [&](const ToolContact& contact) {
    return contact.depth_m > -ContinuousContacts::kGap_m && contact.n_T.dot(push_T) > 0.5;
  });
}

double ContinuousMotion::translate(ToolPose& pose, double way_m, int& detections) {
  double done_m = 0;
  while (done_m < std::abs(way_m)) {
    const double step_m = std::min(step_m_, std::abs(way_m) - done_m);
    Vector6 a_g = Vector6::Zero();
    a_g.head<3>() = (way_m < 0 ? -step_m : step_m) * push_W_;
    near_.near(pose, 0);
    ++detections;
    const double clear =
        way_m > 0 ? near_.fraction_ahead(pose, a_g, motion_.side()) : near_.clear_fraction(pose, a_g);
    pose = moved(pose, clear * a_g);
    done_m += clear * step_m;
    if (clear < 1) break;
  }
  return done_m;
}

void ContinuousMotion::come_from_outside(ToolPose& pose, ToolMotionReport& report) {
  const Vec3 start_W = pose.p_W;
  ++report.detections;
  if (is_still_held(near_.near(pose, 0), pose)) return;
  const double out_m = translate(pose, frame_reach_m_, report.detections);
  const double back_m = translate(pose, -out_m, report.detections);
  if (back_m >= out_m) pose.p_W = start_W;  // to the last bit
  report.first_step_m = pose.p_W - start_W;
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
