#include "core/dissertation/tool_motion/touch_finder.h"

#include <cmath>
#include <utility>

#include "core/mesh/distance_field.h"

namespace remote_touch {

PosedField posed_field(const VoxelTool& tool, const ToolPose& pose) {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  PosedField field;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) field.R_TW[axis][k] = R_TW(axis, k);
    field.p_W[axis] = pose.p_W[axis];
    field.origin_T[axis] = tool.grid.origin_T[axis];
    field.cells[axis] = tool.grid.cells[static_cast<std::size_t>(axis)];
  }
  field.node = tool.distance_m.data();
  field.size = tool.grid.size_m;
  return field;
}

double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to) {
  const double turn = 2 * (to.q_WT * from.q_WT.conjugate()).vec().norm();  // chord: 2 sin(angle / 2)
  return finder.max_slope() * ((to.p_W - from.p_W).norm() + turn * finder.grid_reach_m());
}

namespace {

// Unit and zero of nearness(): a field value in quarter millimetres below 16 mm. A nearer cell has a larger
// value, and the value fits into a byte.
constexpr double kNearnessUnit_m = 2.5e-4, kNearnessZero_m = 0.016;

int nearness(double distance_m) {
  return static_cast<int>(
      std::clamp(std::floor((kNearnessZero_m - distance_m) / kNearnessUnit_m), -128.0, 127.0));
}

// Returns the nearness of every cell, from the smallest of its eight nodes; the trilinear field is nowhere
// smaller.
std::vector<std::int8_t> nearness_of_cells(const VoxelTool& tool) {
  const int nx = tool.grid.cells[0], ny = tool.grid.cells[1], nz = tool.grid.cells[2];
  const std::size_t row = static_cast<std::size_t>(nx) + 1, layer = row * (static_cast<std::size_t>(ny) + 1);
  std::vector<std::int8_t> table(tool.grid.cell_count() + 3, 0);
  std::vector<float> column(row);
#pragma omp parallel for firstprivate(column)
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j) {
      const float* node =
          tool.distance_m.data() + static_cast<std::size_t>(k) * layer + static_cast<std::size_t>(j) * row;
      for (std::size_t i = 0; i < row; ++i)
        column[i] =
            std::min(std::min(node[i], node[i + row]), std::min(node[i + layer], node[i + layer + row]));
      std::int8_t* cell = table.data() + (static_cast<std::size_t>(k) * static_cast<std::size_t>(ny) +
                                          static_cast<std::size_t>(j)) *
                                             static_cast<std::size_t>(nx);
      for (std::size_t i = 0; i + 1 < row; ++i)
        cell[i] = static_cast<std::int8_t>(nearness(static_cast<double>(std::min(column[i], column[i + 1]))));
    }
  return table;
}

// Returns the largest node value of all cells that are not free; the trilinear field in them is nowhere
// larger, but for rounding.
double max_voxel_m(const VoxelTool& tool) {
  const std::size_t nx = static_cast<std::size_t>(tool.grid.cells[0]),
                    ny = static_cast<std::size_t>(tool.grid.cells[1]),
                    nz = static_cast<std::size_t>(tool.grid.cells[2]);
  const std::size_t row = nx + 1, layer = row * (ny + 1);
  float max = -std::numeric_limits<float>::infinity();
  for (std::size_t cell = 0; cell < tool.voxels.size(); ++cell) {
    if (tool.voxels[cell] == Voxel::free) continue;
    const float* node =
        &tool.distance_m[cell % nx + row * (cell / nx % ny) + layer * (cell / (nx * ny) % nz)];
    for (const std::size_t corner : {std::size_t{0}, row, layer, layer + row})
      max = std::max({max, node[corner], node[corner + 1]});
  }
  return static_cast<double>(max) + 1e-9;
}

double farthest_corner_m(const VoxelGrid& grid) {
  const Vec3 last_T = grid.origin_T + grid.size_m * Vec3(grid.cells[0], grid.cells[1], grid.cells[2]);
  return grid.origin_T.cwiseAbs().cwiseMax(last_T.cwiseAbs()).norm();
}

}  // namespace

TouchFinder::TouchFinder(std::shared_ptr<const VoxelTool> tool, const Kernels& kernels)
    : tool_(std::move(tool)),
      kernels_(kernels),
      max_slope_(remote_touch::max_slope(tool_->grid, tool_->distance_m, kFieldMargin_m)),
      grid_reach_m_(farthest_corner_m(tool_->grid)),
      max_voxel_m_(remote_touch::max_voxel_m(*tool_)),
      slopes_(tool_->grid, tool_->distance_m),
      nearness_(nearness_of_cells(*tool_)) {
  voxels_.reserve(tool_->voxels.size() + 3);
  for (const Voxel v : tool_->voxels) voxels_.push_back(static_cast<std::int8_t>(v));
  voxels_.resize(tool_->voxels.size() + 3, 0);
}

