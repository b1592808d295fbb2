#include "core/tool/motion/tool_motion.h"

#include "core/tool/motion/look_ahead_motion.h"
#include "core/tool/motion/voxel_motion.h"

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
  if (parameters.contact_rule == TouchRule::voxels) return std::make_unique<VoxelMotion>(parameters, tool);
  return std::make_unique<LookAheadOnPoints>(parameters, tool);
}

}  // namespace remote_touch
