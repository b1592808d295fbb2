// One detection of the look-ahead rule: the contacts of a pose, and the motion that they allow.
//
// A contact cannot limit a motion that moves every point of the tool by less than the distance of the
// contact. So the nearest contacts are queried first, and farther ones only if the motion is longer. The
// result is still the motion that all contacts within the look-ahead allow. Not in the dissertation.
#pragma once

#include "core/dissertation/tool/contact/contact_list.h"

namespace remote_touch {

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

}  // namespace remote_touch
