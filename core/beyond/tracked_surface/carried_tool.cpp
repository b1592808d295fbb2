#include "core/beyond/tracked_surface/carried_tool.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/beyond/tracked_surface/height_map.h"
#include "core/points/vector.h"

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

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Converts a motion (t, lever w) of a body about one position to the same motion about another, `by` away
// from it.
Matrix6 transport(const Vec3& by, double lever_m) {
  Matrix6 m = Matrix6::Identity();  // t' = t + w x by
  m.block<3, 3>(0, 3) << 0, by.z(), -by.y(), -by.z(), 0, by.x(), by.y(), -by.x(), 0;
  m.block<3, 3>(0, 3) /= lever_m;
  return m;
}

}  // namespace

ToolPositions::ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups) {
  assert(!mesh.vertices.empty() && group_radius_m > 0 && max_groups > 0);
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

void CarriedMotion::add(const CarriedPosition& position) {
  if (empty()) first_W_ = position.p_W;
  const Vec3 r = position.p_W - first_W_;
  Vector6 row;
  row << position.normal_W, r.cross(position.normal_W) / lever_m_;
  rows_ += position.weight * row * row.transpose();
  right_ += position.weight * position.moved_m * row;
  weight_ += position.weight;
  sum_m_ += position.weight * r;
  error_m_ += position.weight * position.error_m;
}

CarriedMotion::Result CarriedMotion::about(const Vec3& about_W, const Vector6& expected) const {
  Result result;
  if (empty()) return result;
  const Vec3 middle = sum_m_ / weight_;
  // Rows about the first position are converted to rows about the mean: row . x = row . T^-1 x'.
  const Matrix6 back = transport(-middle, lever_m_);
  const Matrix6 a = back.transpose() * rows_ * back / weight_;
  const Vector6 b = back.transpose() * right_ / weight_;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(a);
  const Vec3 centre = about_W - first_W_ - middle;
  Vector6 before = expected;
  before.tail<3>() *= lever_m_;
  before = transport(-centre, lever_m_) * before;
  Vector6 x = Vector6::Zero(), shrunk_x = Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value >= kObservable)) continue;
    const Vector6 axis = eigen.eigenvectors().col(k);
    const double along = axis.dot(b) / value, before_along = axis.dot(before);
    const double error_m = error_m_ / weight_ / std::sqrt(value);
    x += along * axis, shrunk_x += (before_along + shrunk(along - before_along, error_m)) * axis;
  }
  for (auto& [from, to] :
       {std::pair<const Vector6&, Vector6&>(x, result.motion), {shrunk_x, result.shrunk}}) {
    to = transport(centre, lever_m_) * from;
    to.tail<3>() /= lever_m_;
  }
  result.known = true;
  return result;
}

}  // namespace remote_touch
