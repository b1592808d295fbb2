// Meshes in STL files.
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/mesh_target.h"

namespace remote_touch::fuzz::mesh_stl {
namespace {

const Registered registered("mesh_stl", [](std::string_view bytes) { read_as_mesh("mesh.stl", bytes); });

}  // namespace
}  // namespace remote_touch::fuzz::mesh_stl
