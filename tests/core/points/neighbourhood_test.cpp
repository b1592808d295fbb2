#include "core/points/neighbourhood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

namespace remote_touch::neighbourhood_test {
namespace {

constexpr double kReach = 0.01, kContactRadius = 0.005;

std::shared_ptr<const NeighbourSearch> cloud_with_fixtures() {
  PointCloud cloud = scenes::random_cloud(4000, 0.05, 21);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.fixture_radius_m.push_back(i % 3 == 0 ? 0.004 : 0);
  return std::make_shared<BruteForceSearch>(cloud);
}

// Wherever in its cube the position lies, no point within reach may be missing from the list.
TEST(Neighbourhood, ListHoldsEveryRegionWithinReach) {
  const auto points = cloud_with_fixtures();
  const PointCloud& cloud = *points->stored_cloud();
  Neighbourhood near = scenes::neighbourhood(points, kReach);
  const PointCloud places = scenes::random_cloud(2000, 0.04, 22);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Vec3 p = places.point(k);
    const GatheredPoints& list = near.around(p);
    std::vector<bool> listed(cloud.size(), false);
    for (std::size_t i = 0; i < list.size(); ++i) listed[list.index()[i]] = true;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if ((p - cloud.point(i)).norm() - cloud.fixture_radius_m[i] <= kReach) {
        ASSERT_TRUE(listed[i]) << k;
      }
    }
  }
}

// The path has short and long steps, so that the list is narrow at some positions and not at others. A narrow
// list has every point within the reach, and fewer points beyond it than the list of around().
TEST(Neighbourhood, NarrowedListHoldsEveryRegionWithinReach) {
  const auto points = cloud_with_fixtures();
  const PointCloud& cloud = *points->stored_cloud();
  Neighbourhood near = scenes::neighbourhood(points, kReach), wide = scenes::neighbourhood(points, kReach);
  const PointCloud places = scenes::random_cloud(300, 0.04, 22);
  std::size_t narrow_count = 0, narrowed_size = 0, wide_size = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    for (int step = 0; step < 12; ++step) {
      const Vec3 p = places.point(k) + 0.00002 * std::pow(step, 1.5) * Vec3(1, -1, 0.5);
      const GatheredPoints& list = near.narrowed(p);
      std::vector<bool> listed(cloud.size(), false);
      for (std::size_t i = 0; i < list.size(); ++i) listed[list.index()[i]] = true;
      for (std::size_t i = 0; i < cloud.size(); ++i)
        if ((p - cloud.point(i)).norm() - cloud.fixture_radius_m[i] <= kReach) {
          ASSERT_TRUE(listed[i]) << k << ", step " << step;
        }
      ASSERT_EQ(near.sum_grid(), (wide.around(p), wide.sum_grid())) << k << ", step " << step;
      if (&list == &near.around(p)) continue;
      ++narrow_count, narrowed_size += list.size(), wide_size += near.around(p).size();
    }
  EXPECT_GT(narrow_count, places.size());
  EXPECT_LT(static_cast<double>(narrowed_size), 0.95 * static_cast<double>(wide_size));
}

// The proxy leaves a cube at its corner. One point is not in the list of that cube, but is within the reach
// of the next position.
TEST(Neighbourhood, NarrowedListOfACubeIsNotUsedInTheNext) {
  const double half_edge = kReach / 16, step = 0.00006;
  const Vec3 corner = Vec3::Constant(half_edge), out = Vec3::Ones().normalized();
  PointCloud cloud;
  cloud.append(Vec3::Zero());
  cloud.append(corner + (kReach + 0.9 * step) * out);
  Neighbourhood near = scenes::neighbourhood(make_search(cloud), kReach);
  near.narrowed(corner - 0.1 * step * out);
  EXPECT_EQ(near.narrowed(corner - 0.1 * step * out).size(), 1u);
  EXPECT_EQ(near.narrowed(corner + step * out).size(), 2u);
}

TEST(Neighbourhood, NarrowedListIsForgottenWithItsCloudAndReach) {
  const PointCloud cloud = scenes::random_cloud(4000, 0.05, 21);
  Neighbourhood near = scenes::neighbourhood(make_search(cloud), kReach);
  const Vec3 p(0.001, 0.002, 0.003);
  near.narrowed(p);
  const std::size_t before = near.narrowed(p).size();
  near.set_reach(1.5 * kReach);
  EXPECT_GT(near.narrowed(p).size(), before);
  near.set_points(make_search(PointCloud()));
  EXPECT_EQ(near.narrowed(p).size(), 0u);
}

// A wide region far away must not add the points in between to the list.
TEST(Neighbourhood, AWideRegionFarAwayDoesNotWidenTheList) {
  PointCloud cloud = scenes::random_cloud(4000, 0.05, 21);
  const auto size_with = [&](double radius) {
    PointCloud other = cloud;
    other.append({0, 0, 0.3});
    other.fixture_radius_m.assign(other.size(), 0);
    other.fixture_radius_m.back() = radius;
    return scenes::neighbourhood(make_search(other), kReach).around(Vec3::Zero()).size();
  };
  EXPECT_GT(size_with(0), 0u);
  EXPECT_EQ(size_with(0.25), size_with(0));
  EXPECT_EQ(size_with(0.295), size_with(0) + 1);
}

// The first hit found in hops equals that of the whole cloud at once, including regions beside the tube.
TEST(Neighbourhood, FirstHitIsThatOfTheWholeCloud) {
  const auto points = cloud_with_fixtures();
  const GatheredPoints all = scenes::gathered(*points);
  Neighbourhood near = scenes::neighbourhood(points, kReach);
  const PointCloud from = scenes::random_cloud(400, 0.3, 23), to = scenes::random_cloud(400, 0.06, 24);
  int hits = 0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3 p = from.point(k), displacement = to.point(k) - p, u = displacement.normalized();
    const double expected = scenes::kernels().proxy.first_hit(all.view(), p.data(), u.data(), kContactRadius);
    EXPECT_EQ(near.first_hit(p, u, kContactRadius, displacement.norm()),
              std::min(expected, displacement.norm()))
        << k;
    hits += expected < displacement.norm() ? 1 : 0;
  }
  EXPECT_GT(hits, 200);
}

// The list at hand may belong to another position, even to the one on the other side of the origin.
TEST(Neighbourhood, FirstHitDoesNotUseTheListOfAnotherPosition) {
  PointCloud cloud;
  const Vec3 p(0.1, 0.08, -0.06), u = Vec3::UnitX();
  cloud.append(p + 0.0105 * u);
  Neighbourhood near = scenes::neighbourhood(make_search(cloud), kReach);
  const double hit = near.first_hit(p, u, kContactRadius, 0.006);
  EXPECT_NEAR(hit, 0.0105 - kContactRadius, 1e-12);
  EXPECT_EQ(near.around(-p).size(), 0u);
  EXPECT_EQ(near.first_hit(p, u, kContactRadius, 0.006), hit);
}

}  // namespace
}  // namespace remote_touch::neighbourhood_test
