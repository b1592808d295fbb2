// One look of the look-ahead rule: the contacts of a pose, and the motion that they allow.
//
// A contact that is farther away than the motion takes any place of the tool cannot limit that motion. So the
// nearest contacts are asked for first, and farther ones only where the motion is longer: the motion is still
// the one that all contacts within the look-ahead allow. Not in the dissertation.
#pragma once

#include "core/tool/contact/near_contacts.h"

namespace remote_touch {

class LookAheadProgram {
 public:
  // Deeper than this the tool is in a collision; less is what a linear constraint leaves on a bent surface.
  static constexpr double kCollision_m = 1e-4;
  static constexpr double kMinFirst_m = 1.5e-4;  // nothing less is asked for

  struct Look {
    // Contacts nearer than kMinFirst_m, and of those farther away what was asked for. None: nothing is within
    // the look-ahead.
    NearContacts near;
    // The admissible motion, world axes; where nothing is near, towards the device by the look-ahead at most.
    Vector6 a_g = Vector6::Zero();
    ConstrainedMotion motion;  // the same in tool axes, and what held it; zero where nothing is near
  };

  // reach_m: of the farthest place of the tool from its centre of mass, as the source of contacts sees it.
  LookAheadProgram(const ToolParameters& parameters, const VoxelTool& tool, double reach_m)
      : look_ahead_m_(parameters.look_ahead_m),
        reach_m_(reach_m),
        // The place of a contact is where the field is known.
        contact_reach_m_(reach_m + kFieldMargin_m + 3 * tool.grid.size_m),
        program_(parameters, tool) {}

  // a_gu: the motion to the device, world axes. side: as for near(). Out of a collision, (6.7), else towards
  // the device, (6.4). Its list of contacts is valid until the source is asked again. While no contact is
  // left out because there are too many, the motion does not depend on earlier looks, up to rounding.
  Look look(const ToolPose& pose, const Vector6& a_gu, NearContactSource& source, double side);

 private:
  void solve(const ToolPose& pose, const Vector6& a_gu, Look& look);

  const double look_ahead_m_, reach_m_, contact_reach_m_;
  MotionProgram program_;
  double first_m_ = kMinFirst_m;  // what the next look asks for first
};

}  // namespace remote_touch
