// A 3-D picture: clouds of points, solids and line segments, as a camera would see them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// One part of the picture, drawn from a table of the figure. Positions are the columns x, y, z.
struct ScenePart {
  // points: discs, coloured by a column colour (0xRRGGBB) and shaded by nx, ny, nz if the table has them;
  // segments: lines from x, y, z to x_end, y_end, z_end; solid: `table` has the vertices.
  enum class Kind { points, segments, solid };
  Kind kind = Kind::points;
  std::string table;
  std::uint32_t colour = 0x808080;  // used if the table has no colours
  double size_m = 0.002;            // diameter of a point
  std::string label = {};           // empty: not in the legend
  // Only for a solid. Table `triangles` has the vertex numbers of the corners in columns a, b, c. Row
  // pose_row of table `poses` has its position x, y, z and orientation qw, qx, qy, qz.
  std::string triangles = {}, poses = {};
  int pose_row = 0;
  double opacity = 1;
  // Only for points: a column of `table` that colours them in place of `colour`; a colour bar shows its
  // values.
  std::string coloured_by = {};
};

struct Scene {
  Vec3 eye = Vec3::Zero(), target = Vec3::UnitZ(), up = Vec3::UnitY();
  double width_m = 1;  // visible width at the distance of the target
  double height_per_width = 0.75;
  std::vector<ScenePart> parts = {};
};

}  // namespace remote_touch
