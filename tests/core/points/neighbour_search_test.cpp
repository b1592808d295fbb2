// Searches for points near a position against a plain loop, and the lists that are kept around a proxy.
#include "core/points/neighbour_search.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::neighbour_search_test {
namespace {

std::vector<Vec3> points_of(const PointCloud& cloud) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.point(i));
  return points;
}

TEST(CompactOrder, HoldsEveryIndexOnce) {
  for (const int count : {0, 1, 7, 8, 9, 63, 65, 130, 1000, 5000}) {
    std::vector<std::uint32_t> order = compact_order(points_of(scenes::random_cloud(count, 0.1, 3)));
    ASSERT_EQ(order.size(), static_cast<std::size_t>(count));
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
  }
  EXPECT_EQ(compact_order(std::vector<Vec3>(100, Vec3(1, 2, 3))).size(), 100u);
}

// Every run of a grid of 64 x 64 points is a square, or half of one.
TEST(CompactOrder, RunsOfAGridAreSquares) {
  std::vector<Vec3> points;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) points.push_back(Vec3((i * 37) % 64, 0, j));
  const std::vector<std::uint32_t> order = compact_order(points);
  for (const std::size_t run : {8u, 64u, 512u}) {
    double longest = 0;
    for (std::size_t first = 0; first < order.size(); first += run) {
      BoundingBox box;
      for (std::size_t i = first; i < first + run; ++i) box.extend(points[order[i]]);
      longest = std::max(longest, box.sizes().maxCoeff());
    }
    EXPECT_LE(longest + 1, std::sqrt(2.0 * static_cast<double>(run)));
  }
}

std::vector<std::uint32_t> found(const NeighbourSearch& search, const Ball& ball,
                                 const Kernels& kernels = scenes::kernels()) {
  const GatheredPoints out = scenes::gathered(search, ball, kernels);
  std::vector<std::uint32_t> index(out.index(), out.index() + out.size());
  std::sort(index.begin(), index.end());
  return index;
}

// The oracle: a loop that shares nothing with the kernels.
std::vector<std::uint32_t> expected(const PointCloud& cloud, const Ball& ball) {
  std::vector<std::uint32_t> index;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double dx = cloud.x[i] - ball.centre.x(), dy = cloud.y[i] - ball.centre.y(),
                 dz = cloud.z[i] - ball.centre.z();
    const double reach = ball.radius + (cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i]);
    if (dx * dx + dy * dy + dz * dz <= reach * reach) index.push_back(static_cast<std::uint32_t>(i));
  }
  return index;
}

// A wavy wall seen by a tilted camera, with holes.
PointCloud image_cloud() {
  const CameraIntrinsics camera{160, 120, 130.5, 131.5, 79.2, 60.1};
  DepthImage depth{camera.width, camera.height, {}};
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.z_m.push_back((u * 7 + v * 13) % 11 == 0 ? std::nan("")
                                                     : 0.5 + 0.1 * std::sin(0.1 * u) + 0.001 * v);
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  X_WC.translation() = Vec3(0.3, -0.2, 0.1);
  return cloud_from_depth(depth, camera, X_WC);
}

// Most points have a small region or none, and a few have a wide one. The widest must not widen the search
// for the others.
PointCloud with_regions(PointCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.fixture_radius_m.push_back(i % 97 == 0  ? 0.1
                                     : i % 3 == 0 ? 0
                                                  : 0.0003 * static_cast<double>(i % 50));
  return cloud;
}

void expect_same_sets(const PointCloud& cloud, const NeighbourSearch& search, double reach) {
  const PointCloud centres = scenes::random_cloud(300, reach, 5);
  std::size_t total = 0;
  for (const Kernels* kernels : supported_kernels()) {
    for (std::size_t i = 0; i < centres.size(); ++i) {
      // Every other centre lies on a point, where distances are smallest.
      Vec3 centre = centres.point(i);
      if (i % 2 == 0) centre = cloud.point((i * 7919) % cloud.size());
      if (!centre.allFinite()) continue;
      const Ball ball{centre, 0.002 + 0.0005 * static_cast<double>(i)};
      const auto want = expected(cloud, ball);
      ASSERT_EQ(found(search, ball, *kernels), want) << "centre " << centre.transpose();
      total += want.size();
    }
  }
  EXPECT_GT(total, 1000u);
}

// Once without regions, and once with a region of its own for each point.
TEST(NeighbourSearch, EverySearchFindsTheSameSet) {
  for (const bool has_regions : {false, true}) {
    const auto made = [&](const PointCloud& cloud) { return has_regions ? with_regions(cloud) : cloud; };
    const PointCloud cloud = made(scenes::random_cloud(3000, 0.1, 1)), image = made(image_cloud());
    expect_same_sets(cloud, BruteForceSearch(cloud), 0.15);
    for (const double cell : {0.001, 0.01, 0.3})
      expect_same_sets(cloud, UniformGridSearch(cloud, cell), 0.15);
    expect_same_sets(image, ImageWindowSearch(image), 0.6);
    expect_same_sets(image, UniformGridSearch(image, 0.01), 0.6);
  }
}

// A mesh of neighbours needs the width of the rows of the original order.
TEST(NeighbourSearch, ReportsHowWideTheRowsOfAnOrganisedFrameAre) {
  EXPECT_EQ(ImageWindowSearch(image_cloud()).organised_columns(), 160);
  const UniformGridSearch search(scenes::flat_grid(30), 0.004);
  EXPECT_EQ(search.organised_columns(), 30);
  EXPECT_EQ(search.stored_cloud()->columns(), 0) << "its own points stand in another order";
  EXPECT_EQ(BruteForceSearch(scenes::random_cloud(30, 1, 1)).organised_columns(), 0);
}

