// The look-ahead rule: every point near the tool is a constraint with its signed distance. So the same
// program slows the tool down before it touches a surface, lets it slide along the surface, and pushes it out
// if it is inside. Not in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"

namespace remote_touch {

// One detection of the look-ahead rule: the contacts of a pose, and the motion that they allow.
//
// A contact cannot limit a motion that moves every point of the tool by less than the distance of the
// contact. So the nearest contacts are queried first, and farther ones only if the motion is longer. The
// result is still the motion that all contacts within the look-ahead allow. Not in the dissertation.
class LookAheadProgram {
 public:
  // A contact deeper than this is a collision. A smaller depth is the error of a linear constraint on a
  // curved surface.
  static constexpr double kCollision_m = 1e-4;
  static constexpr double kMinFirst_m = 1.5e-4;  // smallest distance that is queried

  struct Detection {
    // All contacts nearer than kMinFirst_m, and farther ones up to the distance that was queried. Empty: no
    // contact is within the look-ahead.
    NearContacts near;
    // The admissible motion, world axes. If there are no contacts, it is the motion towards the device,
    // limited to the look-ahead.
    Vector6 a_g = Vector6::Zero();
    ConstrainedMotion motion;  // a_g in tool axes, and the contacts that hold it; zero if there are none
  };

  // reach_m: distance of the farthest point of the tool from its centre of mass, for the source of contacts.
  LookAheadProgram(const ToolParameters& parameters, const VoxelTool& tool, double reach_m)
      : look_ahead_m_(parameters.look_ahead_m),
        reach_m_(reach_m),
        // A contact can be anywhere in the grid of the field.
        contact_reach_m_(reach_m + kFieldMargin_m + 3 * tool.grid.size_m),
        program_(parameters, tool) {}

  // Returns the contacts and the motion: out of a collision, (6.7), else towards the device, (6.4). a_gu: the
  // motion to the device, world axes. side: as for near(). The list of contacts is valid until the next query
  // of the source. The motion does not depend on earlier calls, up to rounding, unless contacts were left out
  // because there were too many.
  Detection detect(const ToolPose& pose, const Vector6& a_gu, NearContactSource& source, double side);

 private:
  void solve(const ToolPose& pose, const Vector6& a_gu, Detection& detection);

  const double look_ahead_m_, reach_m_, contact_reach_m_;
  MotionProgram program_;
  double first_m_ = kMinFirst_m;  // distance that the next call queries first
};

class LookAheadMotion {
 public:
  // reach_m: distance of the farthest point of the tool from its centre of mass, as the source of contacts
  // defines the tool.
  LookAheadMotion(const ToolParameters& parameters, const VoxelTool& tool, double reach_m)
      : p_(parameters), reach_m_(reach_m), program_(parameters, tool, reach_m) {}
  // Does the same as ToolMotion::move(). detections: number of detections that the tick has already made.
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, NearContactSource& source, bool updated,
                        int detections = 0);

  // Returns the side of the surface that held the tool last: +1 is the side of the sensor.
  double side() const { return side_; }

 private:
  Vector6 step_of(const LookAheadProgram::Detection& detection, const ToolPose& pose,
                  ToolMotionReport& report);

  const ToolParameters p_;
  const double reach_m_;
  LookAheadProgram program_;
  double side_ = 1;
  bool settling_ = false;  // a frame came, and the tool is still in its points
};

// The continuous rule: the look-ahead rule, with steps that end before the first point would enter the tool.
// So no point that is outside a closed tool enters it between two frames (contact_list.h).
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
