// Objects of meshes that a user names: a mesh that cannot be a true surface is refused with the reason.
#pragma once

#include <optional>
#include <string>

#include "core/mesh/triangle_mesh.h"
#include "scenarios/meshes/mesh_object.h"

namespace remote_touch {

// The words of messages about a mesh.
struct MeshSubject {
  std::string subject;  // the refused part: the file, or the parameter and its value
  // Advice to a user: these continue the messages about an open mesh, one of clockwise triangles, and one
  // of more than 10 m.
  std::string if_open = {}, if_inverted = {}, if_large = {};
};

// closed: true for a solid, false for a sheet; nothing: as MeshDistance::is_closed() finds.
//
// Throws InputError about the subject in these cases: the mesh has no triangle with an area, or an index or
// vertex that cannot be used; its bounding box has a diagonal above 10 m; it should be closed and is not; or
// it is closed and the triangles of a part run clockwise seen from outside.
MeshObject checked_object(const std::string& name, const TriangleMesh& mesh, std::optional<bool> closed,
                          const MeshSubject& names);

}  // namespace remote_touch
