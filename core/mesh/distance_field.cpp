#include "core/mesh/distance_field.h"

#include <limits>

namespace remote_touch {
namespace {

constexpr int kCubeSize = 4;  // cells along a cube

// The triangles that are nearest to the corners of all cubes.
class CubeCorners {
 public:
  CubeCorners(const TriangleTree& tree, const VoxelGrid& grid) : tree_(tree), grid_(grid) {
    for (int i = 0; i < 3; ++i) corners_[i] = cubes(i) + 1;
    nearest_.resize(std::size_t(corners_[0]) * corners_[1] * corners_[2]);
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < corners_[2]; ++k)
      for (int j = 0; j < corners_[1]; ++j) {
        TriangleTree::Nearest found;
        for (int i = 0; i < corners_[0]; ++i)
          nearest_[index(i, j, k)] = found =
              tree.nearest(place(kCubeSize * i, kCubeSize * j, kCubeSize * k), found.face);
      }
  }

  int cubes(int axis) const {
    return grid_.cells[axis] / kCubeSize + 1;
  }  // the last may reach out of the grid

  Vec3 place(int i, int j, int k) const {
    return grid_.origin_T + grid_.size_m * Vec3(i, j, k);
  }

  // The faces nearest to the corners of a cube, each once. The first one belongs to the first corner.
  struct Faces {
    std::array<int, 8> face;
    int count = 0;
    bool near = false;  // a position within kExactField_m of the surface may be in the cube
  };
  Faces around(int i, int j, int k) const {
    Faces faces;
    double squared = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 8; ++c) {
      const auto& corner = nearest_[index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))];
      squared = std::min(squared, corner.squared_m2);
      const auto end = faces.face.begin() + faces.count;
      if (std::find(faces.face.begin(), end, corner.face) == end) faces.face[faces.count++] = corner.face;
    }
    // Largest distance from a position in the cube to the nearest corner.
    const double to_corner = std::sqrt(3.0) / 2 * kCubeSize * grid_.size_m;
    faces.near = std::sqrt(squared) <= kExactField_m + to_corner;
    return faces;
  }

  // Returns the distance from p to the nearest of these faces.
  double upper_bound(const Faces& faces, const Vec3& p) const {
    double squared = tree_.squared_to(faces.face[0], p);
    for (int f = 1; f < faces.count; ++f) squared = std::min(squared, tree_.squared_to(faces.face[f], p));
    return std::sqrt(squared);
  }

 private:
  std::size_t index(int i, int j, int k) const {
    return i + corners_[0] * (j + std::size_t(corners_[1]) * k);
  }

  const TriangleTree& tree_;
  const VoxelGrid& grid_;
  std::array<int, 3> corners_;
  std::vector<TriangleTree::Nearest> nearest_;
};

// Finds the nearest of a list of faces. A face is evaluated only if a ball around it comes nearer than the
// best so far.
class NearFaces {
 public:
  // Gathers all faces that can be nearest to a position within radius_m of the centre. upper_m: distance from
  // the centre to some face, as an upper bound of the distance to the nearest one.
  void gather(const TriangleTree& tree, const Vec3& centre, double radius_m, double upper_m) {
    centre_ = centre;
    tree.faces_within(centre, upper_m + 2 * radius_m, faces_);
  }

  double distance(const TriangleTree& tree, const Vec3& p) const {
    const double to_centre = (p - centre_).norm();
    double best = std::numeric_limits<double>::infinity();
    for (const auto& face : faces_) {
      if (face.distance_m - to_centre > best) break;
      const double reach = best + face.radius;
      if ((p - face.middle).squaredNorm() < reach * reach)
        best = std::min(best, std::sqrt(tree.squared_to(face.face, p)));
    }
    return best;
  }

 private:
  Vec3 centre_ = Vec3::Zero();
  std::vector<TriangleTree::Candidate> faces_;
};

}  // namespace

