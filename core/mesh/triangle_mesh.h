// A surface of triangles, from which a tool is made.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// Metres. The corners of a triangle run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};

}  // namespace remote_touch
