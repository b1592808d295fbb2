#include "core/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/meshes.h"

namespace remote_touch::triangle_mesh_test {
namespace {

using Polygon = std::vector<Vec3>;

Vec3 area_of(const Polygon& p, const std::array<int, 3>& t) {
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]) / 2;
}

Vec3 area_of(const Polygon& p) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) sum += p[i].cross(p[(i + 1) % p.size()]) / 2;
  return sum;
}

// All triangles have the orientation of the polygon, and their areas add up to its area.
void expect_covered(const Polygon& polygon) {
  const auto triangles = polygon_triangles(polygon);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), polygon.size() - 2);
  const Vec3 whole = area_of(polygon);
  double sum = 0;
  for (const auto& triangle : *triangles) {
    EXPECT_GT(area_of(polygon, triangle).dot(whole), 0);
    sum += area_of(polygon, triangle).norm();
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
}

// Checks the polygon with each corner as the first, in both directions, in several planes.
void expect_covered_from_everywhere(Polygon polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    expect_covered(polygon);
    expect_covered({polygon.rbegin(), polygon.rend()});
    Polygon turned;
    for (const Vec3& p : polygon) turned.push_back(meshes::rotated() * p + Vec3(1, 2, 3));
    expect_covered(turned);
  }
}

// A regular polygon, or a star if the step is above one.
Polygon around(int corners, int step) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i * step / corners;
    polygon.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return polygon;
}

TEST(PolygonTriangles, AreAFanForAConvexPolygon) {
  const auto triangles = polygon_triangles(around(6, 1));
  ASSERT_TRUE(triangles);
  EXPECT_EQ(*triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
}

TEST(PolygonTriangles, LeaveTheNotchesOfConcavePolygonsEmpty) {
  expect_covered_from_everywhere(
      {{4, 4, 0}, {4, 1, 0}, {2, 1, 0}, {2, 4, 0}, {0, 4, 0}, {0, 0, 0}, {6, 0, 0}, {6, 4, 0}});
  expect_covered_from_everywhere({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}});  // an arrow
}

TEST(PolygonTriangles, CoverAStarAndAComb) {
  Polygon star = around(14, 1), comb{{0, 0, 0}, {21, 0, 0}};
  for (std::size_t i = 0; i < star.size(); i += 2) star[i] *= 0.2;
  expect_covered_from_everywhere(star);
  for (int x = 20; x >= 0; --x) comb.emplace_back(x, x % 2 == 0 ? 5 : 1, 0);
  expect_covered_from_everywhere(comb);
}

TEST(PolygonTriangles, HaveAnAreaAlsoIfCornersLieOnStraightEdges) {
  expect_covered_from_everywhere(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
}

// The triangles of a polygon that is not flat have its area as seen along its normal, and none is turned.
bool is_covered_along_normal(const Polygon& polygon) {
  const auto triangles = polygon_triangles(polygon);
  if (!triangles) return false;
  const Vec3 whole = area_of(polygon), normal = whole.normalized();
  double sum = 0;
  for (const auto& triangle : *triangles) {
    EXPECT_GT(area_of(polygon, triangle).dot(normal), 0);
    sum += area_of(polygon, triangle).dot(normal);
  }
  EXPECT_EQ(triangles->size(), polygon.size() - 2);
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
  return true;
}

// True if two edges that are no neighbours meet, seen along the normal. The polygon has no straight corner.
bool crosses_itself(const Polygon& polygon) {
  const Vec3 normal = area_of(polygon).normalized();
  const auto turn = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a).cross(c - a).dot(normal);
  };
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      const Vec3 &a = polygon[i], &b = polygon[i + 1], &c = polygon[j], &d = polygon[(j + 1) % n];
      if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
    }
  return false;
}

// Random polygons that are not quite flat, concave and crossing ones: the answer depends neither on the axes,
// nor on the corner that comes first, nor on the direction.
TEST(PolygonTriangles, DependOnTheShapeOfABentPolygonAlone) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  int covered = 0, refused = 0;
  for (int i = 0; i < 600; ++i) {
    Polygon polygon;
    for (int corner = 0; corner < 4 + i % 3; ++corner)
      polygon.emplace_back(any(random), any(random), 0.03 * any(random));
    if (area_of(polygon).norm() < 0.05) continue;  // the normal of such a polygon is that of its bends
    const bool expected = !crosses_itself(polygon);
    (expected ? covered : refused) += 1;
    const Vec3 axis = Vec3(any(random), any(random), any(random)).normalized();
    for (const Eigen::Matrix3d& turned : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), meshes::rotated(),
                                          Eigen::AngleAxisd(3 * any(random), axis).toRotationMatrix()})
      for (std::size_t first = 0; first < polygon.size(); ++first) {
        Polygon same;
        for (std::size_t j = 0; j < polygon.size(); ++j)
          same.push_back(turned * polygon[(first + j) % polygon.size()] + Vec3(1, 2, 3));
        ASSERT_EQ(is_covered_along_normal(same), expected) << i << " " << first;
        ASSERT_EQ(is_covered_along_normal({same.rbegin(), same.rend()}), expected) << i << " " << first;
      }
  }
  EXPECT_GT(covered, 150);
  EXPECT_GT(refused, 150);
}

// Seen along x, the axis nearest to its normal, the edges of this dart meet.
TEST(PolygonTriangles, FollowTheNormalOfABentDart) {
  const auto triangles = polygon_triangles(
      {{-0.011, 0.008, 0.004}, {-0.002, 0.092, -0.075}, {-0.010, 0.025, -0.012}, {-0.071, 0.052, 0.057}});
  ASSERT_TRUE(triangles);
  for (const auto& triangle : *triangles)
    EXPECT_EQ(
        std::count(triangle.begin(), triangle.end(), 0) + std::count(triangle.begin(), triangle.end(), 2), 2);
}

TEST(PolygonTriangles, DoNotExistWhereEdgesCrossOrTouch) {
  EXPECT_FALSE(polygon_triangles({{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}}));  // figure 8, unequal loops
  EXPECT_FALSE(polygon_triangles({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));  // equal loops: no area
  EXPECT_FALSE(polygon_triangles(around(5, 2)));
  Polygon twice = around(4, 1);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 4);
  EXPECT_FALSE(polygon_triangles(twice));
  EXPECT_FALSE(
      polygon_triangles({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}));  // touches an edge
  EXPECT_FALSE(
      polygon_triangles({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {9, 2, 0}, {4, 2, 0}, {0, 4, 0}}));  // a spike
}

TEST(PolygonTriangles, AreAFanForAPolygonWithoutArea) {
  const auto triangles = polygon_triangles({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}});
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 2u);
}

}  // namespace
}  // namespace remote_touch::triangle_mesh_test
