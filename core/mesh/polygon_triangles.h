// Cuts a polygon, concave ones too, into triangles.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// Returns each triangle as the indices of its corners in the list, in the direction of the polygon. Their
// areas sum up to the area of the polygon: they neither overlap nor leave it. A convex polygon becomes a fan
// about its first corner. Empty for a polygon whose edges cross or touch each other. Corners that are not in
// one plane are projected along the polygon's own normal (that of its area vector). pre: three finite corners
// or more, neighbours differ.
std::optional<std::vector<std::array<int, 3>>> polygon_triangles(const std::vector<Vec3>& corners);

}  // namespace remote_touch
