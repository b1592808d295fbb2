// The tool that an experiment names: a built-in one or a mesh file, made once and then read from the cache.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/sphere_tree/tool_spheres.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/parameters/parameter.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

struct ToolSettings {
  std::string mesh = "husky";
  double size_m = 0;
  double voxel_m = 5e-4;
  bool repair = false;
  bool outer_field = false;  // no parameter: a renderer that needs it sets it
};

Parameters parameters(ToolSettings& settings);  // tool_mesh, tool_size_m, tool_voxel_m, tool_repair
std::string validate(const ToolSettings& settings);

// Returns the mesh file on which the result depends; none for a built-in tool.
std::vector<RecordingPart> input_files(const ToolSettings& settings);

// Returns the tool. A mesh file is searched for like a recording, see find_recording(). A built-in tool takes
// precedence over a file of its name. Throws MissingRecording if there is neither, InputError as read_mesh()
// and make_voxel_tool() do. report: receives text(ToolReport) of the time when the tool was made; may be
// null.
std::shared_ptr<const VoxelTool> load_tool(const ToolSettings& settings, std::string* report = nullptr);

// The same tool with its sphere tree. The tree is made once for each number of leaves, and stored in the
// cache beside the tool.
struct ToolOfSpheres {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const ToolSpheres> spheres;
};
ToolOfSpheres load_tool_of_spheres(const ToolSettings& settings, int max_leaves,
                                   std::string* report = nullptr);

}  // namespace remote_touch
