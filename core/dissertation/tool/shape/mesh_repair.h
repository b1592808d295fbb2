// Repairs a mesh that is not closed, as far as possible.
#pragma once

#include <string>

#include "core/dissertation/tool/shape/triangle_mesh.h"

namespace remote_touch {

struct MeshRepair {
  int welded_vertices = 0;    // within a millionth of the mesh's size of another one
  int dropped_triangles = 0;  // degenerate or duplicate
  int flipped_triangles = 0;  // against the orientation of their part
  int filled_holes = 0;       // loops of boundary edges, each with a fan around its middle
};

// Repairs a mesh. Every part is oriented outwards separately: a part that was a hollow in another becomes
// solid. Parts that cannot be closed (edges of three triangles, boundaries that are not loops) stay open: see
// inside_nodes_of_open(). pre: indices in range, vertices finite.
TriangleMesh repair_mesh(const TriangleMesh& mesh, MeshRepair& done);

std::string text(const MeshRepair& done);  // "welded 12 vertices, filled 3 holes"; "nothing"

}  // namespace remote_touch
