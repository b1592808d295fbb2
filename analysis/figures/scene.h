// A 3-D picture: clouds of points, solids and line segments, as a camera would see them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// What is drawn of a figure's tables. Positions are the columns x, y, z.
struct ScenePart {
  // points: discs, coloured by a column colour (0xRRGGBB) and shaded by nx, ny, nz if the table has them;
  // segments: from x, y, z to x_end, y_end, z_end; solid: vertices.
  enum class Kind { points, segments, solid };
  Kind kind = Kind::points;
  std::string table;
  std::uint32_t colour = 0x808080;  // if the table has none
  double size_m = 0.002;            // diameter of a point
  std::string label = {};           // empty: not in the legend
  // Of a solid: table `triangles` has the numbers of the corners' vertices in columns a, b, c; row pose_row
  // of table `poses` has its position x, y, z and orientation qw, qx, qy, qz.
  std::string triangles = {}, poses = {};
  int pose_row = 0;
  double opacity = 1;
};

struct Scene {
  Vec3 eye = Vec3::Zero(), target = Vec3::UnitZ(), up = Vec3::UnitY();
  double width_m = 1;        // visible width at the distance of the target
  double proportion = 0.75;  // height / width
  std::vector<ScenePart> parts = {};
};

}  // namespace remote_touch
