#include "core/mesh/polygon_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/meshes.h"

namespace remote_touch::polygon_triangles_test {
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

TEST(PolygonTriangles, FollowTheShadowOfABentFaceOfFour) {
  const auto triangles = polygon_triangles({{0, 0, 0}, {2, 0, 0.1}, {0.5, 0.5, 0}, {0, 2, 0.1}});
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
}  // namespace remote_touch::polygon_triangles_test