std::vector<float> distance_field(const TriangleTree& tree, const VoxelGrid& grid,
                                  const std::vector<std::uint8_t>& inside_nodes) {
  std::vector<float> field(grid.node_count());
  const CubeCorners corners(tree, grid);
  const std::size_t columns = grid.cells[0] + 1, rows = grid.cells[1] + 1;
  const double half = 0.5 * (kCubeSize - 1) * grid.size_m;  // a cube's own nodes are 0 to kCubeSize - 1
  const int rows_of_cubes = corners.cubes(1) * corners.cubes(2);
#pragma omp parallel for schedule(dynamic)
  for (int row = 0; row < rows_of_cubes; ++row) {
    const int cj = row % corners.cubes(1), ck = row / corners.cubes(1);
    NearFaces near;
    for (int ci = 0; ci < corners.cubes(0); ++ci) {
      const CubeCorners::Faces faces = corners.around(ci, cj, ck);
      if (faces.near) {
        const Vec3 middle =
            corners.place(kCubeSize * ci, kCubeSize * cj, kCubeSize * ck) + Vec3::Constant(half);
        near.gather(tree, middle, std::sqrt(3.0) * half, corners.upper_bound(faces, middle));
      }
      for (int k = kCubeSize * ck; k <= std::min(kCubeSize * ck + kCubeSize - 1, grid.cells[2]); ++k)
        for (int j = kCubeSize * cj; j <= std::min(kCubeSize * cj + kCubeSize - 1, grid.cells[1]); ++j)
          for (int i = kCubeSize * ci; i <= std::min(kCubeSize * ci + kCubeSize - 1, grid.cells[0]); ++i) {
            const std::size_t node = i + columns * (j + rows * k);
            const Vec3 p = corners.place(i, j, k);
            const double distance = faces.near ? near.distance(tree, p) : corners.upper_bound(faces, p);
            field[node] = static_cast<float>(inside_nodes[node] ? -distance : distance);
          }
    }
  }
  return field;
}

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

SlopeBlocks::SlopeBlocks(const VoxelGrid& grid, const std::vector<float>& distance_m) : cells_(grid.cells) {
  for (int axis = 0; axis < 3; ++axis) blocks_[axis] = (cells_[axis] + kSize - 1) / kSize;
  ranges_.resize(std::size_t(blocks_[0]) * blocks_[1] * blocks_[2]);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < blocks_[2]; ++k)
    for (int j = 0; j < blocks_[1]; ++j)
      for (int i = 0; i < blocks_[0]; ++i)
        ranges_[i + blocks_[0] * (j + std::size_t(blocks_[1]) * k)] =
            range_around(grid, distance_m, {i, j, k});
}

// The derivative of a trilinear field along an axis lies between those along the four edges of the cell.
SlopeBlocks::Range SlopeBlocks::range_around(const VoxelGrid& grid, const std::vector<float>& distance_m,
                                             const std::array<int, 3>& block) const {
  const std::size_t row = grid.cells[0] + std::size_t(1), layer = row * (grid.cells[1] + std::size_t(1));
  const std::size_t next[3] = {1, row, layer};
  std::array<int, 3> first, last;  // nodes
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(kSize * block[axis] - kAround, 0);
    last[axis] = std::min(kSize * (block[axis] + 1) + kAround, cells_[axis]);
  }
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range[2 * axis] = std::numeric_limits<float>::max();
    range[2 * axis + 1] = std::numeric_limits<float>::lowest();
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const std::size_t node = i + row * j + layer * k;
        const int at[3] = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] == last[axis]) continue;
          const float change = distance_m[node + next[axis]] - distance_m[node];
          range[2 * axis] = std::min(range[2 * axis], change);
          range[2 * axis + 1] = std::max(range[2 * axis + 1], change);
        }
      }
  return range;
}

double SlopeBlocks::min_change_m(const Vec3& at, const Vec3& along) const {
  constexpr double kUnknown = -std::numeric_limits<double>::infinity();
  std::size_t block[3];
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_known =
        at[axis] >= 0 && at[axis] < cells_[axis] && std::abs(along[axis]) <= kAround;  // false for NaN
    if (!is_known) return kUnknown;
    block[axis] = static_cast<std::size_t>(at[axis]) / kSize;
  }
  const Range& range = ranges_[block[0] + blocks_[0] * (block[1] + std::size_t(blocks_[1]) * block[2])];
  double change_m = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double by = along[static_cast<int>(axis)];
    change_m += std::min(by * range[2 * axis], by * range[2 * axis + 1]);
  }
  return std::min(change_m, 0.0);
}

}  // namespace remote_touch
