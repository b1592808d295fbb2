#include "core/dissertation/tool/shape/pointshell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace remote_touch {

namespace {

struct Chosen {
  double squared_m2;  // squared distance to the middle of the cube
  Vec3 p_T;
};

}  // namespace

Pointshell make_pointshell(const VoxelTool& tool, double spacing_m) {
  const VoxelGrid& grid = tool.grid;
  std::map<std::array<int, 3>, Chosen> cubes;
  std::size_t cell = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i, ++cell) {
        if (tool.voxels[cell] != Voxel::shell) continue;
        const Vec3 p_T = grid.origin_T + grid.size_m * Vec3(i + 0.5, j + 0.5, k + 0.5);
        std::array<int, 3> cube;
        Vec3 middle_T;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto at = static_cast<Eigen::Index>(axis);
          cube[axis] = static_cast<int>(std::floor(p_T[at] / spacing_m));
          middle_T[at] = (cube[axis] + 0.5) * spacing_m;
        }
        const Chosen voxel{(p_T - middle_T).squaredNorm(), p_T};
        const auto [place, is_first] = cubes.try_emplace(cube, voxel);
        if (!is_first && voxel.squared_m2 < place->second.squared_m2) place->second = voxel;
      }
  Pointshell shell;
  for (const auto& [cube, chosen] : cubes) {
    const FieldSample at = sample_field(tool, chosen.p_T);
    const double slope = at.gradient_T.norm();
    if (!(slope > 0)) continue;
    const Vec3 out_T = at.gradient_T / slope;
    shell.p_T.emplace_back(chosen.p_T - at.distance_m / slope * out_T);
    shell.n_T.emplace_back(-out_T);
  }
  return shell;
}

}  // namespace remote_touch
