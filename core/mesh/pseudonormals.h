// The normals of the faces, edges and vertices of a surface of triangles, from which the side of a position
// follows: it is the sign of (p - nearest point) . normal of the face, edge or vertex with the nearest point.
// The normal of an edge is the mean of the normals of its faces. That of a vertex is the mean weighted by the
// angles of the faces at the vertex, because other means fail at some vertices (J. A. Baerentzen, H. Aanaes,
// "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005). Their proof
// needs the solid near the vertex only, by the divergence theorem, so it also holds where parts of the solid
// touch along an edge of four faces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Unit vectors, in the order of the mesh. Where faces are folded onto each other so that their mean vanishes,
// the normal is that of the first face.
struct Pseudonormals {
  std::vector<Vec3> of_face, of_edge, of_vertex;
  std::vector<std::array<int, 3>> edges_of_face;  // the edges from corner 0 to 1, 1 to 2 and 2 to 0
  // 1 if the surface ends at the edge: more faces run along it in one direction than in the other, such as a
  // single face. Its side is unknown there. 1 for both ends of such an edge.
  std::vector<std::uint8_t> edge_on_border, vertex_on_border;
};

// pre: mesh is the result of welded_mesh().
Pseudonormals pseudonormals(const TriangleMesh& mesh);

}  // namespace remote_touch
