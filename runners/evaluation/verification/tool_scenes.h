// The scenes in which renderers of a tool are checked.
#pragma once

#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/verification/metamorphic_scene.h"

namespace remote_touch {

// Returns scenes like verification_scenes(), with normals and a device that turns, for the tool
// kVerifiedTool. Points have regions in the scenes for renderers of regions.
std::vector<MetamorphicScene> tool_scenes(const Kernels& kernels);

// A bar of 80 x 20 x 10 mm, which is its own mirror image along every axis. Written as assignments. The
// voxels are coarse, because the tool is made or loaded for every check.
inline constexpr const char* kVerifiedTool[] = {"tool_mesh=bar", "tool_size_m=0.08", "tool_voxel_m=0.001"};

}  // namespace remote_touch
