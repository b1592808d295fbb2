// Tools that need no file: boxes, and smooth bodies meshed from a formula.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// A closed mesh around the region in which a function is negative.

// Every cube of the grid, which begins at `low`, is divided into six tetrahedra around its diagonal. A
// surface through tetrahedra has no ambiguous cases, so the mesh is closed and manifold. Vertices lie on the
// edges where the function vanishes, but at least a hundredth of an edge from its ends, so that no triangle
// is degenerate. Throws InputError if the function is negative at a node on a side of the grid.
TriangleMesh marching_tetrahedra(const std::function<double(const Vec3&)>& function, const Vec3& low,
                                 const Vec3& high, double cell_m);

struct GeneratedTool {
  const char* name;
  const char* summary;
  TriangleMesh (*make)();  // closed, in metres
};

std::span<const GeneratedTool> generated_tools();  // sorted by name

const GeneratedTool* find_generated_tool(const std::string& name);  // null if there is no tool of this name

// Twelve triangles around a centre.
TriangleMesh box_mesh(const Vec3& sides_m, const Vec3& centre = Vec3::Zero());

}  // namespace remote_touch
