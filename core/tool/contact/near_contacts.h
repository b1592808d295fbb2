// The input of the look-ahead rule: everything that the tool could touch soon.
#pragma once

#include <span>

#include "core/tool/dynamics/motion_program.h"

namespace remote_touch {

struct NearContacts {
  std::span<const ToolContact> contacts;
  double deepest_m = 0;  // largest depth, below 0 where nothing is touched; -infinity: nothing is near
};

// The interface between the look-ahead rule and what holds a tool: the points of a surface, or regions.
class NearContactSource {
 public:
  virtual ~NearContactSource() = default;
  // The contacts of a pose within the look-ahead, no more than the motion can take. side: +1 or -1 of the
  // surface that a frame put into the tool, where it is known; else 0. Valid until the next call.
  virtual NearContacts near(const ToolPose& pose, double side) = 0;
};

}  // namespace remote_touch
