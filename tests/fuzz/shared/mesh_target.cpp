#include "tests/fuzz/shared/mesh_target.h"

#include "core/dissertation/tool/shape/mesh_corners.h"
#include "runners/experiment/tool_files/mesh_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz {

void read_as_mesh(const std::string& name, std::string_view bytes) {
  const auto file = scratch_file(name, bytes);
  accepts(bytes, [&] {
    const TriangleMesh mesh = read_mesh(file, run_in_child());
    require(has_its_vertices(mesh), "a corner is a vertex");
  });
}

}  // namespace remote_touch::fuzz
