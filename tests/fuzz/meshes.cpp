// Mesh files of each kind, read in a child process with limits.
#include "core/mesh/triangle_mesh.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::meshes {
namespace {

void read_as_mesh(const std::string& name, std::string_view bytes) {
  const auto file = scratch_file(name, bytes);
  accepts(bytes, [&] {
    const TriangleMesh mesh = read_mesh(file, run_in_child());
    require(has_its_vertices(mesh), "a corner is a vertex");
  });
}

const Registered of_obj("mesh_obj", [](std::string_view bytes) { read_as_mesh("mesh.obj", bytes); });
const Registered of_ply("mesh_ply", [](std::string_view bytes) { read_as_mesh("mesh.ply", bytes); });
const Registered of_stl("mesh_stl", [](std::string_view bytes) { read_as_mesh("mesh.stl", bytes); });

}  // namespace
}  // namespace remote_touch::fuzz::meshes
