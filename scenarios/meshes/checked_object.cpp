#include "scenarios/meshes/checked_object.h"

#include <memory>
#include <stdexcept>

#include "core/geometry/vector.h"
#include "core/mesh/mesh_check.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

void require_metres(const MeshSubject& names, const TriangleMesh& mesh) {
  constexpr double kMaxSize_m = 10;
  BoundingBox box;
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle) box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
  const double size_m = box.diagonal().norm();
  if (!(size_m <= kMaxSize_m))
    refuse(names.subject, "its bounding box has a diagonal of ", size_m,
           " m: metres expected, these may be millimetres", names.if_large);
}

std::shared_ptr<const MeshDistance> distance_to(const std::string& subject, const TriangleMesh& mesh) {
  try {
    return std::make_shared<const MeshDistance>(mesh);
  } catch (const std::invalid_argument&) {
    refuse(subject, "no triangle has an area: expected a surface");
  }
}

}  // namespace

MeshObject checked_object(const std::string& name, const TriangleMesh& mesh, std::optional<bool> closed,
                          const MeshSubject& names) {
  const MeshCheck check = check_mesh(mesh);
  if (!check.readable()) refuse(names.subject, text(check), ": expected a mesh of triangles");
  require_metres(names, mesh);
  MeshObject object{name, distance_to(names.subject, mesh)};
  object.is_closed = closed.value_or(object.shape->is_closed());
  if (!object.is_closed) return object;
  if (!object.shape->is_closed())
    refuse(names.subject, text(check), ": expected a closed mesh", names.if_open);
  if (object.shape->has_inverted_part())
    refuse(names.subject,
           check.inverted()          ? text(check)
           : signed_volume(mesh) < 0 ? "inside out"
                                     : "a part of the mesh is inside out",
           ": expected triangles counter-clockwise seen from outside", names.if_inverted);
  return object;
}

}  // namespace remote_touch
