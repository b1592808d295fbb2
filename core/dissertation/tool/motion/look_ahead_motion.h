// The look-ahead rule: every point near the tool is a constraint with its signed distance. So the same
// program slows the tool down before it touches a surface, lets it slide along the surface, and pushes it out
// if it is inside. Not in the dissertation.
#pragma once

#include "core/dissertation/tool/motion/look_ahead_program.h"
#include "core/dissertation/tool/motion/tool_motion.h"

namespace remote_touch {

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

}  // namespace remote_touch
