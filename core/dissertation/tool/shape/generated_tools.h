// Tools that need no file: boxes, and smooth bodies meshed from a formula.
#pragma once

#include <span>
#include <string>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

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
