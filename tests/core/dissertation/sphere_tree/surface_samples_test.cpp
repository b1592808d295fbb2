#include "core/dissertation/sphere_tree/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::surface_samples_test {
namespace {

// Its longest side is the second.
const TriangleMesh kTriangle{{{0.01, 0, 0}, {0, 0, 0.03}, {0, 0.04, 0}}, {{0, 1, 2}}};

double distance(const Vec3& place, const std::vector<Vec3>& samples) {
  double min = 1;
  for (const Vec3& sample : samples) min = std::min(min, (place - sample).norm());
  return min;
}

// Two random numbers give a point of the triangle. Points beyond its third side are reflected into it.
std::vector<Vec3> places_of_triangle() {
  std::vector<Vec3> places;
  const PointCloud cloud = scenes::random_cloud(2000, 1, 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    double u = std::abs(cloud.point(i).x()), v = std::abs(cloud.point(i).y());
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& corner = kTriangle.vertices;
    places.push_back(corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]));
  }
  return places;
}

TEST(SurfaceSamples, LeaveNoPlaceOfATriangleOut) {
  for (const double spacing_m : {0.001, 0.004, 0.0101, 1.0}) {
    const std::vector<Vec3> samples = surface_samples(kTriangle, spacing_m);
    for (const Vec3& corner : kTriangle.vertices) EXPECT_LT(distance(corner, samples), 1e-12) << spacing_m;
    for (const Vec3& place : places_of_triangle())
      EXPECT_LT(distance(place, samples), std::min(spacing_m, 0.03));
  }
}

TEST(SurfaceSamples, AreOfTheTriangle) {
  const auto& v = kTriangle.vertices;
  const Vec3 normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  for (const Vec3& sample : surface_samples(kTriangle, 0.002)) {
    EXPECT_NEAR(normal.dot(sample - v[0]), 0, 1e-15);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 inwards = normal.cross(v[(i + 1) % 3] - v[i]);
      EXPECT_GT(inwards.dot(sample - v[i]), -1e-15);
    }
  }
}

TEST(SurfaceSamples, OnePlaceOfACubeIsKept) {
  const std::vector<Vec3> kept =
      thinned({{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, {1.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}, 1);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0], Vec3(0.1, 0.1, 0.1));
  EXPECT_EQ(kept[1], Vec3(1.1, 0.1, 0.1));
}

TEST(SurfaceSamples, HaveTheAreaOfABox) {
  EXPECT_NEAR(surface_area_m2(scenes::box_mesh({0.01, 0.02, 0.03})), 8 * (1 * 2 + 1 * 3 + 2 * 3) * 1e-4,
              1e-12);
}

}  // namespace
}  // namespace remote_touch::surface_samples_test
