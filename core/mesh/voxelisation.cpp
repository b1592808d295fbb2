#include "core/mesh/voxel_tool.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/points/vector.h"

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
struct TriangleCorners {
  Vec3 v[3], normal;
};

// True if the triangle touches the box of centre c and half sides h. It does not if their projections are
// apart on one of these axes: three of the box, the normal, nine products of edges.
bool touches(const TriangleCorners& triangle, const Vec3& c, const Vec3& h) {
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
void mark(const TriangleCorners& triangle, const VoxelGrid& grid, Cell low, Cell high,
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
      TriangleCorners triangle;
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

namespace {

// Finds the nodes of a grid that are inside a mesh. A closed mesh is crossed by lines through the nodes; an
// open one is evaluated by winding numbers.

// A vertex in the grid: x in voxels, y and z in integer units. One voxel is `unit` of them.
struct Snapped {
  double x;
  std::int64_t y, z;
};

// Twice the area of the triangle that the edge u v forms with q; exact. Its sign is the side of the edge on
// which q lies. If q is on the line of the edge, it is treated as if it were moved by (e, e^2) with a tiny e.
// So both triangles of an edge agree on the side.
struct Side {
  std::int64_t area;
  int sign;
};
Side side_of(const Snapped& u, const Snapped& v, std::int64_t y, std::int64_t z) {
  const std::int64_t dy = v.y - u.y, dz = v.z - u.z;
  const std::int64_t area = dy * (z - u.z) - dz * (y - u.y);
  const std::int64_t first = area != 0 ? area : dz != 0 ? -dz : dy;
  return {area, (first > 0) - (first < 0)};
}

// Returns the number of units per voxel. Units are as small as possible while products of differences stay
// below 2^62.
std::int64_t unit_for(const VoxelGrid& grid) {
  std::int64_t unit = 1 << 20;
  while (unit > 1 && (std::max(grid.cells[1], grid.cells[2]) + 1) * unit > (std::int64_t(1) << 29)) unit /= 2;
  return unit;
}

// Adds the crossing of a triangle and the line along x through q, if they cross. The crossing changes the
// winding number of all nodes from there on. It decreases the number if the line leaves the solid there in
// the direction of x.
void cross(const Snapped& a, const Snapped& b, const Snapped& c, std::int64_t y, std::int64_t z, int columns,
           int* row) {
  const Side bc = side_of(b, c, y, z), ca = side_of(c, a, y, z), ab = side_of(a, b, y, z);
  if (bc.sign == 0 || bc.sign != ca.sign || bc.sign != ab.sign) return;
  const double wa = static_cast<double>(bc.area), wb = static_cast<double>(ca.area);
  const double wc = static_cast<double>(ab.area);
  const double x = (wa * a.x + wb * b.x + wc * c.x) / (wa + wb + wc);
  const double node = std::max(0.0, std::ceil(x));
  if (node < columns) row[static_cast<int>(node)] -= bc.sign;
}

// Returns the first and the last node in a range of units, within 0 to last.
std::array<int, 2> nodes_within(std::int64_t low, std::int64_t high, std::int64_t unit, int last) {
  const std::int64_t first = low <= 0 ? 0 : (low + unit - 1) / unit;
  return {static_cast<int>(first),
          static_cast<int>(std::min<std::int64_t>(high < 0 ? -1 : high / unit, last))};
}

}  // namespace

InsideNodes inside_nodes(const TriangleMesh& mesh, const VoxelGrid& grid) {
  const std::int64_t unit = unit_for(grid);
  std::vector<Snapped> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    const Vec3 at = (v - grid.origin_T) / grid.size_m;
    vertices.push_back({at.x(), std::llround(at.y() * unit), std::llround(at.z() * unit)});
  }
  const int columns = grid.cells[0] + 1, rows = grid.cells[1] + 1, layers = grid.cells[2] + 1;
  InsideNodes nodes{std::vector<std::uint8_t>(grid.node_count(), 0), false};
  int negative = 0;
#pragma omp parallel for schedule(dynamic) reduction(+ : negative)
  for (int k = 0; k < layers; ++k) {
    std::vector<int> change(std::size_t(columns) * rows, 0);
    for (const auto& triangle : mesh.triangles) {
      const Snapped &a = vertices[triangle[0]], &b = vertices[triangle[1]], &c = vertices[triangle[2]];
      if (std::min({a.z, b.z, c.z}) > k * unit || std::max({a.z, b.z, c.z}) < k * unit) continue;
      const auto [first, last] =
          nodes_within(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), unit, rows - 1);
      for (int j = first; j <= last; ++j)
        cross(a, b, c, j * unit, k * unit, columns, &change[std::size_t(columns) * j]);
    }
    for (int j = 0; j < rows; ++j) {
      int winding = 0;
      for (int i = 0; i < columns; ++i) {
        winding += change[std::size_t(columns) * j + i];
        nodes.inside[i + columns * (j + std::size_t(rows) * k)] = winding > 0;
        negative += winding < 0;
      }
    }
  }
  nodes.negative = negative > 0;
  return nodes;
}

