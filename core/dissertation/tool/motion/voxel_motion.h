// The rule as printed, 6.2.3 to 6.2.5. Points in shell voxels are contacts, and points in interior voxels are
// collisions. The tool moves in sub-steps of half a voxel so that no contact is missed.
#pragma once

#include "core/dissertation/tool/motion/tool_motion.h"

namespace remote_touch {

class VoxelMotion final : public ToolMotion {
 public:
  VoxelMotion(const ToolParameters& parameters, const VoxelTool& tool)
      : p_(parameters),
        reach_m_(tool.reach_m),
        sub_step_m_(0.5 * tool.grid.size_m),
        program_(parameters, tool) {}
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  struct PoseQuery {  // state and contacts of a pose
    ContactState state = ContactState::free;
    std::span<const ToolContact> contacts;
  };
  PoseQuery query(const ToolPose& pose, ContactList& contacts, ToolMotionReport& report) const;
  struct DesiredStep {
    Vector6 a_g;
    bool trapped = false;  // no motion leads out of all collisions
    bool failed = false;   // ConstrainedMotion::failed
  };
  DesiredStep desired_step(const ToolPose& pose, const Vector6& a_gu, const PoseQuery& here,
                           ToolMotionReport& report);
  bool advance(ToolPose& pose, PoseQuery& here, const Vector6& a_g, const ToolPose* goal,
               ContactList& contacts, ToolMotionReport& report) const;
  bool spent(const ToolMotionReport& report) const { return report.detections >= p_.detections_per_tick; }

  const ToolParameters p_;
  const double reach_m_, sub_step_m_;
  MotionProgram program_;
};

}  // namespace remote_touch
