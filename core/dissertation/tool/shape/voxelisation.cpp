#include "core/dissertation/tool/shape/voxelisation.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/bounding_box.h"

namespace remote_touch {

namespace {

// Returns the distance of a face from the nearest plane between cells, in cells: 0 for a face between two
// cells, 1/2 for a face through the middle of a cell.
double off_the_cells(double face) {
  return std::abs(face - std::round(face));
}

// Returns the number of cells across the box and the margins: odd or even, whichever puts the sides of the
// box farther from the middles of cells.
double cells_along(double low, double high, double voxel_m) {
  const double half = (high - low) / 2 / voxel_m;
  const double cells = std::ceil(2 * (half + kFieldMargin_m / voxel_m));
  return off_the_cells(cells / 2 - half) <= off_the_cells((cells + 1) / 2 - half) ? cells : cells + 1;
}

using Cell = std::array<int, 3>;

// A triangle in units of voxels from the origin of the grid.
struct Corners {
  Vec3 v[3], normal;
};

// True if the triangle touches the box of centre c and half sides h. It does not if their projections are
// apart on one of these axes: three of the box, the normal, nine products of edges.
bool touches(const Corners& triangle, const Vec3& c, const Vec3& h) {
  constexpr double kSlack = 1e-9;
  const Vec3 a = triangle.v[0] - c, b = triangle.v[1] - c, d = triangle.v[2] - c;
  for (int i = 0; i < 3; ++i)
    if (std::min({a[i], b[i], d[i]}) > h[i] + kSlack || std::max({a[i], b[i], d[i]}) < -h[i] - kSlack)
      return false;
  const auto apart = [&](const Vec3& axis) {
    const double p = axis.dot(a), q = axis.dot(b), r = axis.dot(d);
    const double reach = axis.cwiseAbs().dot(h) + kSlack * axis.norm();
    return std::min({p, q, r}) > reach || std::max({p, q, r}) < -reach;
  };
  if (apart(triangle.normal)) return false;
  for (const Vec3& edge : {Vec3(b - a), Vec3(d - b), Vec3(a - d)})
    if (apart({0, -edge.z(), edge.y()}) || apart({edge.z(), 0, -edge.x()}) || apart({-edge.y(), edge.x(), 0}))
      return false;
  return true;
}

// Marks the touched cells in the range low to high (included), by halving it until one cell is left.
void mark(const Corners& triangle, const VoxelGrid& grid, Cell low, Cell high,
          std::vector<std::uint8_t>& crossed) {
  Vec3 centre, half;
  int max_width = 0;
  for (int i = 0; i < 3; ++i) {
    if (high[i] < low[i]) return;
    centre[i] = (low[i] + high[i] + 1) / 2.0, half[i] = (high[i] - low[i] + 1) / 2.0;
    if (high[i] - low[i] > high[max_width] - low[max_width]) max_width = i;
  }
  if (!touches(triangle, centre, half)) return;
  if (high[max_width] == low[max_width]) {
    crossed[low[0] + grid.cells[0] * (low[1] + std::size_t(grid.cells[1]) * low[2])] = 1;
    return;
  }
  Cell end = high, begin = low;
  end[max_width] = (low[max_width] + high[max_width]) / 2, begin[max_width] = end[max_width] + 1;
  mark(triangle, grid, low, end, crossed);
  mark(triangle, grid, begin, high, crossed);
}

}  // namespace

double cells_around(const TriangleMesh& mesh, double voxel_m) {
  const BoundingBox box = bounding_box(mesh.vertices);
  double cells = 1;
  for (int i = 0; i < 3; ++i) cells *= cells_along(box.min()[i], box.max()[i], voxel_m);
  return cells;
}

VoxelGrid grid_around(const TriangleMesh& mesh, double voxel_m) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const Vec3 &low = box.min(), &high = box.max();
  VoxelGrid grid;
  grid.size_m = voxel_m;
  for (int i = 0; i < 3; ++i) {
    const double cells = cells_along(low[i], high[i], voxel_m);
    grid.cells[i] = static_cast<int>(cells);
    grid.origin_T[i] = (low[i] + high[i]) / 2 - cells / 2 * voxel_m;
  }
  return grid;
}

std::vector<std::uint8_t> crossed_cells(const TriangleMesh& mesh, const VoxelGrid& grid) {
  std::vector<std::uint8_t> crossed(grid.cell_count(), 0);
  constexpr int kLayers = 8;  // each thread has layers of cells to itself
  const int slabs = (grid.cells[2] + kLayers - 1) / kLayers;
#pragma omp parallel for schedule(dynamic)
  for (int slab = 0; slab < slabs; ++slab)
    for (const auto& corners : mesh.triangles) {
      Corners triangle;
      for (int i = 0; i < 3; ++i) triangle.v[i] = (mesh.vertices[corners[i]] - grid.origin_T) / grid.size_m;
      const auto& v = triangle.v;
      triangle.normal = (v[1] - v[0]).cross(v[2] - v[0]);
      Cell low, high;
      for (int i = 0; i < 3; ++i) {
        // The range reaches slightly farther, because a surface between two cells touches both.
        low[i] = static_cast<int>(std::floor(std::min({v[0][i], v[1][i], v[2][i]}) - 1e-6));
        high[i] = static_cast<int>(std::floor(std::max({v[0][i], v[1][i], v[2][i]}) + 1e-6));
        low[i] = std::max(low[i], 0), high[i] = std::min(high[i], grid.cells[i] - 1);
      }
      low[2] = std::max(low[2], slab * kLayers), high[2] = std::min(high[2], slab * kLayers + kLayers - 1);
      mark(triangle, grid, low, high, crossed);
    }
  return crossed;
}

std::vector<Voxel> voxels_of(const VoxelGrid& grid, const std::vector<float>& distance_m) {
  const int nx = grid.cells[0], ny = grid.cells[1], nz = grid.cells[2];
  const std::size_t row = nx + std::size_t(1), layer = row * (ny + std::size_t(1));
  std::vector<std::uint8_t> solid(grid.cell_count());
  const auto cell = [&](int i, int j, int k) { return i + nx * (j + std::size_t(ny) * k); };
#pragma omp parallel for
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const float* n = &distance_m[i + row * j + layer * k];
        const double centre =
            (double(n[0]) + n[1]) + (double(n[row]) + n[row + 1]) +
            ((double(n[layer]) + n[layer + 1]) + (double(n[layer + row]) + n[layer + row + 1]));
        solid[cell(i, j, k)] = centre < 0;
      }
  std::vector<Voxel> voxels(grid.cell_count(), Voxel::free);
#pragma omp parallel for
  for (int k = 1; k < nz - 1; ++k)  // the margin around the mesh is free
    for (int j = 1; j < ny - 1; ++j)
      for (int i = 1; i < nx - 1; ++i) {
        if (!solid[cell(i, j, k)]) continue;
        bool enclosed = true;
        for (int z = k - 1; z <= k + 1; ++z)
          for (int y = j - 1; y <= j + 1; ++y) {
            const std::uint8_t* beside = &solid[cell(i - 1, y, z)];
            enclosed = enclosed && beside[0] && beside[1] && beside[2];
          }
        voxels[cell(i, j, k)] = enclosed ? Voxel::interior : Voxel::shell;
      }
  return voxels;
}

}  // namespace remote_touch