namespace {

constexpr int kBlockSize = 4;

// True if the winding number is above 1/2 by more than rounding. A node at which symmetry makes it 1/2 is
// outside on every machine.
bool is_inside(const TriangleTree& tree, const VoxelGrid& grid, int i, int j, int k) {
  return tree.winding_number(grid.origin_T + grid.size_m * Vec3(i, j, k)) > 0.5 + 1e-9;
}

bool has_crossed(const VoxelGrid& grid, const std::vector<std::uint8_t>& crossed, int i0, int j0, int k0) {
  for (int k = k0; k < std::min(k0 + kBlockSize, grid.cells[2]); ++k)
    for (int j = j0; j < std::min(j0 + kBlockSize, grid.cells[1]); ++j)
      for (int i = i0; i < std::min(i0 + kBlockSize, grid.cells[0]); ++i)
        if (crossed[i + grid.cells[0] * (j + std::size_t(grid.cells[1]) * k)]) return true;
  return false;
}

}  // namespace

std::vector<std::uint8_t> inside_nodes_of_open(const TriangleTree& tree, const VoxelGrid& grid,
                                               const std::vector<std::uint8_t>& crossed) {
  std::array<int, 3> blocks, corners;
  for (int a = 0; a < 3; ++a) blocks[a] = grid.cells[a] / kBlockSize + 1, corners[a] = blocks[a] + 1;
  std::vector<std::uint8_t> corner(std::size_t(corners[0]) * corners[1] * corners[2]);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < corners[2]; ++k)
    for (int j = 0; j < corners[1]; ++j)
      for (int i = 0; i < corners[0]; ++i)
        corner[i + corners[0] * (j + std::size_t(corners[1]) * k)] =
            is_inside(tree, grid, kBlockSize * i, kBlockSize * j, kBlockSize * k);
  std::vector<std::uint8_t> inside(grid.node_count());
#pragma omp parallel for schedule(dynamic)
  for (int bk = 0; bk < blocks[2]; ++bk)
    for (int bj = 0; bj < blocks[1]; ++bj)
      for (int bi = 0; bi < blocks[0]; ++bi) {
        int set = 0;
        for (int c = 0; c < 8; ++c)
          set += corner[bi + (c & 1) +
                        corners[0] * (bj + (c >> 1 & 1) + std::size_t(corners[1]) * (bk + (c >> 2)))];
        const bool mixed = (set > 0 && set < 8) ||
                           has_crossed(grid, crossed, kBlockSize * bi, kBlockSize * bj, kBlockSize * bk);
        for (int k = kBlockSize * bk; k < std::min(kBlockSize * (bk + 1), grid.cells[2] + 1); ++k)
          for (int j = kBlockSize * bj; j < std::min(kBlockSize * (bj + 1), grid.cells[1] + 1); ++j)
            for (int i = kBlockSize * bi; i < std::min(kBlockSize * (bi + 1), grid.cells[0] + 1); ++i)
              inside[i + (grid.cells[0] + std::size_t(1)) * (j + (grid.cells[1] + std::size_t(1)) * k)] =
                  mixed ? is_inside(tree, grid, i, j, k) : set > 0;
      }
  return inside;
}

}  // namespace remote_touch
