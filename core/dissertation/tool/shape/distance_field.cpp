#include "core/dissertation/tool/shape/distance_field.h"

#include <algorithm>
#include <cmath>
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

}  // namespace remote_touch