// The search stores the points in another order. The columns must follow it.
TEST(NeighbourSearch, KeepsARegionWithItsPoint) {
  PointCloud cloud = with_regions(scenes::random_cloud(3000, 0.1, 1));
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.stiffness_N_per_m.push_back(static_cast<double>(i));
  const GatheredPoints out = scenes::gathered(UniformGridSearch(cloud, 0.01), {Vec3(0.02, 0.01, 0), 0.03});
  ASSERT_GT(out.size(), 50u);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const std::uint32_t i = out.index()[k];
    ASSERT_EQ(Vec3(out.view().x[k], out.view().y[k], out.view().z[k]), cloud.point(i));
    ASSERT_EQ(out.view().radius[k], cloud.fixture_radius_m[i]);
    ASSERT_EQ(out.view().stiffness[k], static_cast<double>(i));
  }
}

TEST(NeighbourSearch, BallAroundTheCameraIsSearchedWhole) {
  const PointCloud cloud = image_cloud();
  const Ball ball{cloud.image->X_WC.translation(), 0.55};
  EXPECT_EQ(found(ImageWindowSearch(cloud), ball), expected(cloud, ball));
}

TEST(NeighbourSearch, OutliersDoNotBlowUpTheGrid) {
  PointCloud cloud = scenes::random_cloud(500, 0.05, 2);
  cloud.append({1e6, -1e6, 1e6});
  const UniformGridSearch search(cloud, 0.001);
  const Ball ball{Vec3(1e6, -1e6, 1e6), 0.01};
  EXPECT_EQ(found(search, ball), (std::vector<std::uint32_t>{500}));
}

TEST(NeighbourSearch, FindsNothingWithoutPointsAndAtANanPosition) {
  const PointCloud cloud = scenes::random_cloud(500, 0.05, 2),
                   missing = scenes::cloud_of({Vec3::Constant(std::nan(""))});
  for (const PointCloud& none : {PointCloud(), missing}) {
    EXPECT_TRUE(found(BruteForceSearch(none), {Vec3::Zero(), 10}).empty());
    EXPECT_TRUE(found(UniformGridSearch(none, 0.01), {Vec3::Zero(), 10}).empty());
  }
  for (int axis = 0; axis < 3; ++axis) {
    Ball ball{Vec3::Zero(), 10};
    ball.centre[axis] = std::nan("");
    EXPECT_TRUE(found(BruteForceSearch(cloud), ball).empty());
    EXPECT_TRUE(found(UniformGridSearch(cloud, 0.01), ball).empty());
    EXPECT_TRUE(found(ImageWindowSearch(image_cloud()), ball).empty());
  }
}

TEST(NeighbourSearch, IsChosenByTheKindOfCloud) {
  EXPECT_NE(dynamic_cast<ImageWindowSearch*>(make_search(image_cloud()).get()), nullptr);
  EXPECT_NE(dynamic_cast<BruteForceSearch*>(make_search(scenes::random_cloud(10, 1, 1)).get()), nullptr);
  EXPECT_NE(dynamic_cast<UniformGridSearch*>(make_search(scenes::random_cloud(1000, 1, 1)).get()), nullptr);
}

constexpr double kReach = 0.01, kContactRadius = 0.005;

std::shared_ptr<const NeighbourSearch> cloud_with_fixtures() {
  PointCloud cloud = scenes::random_cloud(4000, 0.05, 21);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.fixture_radius_m.push_back(i % 3 == 0 ? 0.004 : 0);
  return std::make_shared<BruteForceSearch>(cloud);
}

// Returns true if the list has every point of the cloud whose region is within the reach of p.
bool holds_all_within_reach(const GatheredPoints& list, const PointCloud& cloud, const Vec3& p) {
  std::vector<bool> listed(cloud.size(), false);
  for (std::size_t i = 0; i < list.size(); ++i) listed[list.index()[i]] = true;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if ((p - cloud.point(i)).norm() - cloud.fixture_radius_m[i] <= kReach && !listed[i]) return false;
  return true;
}

// Wherever in its cube the position lies, no point within reach may be missing from the list.
TEST(Neighbourhood, ListHoldsEveryRegionWithinReach) {
  const auto points = cloud_with_fixtures();
  Neighbourhood near = scenes::neighbourhood(points, kReach);
  const PointCloud places = scenes::random_cloud(2000, 0.04, 22);
  for (std::size_t k = 0; k < places.size(); ++k)
    ASSERT_TRUE(
        holds_all_within_reach(near.around(places.point(k)), *points->stored_cloud(), places.point(k)))
        << k;
}

// The path has short and long steps, so that the list is narrow at some positions and not at others. A narrow
// list has every point within the reach, and fewer points beyond it than the list of around().
TEST(Neighbourhood, NarrowedListHoldsEveryRegionWithinReach) {
  const auto points = cloud_with_fixtures();
  Neighbourhood near = scenes::neighbourhood(points, kReach), wide = scenes::neighbourhood(points, kReach);
  const PointCloud places = scenes::random_cloud(300, 0.04, 22);
  std::size_t narrow_count = 0, narrowed_size = 0, wide_size = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    for (int step = 0; step < 12; ++step) {
      const Vec3 p = places.point(k) + 0.00002 * std::pow(step, 1.5) * Vec3(1, -1, 0.5);
      const GatheredPoints& list = near.narrowed(p);
      ASSERT_TRUE(holds_all_within_reach(list, *points->stored_cloud(), p)) << k << ", step " << step;
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
}  // namespace remote_touch::neighbour_search_test
