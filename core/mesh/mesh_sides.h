// The faces of a closed mesh that bound its solid. Parts of a mesh may lie in each other, or cross.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// The solid of a closed mesh is the set of positions around which the whole mesh winds once or more: its
// winding number is 1 or more there, and 0 or less outside.
enum class FaceSide : std::uint8_t {
  boundary,  // the solid is behind the face and not in front of it
  inner,     // the solid is on both sides, as of a part within another one: no part of the surface
  inverted,  // the solid is on neither side: the face runs clockwise seen from outside
  crossed    // another face crosses this face, or lies on a part of it: its side is not the same everywhere
};

// True if as many triangles run along every edge in one direction as in the other.
bool is_closed_surface(const TriangleMesh& mesh);

// Returns the side of each face. A part of zero volume, a sheet with two sides, counts as boundary.
// pre: mesh is the result of welded_mesh(), has a triangle, and is_closed_surface(mesh).
std::vector<FaceSide> face_sides(const TriangleMesh& mesh);

// True if a part is inside out and is no hollow: its volume is negative, and it does not lie wholly in one
// other part of positive volume; or all its faces are inverted, as of a hollow in a hollow. A surface that
// crosses itself may have some inverted faces: a pocket that it winds around backwards is outside. pre: sides
// is the result of face_sides().
bool has_inverted_part_in(const TriangleMesh& mesh, const std::vector<FaceSide>& sides);

// Returns for each face whether another one crosses it, or lies on a part of it. Faces that only touch, in a
// corner or along a line, do not cross. pre: indices in range, vertices finite, no triangle without area.
std::vector<char> crossed_faces(const TriangleMesh& mesh);

}  // namespace remote_touch
