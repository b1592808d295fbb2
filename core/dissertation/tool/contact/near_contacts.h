// The contacts that the look-ahead rule needs from a scene: everything that the tool could touch soon.
#pragma once

#include <limits>
#include <span>

#include "core/dissertation/tool/dynamics/motion_program.h"

namespace remote_touch {

struct NearContacts {
  std::span<const ToolContact> contacts;
  double deepest_m = 0;  // largest depth, negative if nothing is touched; -infinity: nothing was found
  // Every contact within this distance is listed, unless it was left out because there were too many;
  // infinity: every contact within the look-ahead.
  double within_m = std::numeric_limits<double>::infinity();
};

// The interface between the look-ahead rule and the source of contacts: the points of a surface, or regions.
class NearContactSource {
 public:
  virtual ~NearContactSource() = default;
  // Returns the contacts of a pose within within_m. It may return more, but none beyond the look-ahead, and
  // no more than MotionProgram::kMaxContacts. side: +1 or -1, the side of the surface that the tool was on
  // before a frame put points into it; 0: not known. Valid until the next call.
  virtual NearContacts near(const ToolPose& pose, double side, double within_m) = 0;
  // Returns all contacts within the look-ahead.
  NearContacts near(const ToolPose& pose, double side) {
    return near(pose, side, std::numeric_limits<double>::infinity());
  }
  // Returns the fraction of a motion from this pose that the tool may make. A source that cannot check this
  // returns 1.
  virtual double clear_fraction(const ToolPose&, const Vector6&) { return 1; }
};

}  // namespace remote_touch
