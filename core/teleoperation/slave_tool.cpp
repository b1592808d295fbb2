#include "core/teleoperation/slave_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace remote_touch {

namespace {

constexpr int kToolPointsInLeaf = 4;

struct Cell {
  Vec3 p_T = Vec3::Zero();
  double area_m2 = 0;
};
using Cells = std::map<std::array<int, 3>, Cell>;

void add(Cells& cells, double spacing_m, const Vec3& p_T, double area_m2) {
  const Vec3 at = p_T / spacing_m + Vec3::Constant(0.5);
  std::array<int, 3> key;
  for (std::size_t i = 0; i < 3; ++i) key[i] = static_cast<int>(std::floor(at[static_cast<Eigen::Index>(i)]));
  const auto [place, is_first] = cells.try_emplace(key, Cell{p_T, 0});
  if (p_T.squaredNorm() > place->second.p_T.squaredNorm()) place->second.p_T = p_T;
  place->second.area_m2 += area_m2;
}

double area_of(const std::array<Vec3, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
}

std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  return {at(triangle[0]), at(triangle[1]), at(triangle[2])};
}

// Every corner of a part has a third of the parts that meet in it: one, three or six.
void add(Cells& cells, double spacing_m, const std::array<Vec3, 3>& corners) {
  const double longest_m = std::max(
      {(corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm(), (corners[0] - corners[2]).norm()});
  const int n = std::max(1, static_cast<int>(std::ceil(longest_m / spacing_m)));
  const double third_m2 = area_of(corners) / (3.0 * n * n);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const int borders = (i == 0) + (j == 0) + (i + j == n);
      const int parts = borders == 0 ? 6 : borders == 1 ? 3 : 1;
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
      const Vec3 p_T = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
      add(cells, spacing_m, p_T, parts * third_m2);
    }
}

Cells cells_of(const TriangleMesh& mesh, double spacing_m) {
  Cells cells;
  for (const auto& triangle : mesh.triangles) add(cells, spacing_m, corners_of(mesh, triangle));
  return cells;
}

}  // namespace

SlaveTool make_slave_tool(const TriangleMesh& mesh, const Eigen::Matrix3d& inertia_m2, int max_points) {
  double area_m2 = 0;
  for (const auto& triangle : mesh.triangles) area_m2 += area_of(corners_of(mesh, triangle));
  double spacing_m = std::sqrt(area_m2 / max_points);
  Cells cells = cells_of(mesh, spacing_m);
  while (cells.size() > static_cast<std::size_t>(max_points)) cells = cells_of(mesh, spacing_m *= 1.1);
  SlaveTool tool;
  for (const auto& [key, cell] : cells) {
    tool.points_T.push_back(cell.p_T);
    tool.areas_m2.push_back(cell.area_m2);
    tool.reach_m = std::max(tool.reach_m, cell.p_T.norm());
  }
  tool.gyration_m = std::sqrt(inertia_m2.trace() / 3);
  return tool;
}

SlaveToolTree::SlaveToolTree(const std::vector<Vec3>& points_T)
    : points_T_(points_T), order_(points_T.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  add(0, static_cast<int>(order_.size()));
}

// Returns the index of the new node.
int SlaveToolTree::add(int begin, int end) {
  const auto point = [this](int i) -> const Vec3& { return points_T_[static_cast<std::size_t>(i)]; };
  const auto first = order_.begin() + begin, last = order_.begin() + end;
  Vec3 low = point(*first), high = low;
  for (auto i = first; i != last; ++i) low = low.cwiseMin(point(*i)), high = high.cwiseMax(point(*i));
  Node node{(low + high) / 2, 0, begin, end};
  for (auto i = first; i != last; ++i)
    node.radius_m = std::max(node.radius_m, (point(*i) - node.centre_T).norm());
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back(node);
  if (end - begin <= kToolPointsInLeaf) return index;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(first, last,
            [&](int a, int b) { return std::pair(point(a)[axis], a) < std::pair(point(b)[axis], b); });
  const int middle = begin + (end - begin) / 2;
  const int left = add(begin, middle), right = add(middle, end);
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

}  // namespace remote_touch
