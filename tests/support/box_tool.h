// A box as a tool, written in closed form, for tests that need a tool whose every number is known. The file
// also has clouds for it.
#pragma once

#include <cmath>
#include <memory>

#include "core/mesh/distance_field.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"

namespace remote_touch::scenes {

inline double box_distance(const Vec3& half_m, const Vec3& p) {
  const Vec3 q = p.cwiseAbs() - half_m;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

inline TriangleMesh box_mesh(const Vec3& half_m) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(
        half_m.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// The sides are integers of voxels. The outermost layer inside is the shell.
inline std::shared_ptr<const VoxelTool> box_tool(const Vec3& half_m, double voxel_m = 5e-4) {
  auto tool = std::make_shared<VoxelTool>();
  tool->mesh = box_mesh(half_m);
  VoxelGrid& grid = tool->grid;
  grid.size_m = voxel_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int margin = static_cast<int>(std::ceil(kFieldMargin_m / voxel_m)) + 1;
    grid.cells[axis] =
        static_cast<int>(std::lround(2 * half_m[static_cast<int>(axis)] / voxel_m)) + 2 * margin;
    grid.origin_T[static_cast<int>(axis)] = -half_m[static_cast<int>(axis)] - margin * voxel_m;
  }
  for (int k = 0; k <= grid.cells[2]; ++k)
    for (int j = 0; j <= grid.cells[1]; ++j)
      for (int i = 0; i <= grid.cells[0]; ++i)
        tool->distance_m.push_back(
            static_cast<float>(box_distance(half_m, grid.origin_T + voxel_m * Vec3(i, j, k))));
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        const Vec3 middle = grid.origin_T + voxel_m * Vec3(i + 0.5, j + 0.5, k + 0.5);
        const Vec3 q = middle.cwiseAbs() - half_m;
        const bool interior = (q.array() < -voxel_m).all();
        tool->voxels.push_back(interior                ? Voxel::interior
                               : (q.array() < 0).all() ? Voxel::shell
                                                       : Voxel::free);
      }
  const Vec3 size = 2 * half_m;
  tool->volume_m3 = size.prod();
  tool->inertia_m2 =
      ((Eigen::Matrix3d::Identity() * size.squaredNorm()).diagonal() - size.cwiseProduct(size)).asDiagonal();
  tool->inertia_m2 /= 12;
  tool->reach_m = half_m.norm();
  return tool;
}

// The same with the field that the continuous rule and the god-object need.
inline std::shared_ptr<const VoxelTool> outer_box_tool(const Vec3& half_m) {
  VoxelTool tool = *box_tool(half_m);
  tool.distance_m = outer_field(tool.mesh, tool.grid, tool.distance_m);
  return std::make_shared<const VoxelTool>(std::move(tool));
}

// Points so dense that one disk can replace many: 100 x 100 in the plane y = 0, 0.3 mm apart, with normals.
inline PointCloud dense_plane() {
  PointCloud cloud;
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 100; ++i) cloud.append(Vec3((i - 50) * 3e-4, 0, (j - 50) * 3e-4), Vec3::UnitY());
  return cloud;
}

// Five points less than a cell outside a grid.
inline PointCloud points_outside(const VoxelGrid& grid) {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i)
    cloud.append(Vec3(grid.origin_T.x() - 0.3 * grid.size_m, 1e-3 * i, 0), Vec3::UnitX());
  return cloud;
}

}  // namespace remote_touch::scenes
