// The continuous rule: the look-ahead rule, with steps that end before the first point would enter the tool.
// So no point that is outside a closed tool enters it between two frames (continuous_contacts.h).
//
// A new frame can put its points anywhere, also into the tool or past it. If points held the tool before the
// frame, the tool is first moved out, in the direction in which they pushed it. It stops at the first
// position where no point is in it and a surface is close on the side that held it. Then it moves back until
// the first point stops it. So it stays on its side of the surface, however thin the surface is, if the
// surface moved by less than frame_reach_m.
//
// The tool is not moved out if a surface on the other side is nearer, or if a surface that faces the tool is
// in the way. Points that are still in the tool are then treated as in the look-ahead rule, and it is not
// certain that the tool passes no points in that tick. Not in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/tool/contact/continuous_contacts.h"
#include "core/dissertation/tool/motion/look_ahead_motion.h"

namespace remote_touch {

class ContinuousMotion final : public ToolMotion {
 public:
  // tool: made with outer_field; it has to outlive this.
  ContinuousMotion(const ToolParameters& parameters, const VoxelTool& tool);
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

  // Returns the longest distance by which a held tool is moved out: frame_reach_m, or less if the budget of
  // detections is small.
  double frame_reach_m() const { return frame_reach_m_; }

 private:
  std::optional<NearContacts> contacts_if_clear(const ToolPose& pose);
  bool is_supported(const ToolPose& pose);
  double leave(ToolPose& pose, int& detections);
  double approach(ToolPose& pose, double distance_m, int& detections);
  void come_from_outside(ToolPose& pose, ToolMotionReport& report);

  ContinuousContacts near_;
  const double step_m_, frame_reach_m_;
  LookAheadMotion motion_;
  Vec3 push_W_ =
      Vec3::Zero();  // direction in which points held the tool at the end of the last tick, or zero
};

}  // namespace remote_touch
