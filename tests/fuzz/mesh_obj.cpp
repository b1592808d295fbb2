// Meshes in OBJ files.
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/mesh_target.h"

namespace remote_touch::fuzz::mesh_obj {
namespace {

const Registered registered("mesh_obj", [](std::string_view bytes) { read_as_mesh("mesh.obj", bytes); });

}  // namespace
}  // namespace remote_touch::fuzz::mesh_obj
