// Joins the triangles of a mesh that touch each other, so that every edge has all of its triangles.
#pragma once

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Returns the same surface with one vertex per position (0 and -0 are equal), and without triangles that have
// no area (is_degenerate()). Such a triangle is removed so that its neighbours meet, and a closed surface
// stays closed:
//   - If one of its corners lies on its longest side, the triangle across that side is divided there.
//   - If it has a side shorter than 1e-8 of the longest one, the ends of that side become one vertex.
// A triangle without area is only left out if its longest side has no other triangle, or several.
//
// Small fins, which bound no volume, are left out, too: triangles of which two sides have no other triangle
// and the third has at least two others, and whose corner is within 1e-3 of the mesh's longest extent of that
// side. Reconstruction and decimation leave such triangles on closed surfaces.
//
// Vertices that no triangle uses are left out. Vertices and triangles keep their order.
// pre: check_mesh(mesh).readable(). The result has no triangles if none has an area.
TriangleMesh welded_mesh(const TriangleMesh& mesh);

// Vertices and triangles keep their order.
void leave_out_unused_vertices(TriangleMesh& mesh);

}  // namespace remote_touch
