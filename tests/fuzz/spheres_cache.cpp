// Sphere trees of tools in the cache. A file that is read is written as it was.
#include "runners/experiment/mesh_files/loaded_tool.h"

#include "tests/fuzz/shared/cache_target.h"

namespace remote_touch::fuzz::spheres_cache {
namespace {

void read(std::string_view bytes) {
  const auto folder = cache_folder("spheres", kSpheresFormat, bytes);
  const auto spheres = read_spheres(folder, kCacheKey);
  if (!spheres) return;
  const SphereTree& tree = spheres->spheres;
  require(!tree.empty(), "a tool has spheres");
  for (std::size_t i = 0; i < tree.level(0).size(); ++i) tree.run(i);
  require_written_as_read(folder, "spheres", [&] { write_spheres(folder, kCacheKey, *spheres); });
}

const Registered registered("spheres_cache", read);

}  // namespace
}  // namespace remote_touch::fuzz::spheres_cache
