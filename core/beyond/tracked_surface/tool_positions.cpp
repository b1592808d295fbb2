#include "core/beyond/tracked_surface/tool_positions.h"

#include <algorithm>
#include <limits>

#include "core/geometry/bounding_box.h"

namespace remote_touch {

namespace {

// Returns the vertices, and points of the triangles no farther apart than spacing_m, or than a hundredth of
// the longest side of a very large triangle.
std::vector<Vec3> surface_points(const TriangleMesh& mesh, double spacing_m) {
  std::vector<Vec3> points = mesh.vertices;
  for (const auto& corners : mesh.triangles) {
    const Vec3 &a = mesh.vertices[static_cast<std::size_t>(corners[0])],
               &b = mesh.vertices[static_cast<std::size_t>(corners[1])],
               &c = mesh.vertices[static_cast<std::size_t>(corners[2])];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    constexpr double kMostAlong = 100;
    const int n = static_cast<int>(std::min(std::ceil(longest / spacing_m), kMostAlong));
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j <= n; ++j)
        if (i + j > 0 && j < n)
          points.push_back(a + (static_cast<double>(i) / n) * (b - a) +
                           (static_cast<double>(j) / n) * (c - a));
  }
  return points;
}

// Stores for every point the squared distance to the nearest chosen point.
class FarthestPoints {
 public:
  explicit FarthestPoints(std::span<const Vec3> points)
      : points_(points),
        nearest_(points.size(), std::numeric_limits<double>::infinity()),
        of_(points.size(), 0) {}
  void choose(std::size_t point) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (const double d = (points_[i] - points_[point]).squaredNorm(); d < nearest_[i])
        nearest_[i] = d, of_[i] = count_;
    ++count_;
  }
  std::size_t farthest() const {
    return static_cast<std::size_t>(std::max_element(nearest_.begin(), nearest_.end()) - nearest_.begin());
  }
  double squared_distance(std::size_t point) const { return nearest_[point]; }
  std::size_t chosen_for(std::size_t point) const { return of_[point]; }

 private:
  std::span<const Vec3> points_;
  std::vector<double> nearest_;
  std::vector<std::size_t> of_;
  std::size_t count_ = 0;
};

}  // namespace

ToolPositions::ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups) {
  const double spacing_m = 0.125 * group_radius_m;
  const std::vector<Vec3> points = surface_points(mesh, spacing_m);
  FarthestPoints spread(points);
  for (std::size_t next = 0; positions_T_.size() < kMax; next = spread.farthest()) {
    positions_T_.push_back(points[next]);
    spread.choose(next);
    if (spread.squared_distance(spread.farthest()) <= spacing_m * spacing_m) break;
  }
  for (std::size_t groups = 1; groups <= max_groups; ++groups) {
    divide(groups);
    double widest_m = 0;
    for (const Group& group : groups_) widest_m = std::max(widest_m, group.radius_m);
    if (widest_m <= group_radius_m) break;
  }
}

// Divides the positions into groups around positions that are far from each other.
void ToolPositions::divide(std::size_t groups) {
  FarthestPoints seeds(positions_T_);
  std::size_t seed = 0;
  for (std::size_t g = 0; g < groups; ++g, seed = seeds.farthest()) seeds.choose(seed);
  std::vector<Vec3> sorted;
  groups_.clear();
  for (std::size_t g = 0; g < groups; ++g) {
    Group group;
    group.first = sorted.size();
    BoundingBox box;
    for (std::size_t i = 0; i < positions_T_.size(); ++i)
      if (seeds.chosen_for(i) == g) sorted.push_back(positions_T_[i]), box.extend(positions_T_[i]);
    group.count = sorted.size() - group.first;
    if (group.count == 0) continue;
    group.middle_T = 0.5 * (box.min() + box.max());
    for (std::size_t i = group.first; i < sorted.size(); ++i)
      group.radius_m = std::max(group.radius_m, (sorted[i] - group.middle_T).norm());
    groups_.push_back(group);
  }
  positions_T_ = std::move(sorted);
}

}  // namespace remote_touch
