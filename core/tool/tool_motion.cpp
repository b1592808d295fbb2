#include "core/tool/tool_motion.h"

#include "core/tool/look_ahead_motion.h"
#include "core/tool/voxel_motion.h"

namespace remote_touch {

std::unique_ptr<ToolMotion> make_tool_motion(const ToolParameters& parameters, const VoxelTool& tool) {
  if (parameters.contact_rule == TouchRule::voxels) return std::make_unique<VoxelMotion>(parameters, tool);
  return std::make_unique<LookAheadMotion>(parameters, tool);
}

}  // namespace remote_touch
