// Repairs a mesh that is not closed, as far as possible.
#pragma once

#include <string>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

struct MeshRepair {
  int welded_vertices = 0;    // closer to another one than a millionth of the mesh's size
  int dropped_triangles = 0;  // a corner occurs twice, or another triangle has the same corners
  int flipped_triangles = 0;  // triangles of the mesh whose orientation has changed
  int filled_holes = 0;       // loops of boundary edges, each closed by a triangle or a fan
};

// Repairs a mesh. Every part is oriented outwards separately: a part that was a hollow in another becomes
// solid. Parts that cannot be closed (edges of three triangles, boundaries that are not loops) stay open: see
// inside_nodes_of_open(). pre: indices in range, vertices finite.
TriangleMesh repair_mesh(const TriangleMesh& mesh, MeshRepair& done);

std::string text(const MeshRepair& done);  // "welded 12 vertices, filled 3 holes"; "nothing"

}  // namespace remote_touch
