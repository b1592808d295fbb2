// Meshes in PLY files.
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/mesh_target.h"

namespace remote_touch::fuzz::mesh_ply {
namespace {

const Registered registered("mesh_ply", [](std::string_view bytes) { read_as_mesh("mesh.ply", bytes); });

}  // namespace
}  // namespace remote_touch::fuzz::mesh_ply
