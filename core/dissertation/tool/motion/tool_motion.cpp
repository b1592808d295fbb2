#include "core/dissertation/tool/motion/tool_motion.h"

#include "core/dissertation/tool/motion/continuous_motion.h"
#include "core/dissertation/tool/motion/look_ahead_motion.h"
#include "core/dissertation/tool/motion/voxel_motion.h"

namespace remote_touch {

namespace {

class LookAheadOnPoints final : public ToolMotion {
 public:
  LookAheadOnPoints(const ToolParameters& parameters, const VoxelTool& tool)
      : motion_(parameters, tool, tool.reach_m) {}
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                        bool updated) override {
    return motion_.move(pose, device, contacts, updated);
  }

 private:
  LookAheadMotion motion_;
};

}  // namespace

std::unique_ptr<ToolMotion> make_tool_motion(const ToolParameters& parameters, const VoxelTool& tool) {
  switch (parameters.contact_rule) {
    case ContactRule::voxels:
      return std::make_unique<VoxelMotion>(parameters, tool);
    case ContactRule::continuous:
      return std::make_unique<ContinuousMotion>(parameters, tool);
    case ContactRule::look_ahead:
      break;
  }
  return std::make_unique<LookAheadOnPoints>(parameters, tool);
}

void take_report(const ToolMotionReport& report, Vec3& normal_W, RenderOutput& out) {
  constexpr double kNoDirection = 1e-9;  // a sum of normals that cancel each other
  if (!report.push_W.isZero(0))
    normal_W = report.push_W.normalized();
  else if (report.touch_W.norm() > kNoDirection)
    normal_W = report.touch_W.normalized();
  out.steps = report.steps;
  out.converged = report.at_rest;
  out.tool->active_constraints = report.active_count;
  out.tool->detections = report.detections;
  out.tool->budget_exhausted = !report.at_rest;
}

}  // namespace remote_touch
