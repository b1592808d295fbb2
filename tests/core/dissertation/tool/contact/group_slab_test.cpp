#include "core/dissertation/tool/contact/group_slab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace remote_touch::group_slab_test {
namespace {

void expect_holds(const GroupSlab& slab, const std::vector<Vec3>& points) {
  for (const Vec3& p : points) {
    EXPECT_LE((p - slab.centre_W).norm(), slab.radius_m);
    if (slab.n_W.isZero(0)) continue;
    EXPECT_LE(std::abs(slab.n_W.dot(p - slab.centre_W)), slab.half_m);
    EXPECT_NEAR(slab.n_W.norm(), 1, 1e-12);
  }
}

TEST(GroupSlab, HoldsItsPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 scale_m = 1e-3 * Vec3(any(random), any(random), n % 3 == 0 ? 0 : any(random));
    std::vector<Vec3> points;
    for (int i = 0; i <= n % 8; ++i)
      points.push_back(Vec3(0.3, -2, 1) + scale_m.cwiseProduct(Vec3(any(random), any(random), any(random))));
    expect_holds(group_slab(points), points);
  }
}

TEST(GroupSlab, IsThinOnASurface) {
  std::vector<Vec3> points;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column) points.push_back(Vec3(column, row, 0.5 * column) * 3e-4);
  points[5].z() += 2e-6;
  const GroupSlab slab = group_slab(points);
  EXPECT_LT(slab.half_m, 4e-6);
  EXPECT_GT(std::abs(slab.n_W.dot(Vec3(-0.5, 0, 1).normalized())), 0.999);
  expect_holds(slab, points);
}

TEST(GroupSlab, PointsOnALineHaveABall) {
  const std::vector<Vec3> line{Vec3::Zero(), Vec3(1e-3, 0, 0), Vec3(2e-3, 0, 0)}, same(8, Vec3(1, 2, 3));
  for (const auto& points : {line, same, {Vec3(1, 2, 3)}}) {
    const GroupSlab slab = group_slab(points);
    EXPECT_TRUE(slab.n_W.isZero(0));
    EXPECT_EQ(slab.half_m, 0);
    expect_holds(slab, points);
  }
}

TEST(NormalCone, HoldsTheFiniteNormals) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> normals{Vec3::UnitX(), Vec3::Constant(nan), Vec3(1, 1, 0).normalized(),
                                  Vec3::UnitX()};
  const NormalCone cone = normal_cone(normals);
  for (const std::size_t i : {0u, 2u, 3u}) EXPECT_LE((normals[i] - cone.middle_W).norm(), cone.deviation);
  EXPECT_LT(cone.deviation, 0.6);
  for (const auto& none : {std::vector<Vec3>{}, {Vec3::Constant(nan)}}) {
    EXPECT_TRUE(normal_cone(none).middle_W.isZero(0));
    EXPECT_EQ(normal_cone(none).deviation, 0);
  }
}

}  // namespace
}  // namespace remote_touch::group_slab_test