void TouchFinder::on_frame(std::shared_ptr<const TiledCloud> cloud) {
  cloud_ = std::move(cloud);
  reserve(cloud_->padded_size());
}

void TouchFinder::reserve(std::size_t padded_size) {
  for (auto* list : {&found_, &groups_, &tiles_, &rows_}) list->grow(padded_size + kTilePoints * kBlockTiles);
}

std::span<const std::uint32_t> TouchFinder::in_tool(const ToolPose& pose) const {
  return find(*cloud_, pose, tool_->grid.size_m, voxels_, static_cast<int>(Voxel::shell));
}

std::span<const std::uint32_t> TouchFinder::within(const TiledCloud& cloud, const ToolPose& pose,
                                                   double distance_m) const {
  return find(cloud, pose, distance_m, nearness_, nearness(distance_m));
}

CellTransform TouchFinder::to_cells(const ToolPose& pose) const {
  const VoxelGrid& grid = tool_->grid;
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  CellTransform to_cells;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row = R_TW.row(axis).transpose() / grid.size_m;
    for (int k = 0; k < 3; ++k) to_cells.row[axis][k] = row[k];
    to_cells.row[axis][3] = -row.dot(pose.p_W) - grid.origin_T[axis] / grid.size_m;
  }
  return to_cells;
}

// The margin of two voxels is more than the error of the field far from the surface.
NearnessCode TouchFinder::code_within(double distance_m) const {
  const double size_m = tool_->grid.size_m;
  return {kNearnessZero_m / kNearnessUnit_m - 1, kNearnessUnit_m / size_m, distance_m / size_m + 2,
          1 / size_m};
}

std::span<const std::uint32_t> TouchFinder::tiles_within(const TiledCloud& cloud, const ToolPose& pose,
                                                         double distance_m) const {
  const auto beyond = [&](const BoundingSphere& sphere) {
    const double reach = tool_->reach_m + distance_m + sphere.radius_m;
    return (sphere.centre_W - pose.p_W).squaredNorm() > reach * reach;
  };
  std::size_t rows = 0;
  for (const TileBlock& block : cloud.blocks()) {
    if (beyond(block.sphere)) continue;
    for (std::uint32_t tile = 0; tile < block.count; tile += kLanes)
      rows_[rows++] = (block.first + tile) / static_cast<std::uint32_t>(kLanes);
  }
  if (rows == 0) return {};
  const std::size_t tiles =
      kernels_.tool.near_spheres(cloud.tile_spheres(), rows_.data(), rows, to_cells(pose), table(nearness_),
                                 code_within(distance_m), tiles_.data());
  return {tiles_.data(), tiles};
}

std::span<const std::uint32_t> TouchFinder::groups_within(const TiledCloud& cloud, const ToolPose& pose,
                                                          double distance_m) const {
  const std::span<const std::uint32_t> tiles = tiles_within(cloud, pose, distance_m);
  const std::size_t groups =
      kernels_.tool.near_spheres(cloud.group_spheres(), tiles.data(), tiles.size(), to_cells(pose),
                                 table(nearness_), code_within(distance_m), groups_.data());
  return {groups_.data(), groups};
}

std::span<const std::uint32_t> TouchFinder::slabs_within(const TiledCloud& cloud, const ToolPose& pose,
                                                         double distance_m, double* nearest_m) const {
  const std::span<const std::uint32_t> tiles = tiles_within(cloud, pose, distance_m);
  const std::size_t groups = kernels_.tool.slabs_in_field(
      cloud.slabs(), tiles.data(), tiles.size(), posed_field(*tool_, pose), slopes(),
      {distance_m, max_slope_, kFieldMargin_m}, groups_.data(), nearest_m);
  return {groups_.data(), groups};
}

std::span<const std::uint32_t> TouchFinder::find(const TiledCloud& cloud, const ToolPose& pose,
                                                 double distance_m, const std::vector<std::int8_t>& values,
                                                 int min) const {
  const std::span<const std::uint32_t> groups = groups_within(cloud, pose, distance_m);
  const std::size_t count =
      kernels_.tool.points_in_cells(cloud.x(), cloud.y(), cloud.z(), groups.data(), groups.size(),
                                    to_cells(pose), table(values), min, found_.data());
  return {found_.data(), count};
}

Voxel TouchFinder::voxel(const Vec3& p_T) const {
  const VoxelGrid& grid = tool_->grid;
  const Vec3 u = (p_T - grid.origin_T) / grid.size_m;
  std::size_t cell[3];
  for (int axis = 0; axis < 3; ++axis) {
    if (!(u[axis] >= 0 && u[axis] < grid.cells[static_cast<std::size_t>(axis)])) return Voxel::free;
    cell[axis] = static_cast<std::size_t>(u[axis]);
  }
  const auto columns = static_cast<std::size_t>(grid.cells[0]),
             rows = static_cast<std::size_t>(grid.cells[1]);
  return tool_->voxels[(cell[2] * rows + cell[1]) * columns + cell[0]];
}

}  // namespace remote_touch
