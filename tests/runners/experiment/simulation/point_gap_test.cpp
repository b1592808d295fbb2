// Gaps between points, compared with every triangle of points by the definition.
#include "runners/experiment/simulation/point_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/scenes.h"

namespace remote_touch::point_gap_test {
namespace {

constexpr double kBall_m = 0.005, kKnown_m = 0.015;

// The centre of the circle through three points of the plane z = 0; nothing for points on a line.
std::optional<Vec3> centre_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d = 2 * (ab.x() * ac.y() - ab.y() * ac.x());
  if (std::abs(d) < 1e-12) return {};
  const double b2 = ab.squaredNorm(), c2 = ac.squaredNorm();
  return a + Vec3(ac.y() * b2 - ab.y() * c2, ab.x() * c2 - ac.x() * b2, 0) / d;
}

// True if no angle of the triangle is obtuse, so that the corners surround the centre of the circle through
// them.
bool holds(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).dot(c - a) >= 0 && (a - b).dot(c - b) >= 0 && (a - c).dot(b - c) >= 0;
}

// The widest gap at the origin of points in the plane z = 0.
double widest_of_all_triangles(const std::vector<Vec3>& points) {
  double widest_m = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const auto centre = centre_of(points[i], points[j], points[k]);
        if (!centre || !holds(points[i], points[j], points[k])) continue;
        const double radius_m = (points[i] - *centre).norm();
        if (radius_m <= kBall_m || centre->norm() > radius_m || centre->norm() + radius_m > kKnown_m)
          continue;
        const bool is_empty = std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
          return (p - *centre).norm() > radius_m - 1e-12;
        });
        if (is_empty) widest_m = std::max(widest_m, radius_m);
      }
  return widest_m;
}

// The points of a plane cloud that lie within kKnown_m of the origin.
std::vector<Vec3> random_points(int count, unsigned seed) {
  const PointCloud cloud = scenes::random_cloud(count, 0.02, seed);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p(cloud.x[i], cloud.y[i], 0);
    if (p.norm() <= kKnown_m) points.push_back(p);
  }
  return points;
}

TEST(PointGap, IsTheWidestOfAllTrianglesOfPoints) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()));
  const Vec3 position(0.1, -0.2, 0.3);
  int gaps = 0, others = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const std::vector<Vec3> points = random_points(5 + static_cast<int>(seed % 56), seed);
    const double expected_m = widest_of_all_triangles(points);
    std::vector<Vec3> placed;
    for (const Vec3& p : points) placed.push_back(rotation * p + position);
    const PointGap gap = widest_gap(placed, position, kBall_m, kKnown_m);
    EXPECT_NEAR(gap.radius_m, expected_m, 1e-9) << seed;
    ++(expected_m > 0 ? gaps : others);
  }
  EXPECT_GT(gaps, 100);
  EXPECT_GT(others, 100);
}

std::vector<Vec3> grid(double columns_m, double rows_m, double from_x_m = -0.015) {
  std::vector<Vec3> points;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j)
      if (const Vec3 p(i * columns_m, j * rows_m, 0); p.norm() <= kKnown_m && p.x() >= from_x_m)
        points.push_back(p);
  return points;
}

// A rectangle with sides a and b leaves a gap of half its diagonal.
TEST(PointGap, IsHalfTheDiagonalOfACellOfAGrid) {
  EXPECT_EQ(widest_gap(grid(0.00707, 0.00707), Vec3::Zero(), kBall_m, kKnown_m).radius_m, 0);
  EXPECT_NEAR(widest_gap(grid(0.00708, 0.00708), Vec3::Zero(), kBall_m, kKnown_m).radius_m,
              0.00708 / std::sqrt(2.0), 1e-12);
  const double lines_m = widest_gap(grid(0.0016, 0.0105), Vec3::Zero(), kBall_m, kKnown_m).radius_m;
  EXPECT_NEAR(lines_m, 0.5 * std::hypot(0.0016, 0.0105), 1e-12);
  EXPECT_EQ(widest_gap(grid(0.0016, 0.0097), Vec3::Zero(), kBall_m, kKnown_m).radius_m, 0);
}

// Points at the border of a dense surface hold no disk beside it.
TEST(PointGap, IsNoneBesideASurface) {
  const PointGap gap = widest_gap(grid(0.0015, 0.0015, -0.001), Vec3::Zero(), kBall_m, kKnown_m);
  EXPECT_EQ(gap.radius_m, 0);
  EXPECT_FALSE(gap.is_decided) << "farther points could be on the other side";
  EXPECT_TRUE(widest_gap(grid(0.0015, 0.0015), Vec3::Zero(), kBall_m, kKnown_m).is_decided);
}

TEST(PointGap, IsNotDecidedForPointsThatDefineNoPlane) {
  const std::vector<Vec3> line = {{0, 0, 0}, {0.001, 0, 0}, {0.003, 0, 0}};
  for (const std::vector<Vec3>& points : {std::vector<Vec3>{}, {Vec3::Zero()}, line}) {
    const PointGap gap = widest_gap(points, Vec3::Zero(), kBall_m, kKnown_m);
    EXPECT_EQ(gap.radius_m, 0);
    EXPECT_FALSE(gap.is_decided);
  }
}

}  // namespace
}  // namespace remote_touch::point_gap_test
