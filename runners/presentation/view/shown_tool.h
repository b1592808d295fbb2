// The tool of a run, as a page shows it.
#pragma once

#include <memory>

#include "core/dissertation/sphere_tree/tool_spheres.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "runners/presentation/view/packed_arrays.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

struct ShownTool {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const ToolSpheres> spheres;  // null: its renderer has none
};

// renderer: the section of a resolved configuration, of a renderer with a tool. Throws as load_tool().
ShownTool shown_tool(const Json& renderer);

// Vertices and triangles of the mesh; of spheres, four numbers each: centre and radius.
Json json_of(const ShownTool& tool, PackedArrays& numbers);

}  // namespace remote_touch
