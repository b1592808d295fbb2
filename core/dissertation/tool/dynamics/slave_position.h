// The commanded position of a slave robot with a tool, 5.2. Its orientation is that of the same pose.
#pragma once

#include <limits>
#include <optional>

#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "core/dissertation/tool/dynamics/tool_pose.h"

namespace remote_touch {

class SlavePosition {
 public:
  explicit SlavePosition(SlaveCommand rule) : rule_(rule) {}
  // Returns the tool's position for SlaveCommand::rendered, and the device's for hip. If the device's pose is
  // not valid, hip repeats the last command; the result is NaN before the first one.
  // pre: the tool has been placed at a device pose.
  Vec3 command_W(const ToolPose& tool, const std::optional<ToolPose>& device) {
    if (rule_ == SlaveCommand::rendered) return tool.p_W;
    if (device) last_W_ = device->p_W;
    return last_W_;
  }

 private:
  const SlaveCommand rule_;
  Vec3 last_W_ = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

}  // namespace remote_touch
