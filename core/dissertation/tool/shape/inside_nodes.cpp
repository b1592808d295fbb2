// Finds the nodes of a grid that are inside a mesh. A closed mesh is crossed by lines through the nodes; an
// open one is evaluated by winding numbers.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/dissertation/tool/shape/voxelisation.h"

namespace remote_touch {

namespace {

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
