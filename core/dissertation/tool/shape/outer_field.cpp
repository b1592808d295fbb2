#include "core/dissertation/tool/shape/outer_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dissertation/tool/shape/cell_field.h"
#include "core/dissertation/tool/shape/distance_field.h"

namespace remote_touch {

namespace {

constexpr double kAccuracy_m = 2e-6;  // accuracy of the upper bound of the field on a part of the surface
constexpr int kMaxHalvings = 8;
// Covers two rounding errors: nodes are rounded to float, and a position on the surface can be counted in the
// next cell if it is a fraction of a nanometre away.
constexpr double kRounding_m = 1e-8;

// Returns an upper bound of the field on a triangle: f + bend / 2 |x - middle|^2 is convex, so largest at a
// corner.
double largest(const CellField& field, const std::array<Vec3, 3>& corners, int halvings) {
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  double value = -HUGE_VAL, squared = 0;
  for (const Vec3& corner : corners) {
    value = std::max(value, field(corner));
    squared = std::max(squared, (corner - middle).squaredNorm());
  }
  const double slack = 0.5 * field.max_bend() * squared;
  if (value + slack <= 0 || slack <= kAccuracy_m || halvings == 0) return value + slack;
  const std::array<Vec3, 3> half{0.5 * (corners[1] + corners[2]), 0.5 * (corners[2] + corners[0]),
                                 0.5 * (corners[0] + corners[1])};
  double all = largest(field, half, halvings - 1);
  for (int i = 0; i < 3; ++i)
    all = std::max(all, largest(field, {corners[i], half[(i + 1) % 3], half[(i + 2) % 3]}, halvings - 1));
  return all;
}

using Polygon = std::vector<Vec3>;

// Keeps the part of a convex polygon where sign x coordinate <= limit (Sutherland and Hodgman).
void cut(Polygon& polygon, int axis, double sign, double limit, Polygon& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = sign * a[axis] - limit, over_b = sign * b[axis] - limit;
    if (over_a <= 0) kept.push_back(a);
    if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0))
      kept.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  std::swap(polygon, kept);
}

// Returns the largest value of the field on the part of a triangle in the unit cell; 0 if none is above 0.
double excess_on(const CellField& field, const std::array<Vec3, 3>& triangle, Polygon& part, Polygon& kept) {
  constexpr double kBeyond = 1e-9;
  part.assign(triangle.begin(), triangle.end());
  for (int axis = 0; axis < 3 && !part.empty(); ++axis) {
    cut(part, axis, -1, kBeyond, kept);
    cut(part, axis, 1, 1 + kBeyond, kept);
  }
  double all = 0;
  for (std::size_t i = 2; i < part.size(); ++i)
    all = std::max(all, largest(field, {part[0], part[i - 1], part[i]}, kMaxHalvings));
  return all;
}

// True if the plane of a triangle does not meet the unit cell.
bool passes_by(const std::array<Vec3, 3>& triangle) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double reach = 0.5 * normal.cwiseAbs().sum();
  return std::abs(normal.dot(Vec3::Constant(0.5) - triangle[0])) > reach * (1 + 1e-6) + 1e-12;
}

// Returns, for every cell, the amount by which its nodes are too high.
std::vector<float> excess_of_cells(const TriangleMesh& mesh, const VoxelGrid& grid,
                                   const std::vector<float>& nodes) {
  std::vector<float> excess(grid.cell_count(), 0);
  constexpr int kLayers = 8;  // each thread has layers of cells to itself
  const int slabs = (grid.cells[2] + kLayers - 1) / kLayers;
#pragma omp parallel for schedule(dynamic)
  for (int slab = 0; slab < slabs; ++slab) {
    Polygon part, kept;
    for (const auto& corners : mesh.triangles) {
      std::array<Vec3, 3> triangle;
      std::array<int, 3> low, high;
      for (int i = 0; i < 3; ++i) triangle[i] = (mesh.vertices[corners[i]] - grid.origin_T) / grid.size_m;
      for (int i = 0; i < 3; ++i) {
        const auto [min, max] = std::minmax({triangle[0][i], triangle[1][i], triangle[2][i]});
        low[i] = std::max(0, static_cast<int>(std::floor(min - 1e-6)));
        high[i] = std::min(grid.cells[i] - 1, static_cast<int>(std::floor(max + 1e-6)));
      }
      low[2] = std::max(low[2], slab * kLayers), high[2] = std::min(high[2], slab * kLayers + kLayers - 1);
      for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
          for (int i = low[0]; i <= high[0]; ++i) {
            const Vec3 cell(i, j, k);
            const std::array<Vec3, 3> here{triangle[0] - cell, triangle[1] - cell, triangle[2] - cell};
            if (passes_by(here)) continue;
            float& most = excess[i + grid.cells[0] * (j + std::size_t(grid.cells[1]) * k)];
            const double found = excess_on(CellField(grid, nodes, {i, j, k}), here, part, kept);
            most = std::max(most, static_cast<float>(found));
          }
    }
  }
  return excess;
}

}  // namespace

std::vector<float> outer_field(const TriangleMesh& mesh, const VoxelGrid& grid,
                               const std::vector<float>& distance_m) {
  const std::vector<float> excess = excess_of_cells(mesh, grid, distance_m);
  const auto& cells = grid.cells;
  std::vector<float> lowered = distance_m;
#pragma omp parallel for
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        float most = 0;
        for (int z = std::max(k - 1, 0); z <= std::min(k, cells[2] - 1); ++z)
          for (int y = std::max(j - 1, 0); y <= std::min(j, cells[1] - 1); ++y)
            for (int x = std::max(i - 1, 0); x <= std::min(i, cells[0] - 1); ++x)
              most = std::max(most, excess[x + cells[0] * (y + std::size_t(cells[1]) * z)]);
        if (most > 0)
          lowered[i + (cells[0] + std::size_t(1)) * (j + (cells[1] + std::size_t(1)) * k)] -=
              most + static_cast<float>(kRounding_m);
      }
  return lowered;
}

double max_slope(const VoxelGrid& grid, const std::vector<float>& distance_m, double within_m) {
  const std::size_t row = grid.cells[0] + std::size_t(1), layer = row * (grid.cells[1] + std::size_t(1));
  double max = 0;
#pragma omp parallel for reduction(max : max)
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        const float* n = &distance_m[i + row * j + layer * k];
        if (std::min({n[0], n[1], n[row], n[row + 1]}) > within_m &&
            std::min({n[layer], n[layer + 1], n[layer + row], n[layer + row + 1]}) > within_m)
          continue;
        const auto steepest = [&](std::size_t along, std::size_t a, std::size_t b) {
          double most = 0;
          for (const std::size_t edge : {std::size_t(0), a, b, a + b})
            most = std::max(most, std::abs(double(n[edge + along]) - n[edge]));
          return most;
        };
        const Vec3 slope(steepest(1, row, layer), steepest(row, 1, layer), steepest(layer, 1, row));
        max = std::max(max, slope.squaredNorm());
      }
  return std::sqrt(max) / grid.size_m;
}

}  // namespace remote_touch
