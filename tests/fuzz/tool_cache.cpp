// Tools in the cache. A file that is read is sound, and is written as it was.
#include "runners/experiment/mesh_files/loaded_tool.h"

#include "core/mesh/triangle_mesh.h"
#include "tests/fuzz/shared/cache_target.h"

namespace remote_touch::fuzz::tool_cache {
namespace {

void read(std::string_view bytes) {
  const auto folder = cache_folder("tool", kToolFormat, bytes);
  const auto stored = read_tool(folder, kCacheKey);
  if (!stored) return;
  const VoxelTool& tool = stored->tool;
  require(has_its_vertices(tool.mesh), "a corner is a vertex");
  for (const int cells : tool.grid.cells) require(cells > 0, "a grid has cells");
  sample_field(tool, tool.grid.origin_T);
  require_written_as_read(folder, "tool", [&] { write_tool(folder, kCacheKey, *stored); });
}

const Registered registered("tool_cache", read);

}  // namespace
}  // namespace remote_touch::fuzz::tool_cache
