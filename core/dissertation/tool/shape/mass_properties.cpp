#include "core/dissertation/tool/shape/mass_properties.h"

namespace remote_touch {

namespace {

// I = tr(S) 1 - S for the second moments S = integral of x x^T about the centre.
Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moments) {
  return second_moments.trace() * Eigen::Matrix3d::Identity() - second_moments;
}

}  // namespace

// The integrals over a tetrahedron (0, a, b, c) of volume V are V (a + b + c) / 4 for x, and
// V (s s^T + a a^T + b b^T + c c^T) / 20 for x x^T, with s = a + b + c.
MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties all;
  if (mesh.vertices.empty()) return all;
  const Vec3 o = mesh.vertices.front();
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.vertices[i] - o, b = mesh.vertices[j] - o, c = mesh.vertices[k] - o;
    const Vec3 sum = a + b + c;
    const double volume = a.dot(b.cross(c)) / 6;
    all.volume_m3 += volume;
    first += volume / 4 * sum;
    second +=
        volume / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (all.volume_m3 == 0) return all;
  const Vec3 mean = first / all.volume_m3;
  all.centre = o + mean;
  all.inertia_m2 = inertia_of(second / all.volume_m3 - mean * mean.transpose());
  return all;
}

MassProperties mass_properties(const VoxelGrid& grid, const std::vector<std::uint8_t>& inside_nodes) {
  // The sums are integers in units of the voxel, so that nothing is lost over millions of nodes.
  const std::size_t columns = grid.cells[0] + 1, rows = grid.cells[1] + 1;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t n = 0; n < inside_nodes.size(); ++n) {
    if (!inside_nodes[n]) continue;
    const std::size_t i = n % columns, j = n / columns % rows, k = n / columns / rows;
    const Vec3 at(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    ++count, first += at, second += at * at.transpose();
  }
  MassProperties all;
  if (count == 0) return all;
  const double size = grid.size_m;
  const Vec3 mean = first / count;
  all.volume_m3 = count * size * size * size;
  all.centre = grid.origin_T + size * mean;
  const Eigen::Matrix3d own = Eigen::Matrix3d::Identity() / 12;  // second moments of each cube
  all.inertia_m2 = size * size * inertia_of(second / count - mean * mean.transpose() + own);
  return all;
}

}  // namespace remote_touch
