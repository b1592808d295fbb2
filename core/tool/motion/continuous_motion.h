// The continuous rule: the look-ahead rule, with no step longer than until the first point would get into the
// tool. Between two frames no point gets into it (clear_way.h).
//
// A frame puts its points anywhere, also into the tool or past it. So a tool that points held goes back
// first, along the direction in which they pushed it, and comes to where it was until the first point stops
// it: it ends on the side on which it was held, however thin it is, if the points moved no farther than
// frame_reach_m. Between walls that close on it, it stays. Not in the dissertation.
#pragma once

#include "core/tool/contact/continuous_contacts.h"
#include "core/tool/motion/look_ahead_motion.h"

namespace remote_touch {

class ContinuousMotion final : public ToolMotion {
 public:
  // tool: made with outer_field; it has to outlive this.
  ContinuousMotion(const ToolParameters& parameters, const VoxelTool& tool);
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  bool is_still_held(const NearContacts& near, const ToolPose& pose) const;
  // Along the direction of contact, positive away from the points; until a point stops it. Returns how far.
  double translate(ToolPose& pose, double way_m, int& detections);
  void come_from_outside(ToolPose& pose, ToolMotionReport& report);

  ContinuousContacts near_;
  const double step_m_, frame_reach_m_;
  LookAheadMotion motion_;
  Vec3 push_W_ =
      Vec3::Zero();  // direction in which points held the tool at the end of the last tick, or zero
};

}  // namespace remote_touch
