// The tiles of a cloud, their spheres, slabs and cones of normals, and its merged and packed forms.
#include "core/dissertation/tool_motion/touch_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "core/points/point_cloud.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::tiled_cloud_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Vec3 kMissing = Vec3::Constant(kNaN);

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
  const std::vector<Vec3> normals{Vec3::UnitX(), kMissing, Vec3(1, 1, 0).normalized(), Vec3::UnitX()};
  const NormalCone cone = normal_cone(normals);
  for (const std::size_t i : {0u, 2u, 3u}) EXPECT_LE((normals[i] - cone.middle_W).norm(), cone.deviation);
  EXPECT_LT(cone.deviation, 0.6);
  for (const auto& none : {std::vector<Vec3>{}, {kMissing}}) {
    EXPECT_TRUE(normal_cone(none).middle_W.isZero(0));
    EXPECT_EQ(normal_cone(none).deviation, 0);
  }
}

PointCloud image_cloud(int width, int height) {
  DepthImage depth{width, height, {}};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      depth.z_m.push_back((u * 7 + v * 3) % 11 == 0 ? kNaN : 0.6 + 0.001 * u + (u > width / 2 ? 0.3 : 0));
  return cloud_from_depth(depth, {width, height, 500, 500, 0.5 * width, 0.5 * height},
                          RigidTransform::Identity());
}

bool holds(const SphereColumns& spheres, std::size_t i, const Vec3& p) {
  return (p - Vec3(spheres.x[i], spheres.y[i], spheres.z[i])).norm() <= spheres.radius[i];
}

// Checks that every measured point occurs once, in a tile whose sphere contains it, and that the sphere of
// its block contains the sphere of the tile.
void expect_tiled(const PointCloud& cloud) {
  TiledCloud tiled;
  tiled.assign(cloud);
  using Row = std::array<double, 6>;  // a point and its normal, 0 for none
  const auto row = [](const Vec3& p, const Vec3& n) {
    const bool is_known = n.allFinite();
    return Row{p.x(), p.y(), p.z(), is_known ? n.x() : 0, is_known ? n.y() : 0, is_known ? n.z() : 0};
  };
  std::multiset<Row> expected, found;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.point(i).allFinite())
      expected.insert(row(cloud.point(i), cloud.nx.empty() ? kMissing : cloud.normal(i)));
  std::uint32_t next = 0;
  for (const TileBlock& block : tiled.blocks())
    for (const Tile& tile : tiled.tiles(block)) {
      EXPECT_EQ(tile.first, next);
      EXPECT_EQ(tile.padded_count, kTilePoints);
      next += tile.padded_count;
      EXPECT_LE((tile.sphere.centre_W - block.sphere.centre_W).norm() + tile.sphere.radius_m,
                block.sphere.radius_m);
      for (std::uint32_t i = tile.first; i < next; ++i) {
        if (tiled.point(i).x() == kFarAway) continue;
        found.insert(row(tiled.point(i), tiled.normal(i)));
        EXPECT_LE((tiled.point(i) - tile.sphere.centre_W).norm(), tile.sphere.radius_m);
        EXPECT_TRUE(holds(tiled.tile_spheres(), i / kTilePoints, tiled.point(i)));
        EXPECT_TRUE(holds(tiled.group_spheres(), i / kLanes, tiled.point(i)));
      }
    }
  EXPECT_EQ(next, tiled.padded_size());
  EXPECT_EQ(found, expected);
  EXPECT_EQ(tiled.count_without_normal(),
            std::ranges::count_if(found, [](const Row& r) { return r[3] == 0 && r[4] == 0 && r[5] == 0; }));
}

TEST(TiledCloud, HoldsEveryMeasuredPointOnce) {
  expect_tiled(image_cloud(70, 45));
  expect_tiled(image_cloud(8, 8));
  expect_tiled(image_cloud(1, 1));
  expect_tiled(scenes::flat_grid(33));
  expect_tiled(scenes::random_cloud(5000, 0.3, 4));
  expect_tiled(scenes::cloud_with_normals(500, 0.3, 7));
  PointCloud holes = scenes::random_cloud(100, 0.3, 5);
  holes.y[3] = kNaN, holes.z[50] = std::numeric_limits<double>::infinity();
  expect_tiled(holes);
  expect_tiled({});
  PointCloud one;
  one.append({1, 2, 3});
  expect_tiled(one);
  PointCloud same;
  for (int i = 0; i < 200; ++i) same.append({1, 2, 3});
  expect_tiled(same);
}

TEST(TiledCloud, KnowsTheSpacing) {
  TiledCloud tiled;
  tiled.assign(scenes::flat_grid(50, 0.002));
  for (const TileBlock& block : tiled.blocks())
    for (const Tile& tile : tiled.tiles(block)) EXPECT_NEAR(tiled.spacing_m(tile.first), 0.002, 1e-12);
  // a wall of an image at 1 m and 45 degrees: pixels are 2 mm apart, and 1.41 times that along the wall
  PointCloud cloud = cloud_from_depth({8, 8, std::vector<double>(64, 1.0)}, {8, 8, 500, 500, 3.5, 3.5},
                                      RigidTransform::Identity());
  for (std::size_t i = 0; i < 64; ++i) {
    const Vec3 n = Vec3(1, 0, -1).normalized();
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  }
  tiled.assign(cloud);
  EXPECT_NEAR(tiled.spacing_m(27), 0.002 * std::sqrt(2), 3e-5);
  // pixels that are twice as long along one axis, whichever that is
  for (double CameraIntrinsics::*const shorter : {&CameraIntrinsics::fx, &CameraIntrinsics::fy}) {
    PointCloud oblong = cloud;
    oblong.image->camera.*shorter = 250;
    tiled.assign(oblong);
    EXPECT_NEAR(tiled.spacing_m(27), 0.004 * std::sqrt(2), 6e-5);
  }
}

// --- points that a PointChange moves or hides ---

// Lifts the points in a ball and hides those left of the ball's centre. Points outside the ball stay as they
// are.
class Lifted final : public PointChange {
 public:
  explicit Lifted(const BoundingSphere& ball) : ball_(ball) {}
  bool concerns(const BoundingSphere& sphere) const override {
    return (sphere.centre_W - ball_.centre_W).norm() <= sphere.radius_m + ball_.radius_m;
  }
  bool apply(Point& point) const override {
    if ((point.p_W - ball_.centre_W).norm() > ball_.radius_m) return true;
    if (point.p_W.x() < ball_.centre_W.x()) return false;
    point.p_W.y() += 0.01, point.n_W = Vec3::UnitX(), point.spacing_m = 0.003;
    return true;
  }

 private:
  const BoundingSphere ball_;
};

std::vector<Vec3> points_of(const TiledCloud& cloud) {
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < cloud.padded_size(); ++i)
    if (cloud.x()[i] != kFarAway) points.push_back(cloud.point(i));
  return points;
}

TEST(TiledCloud, PointsKeepTheirOrderInEveryForm) {
  const PointCloud flat = scenes::flat_grid(100);
  TiledCloud all, shown;
  all.assign(flat);
  const Lifted change({Vec3(0.01, 0, 0.02), 0.02});
  shown.reserve(all.padded_size());
  shown.assign(all, {Vec3::Zero(), 10}, change);
  std::vector<Vec3> expected;
  for (const Vec3& p : points_of(all)) {
    PointChange::Point point{p, Vec3::Zero(), 0};
    if (change.apply(point)) expected.push_back(point.p_W);
  }
  EXPECT_LT(expected.size(), flat.size());
  EXPECT_EQ(points_of(shown), expected);
  EXPECT_EQ(shown.max_spacing_m(), 0.003);
  EXPECT_LT(shown.count_without_normal(), all.count_without_normal());
  for (const TileBlock& block : shown.blocks())
    for (const Tile& tile : shown.tiles(block))
      for (std::uint32_t i = tile.first; i < tile.first + tile.padded_count; ++i) {
        if (shown.x()[i] == kFarAway) continue;
        EXPECT_LE((shown.point(i) - tile.sphere.centre_W).norm(), tile.sphere.radius_m);
        EXPECT_TRUE(holds(shown.tile_spheres(), i / kTilePoints, shown.point(i)));
        EXPECT_TRUE(holds(shown.group_spheres(), i / kLanes, shown.point(i)));
      }
}

TEST(TiledCloud, OnlyTilesNearTheBallAreShownAndNothingIsAllocated) {
  TiledCloud all, shown;
  all.assign(image_cloud(320, 240));
  shown.reserve(320 * 240);
  const BoundingSphere ball{Vec3(0, 0, 0.7), 0.05};
  const std::size_t before = allocation_count();
  shown.assign(all, ball, Lifted({ball.centre_W, 0.03}));
  EXPECT_EQ(allocation_count(), before);
  EXPECT_GT(shown.padded_size(), 0);
  EXPECT_LT(shown.padded_size(), all.padded_size());
  const std::vector<Vec3> points = points_of(shown);
  for (const Vec3& p : points_of(all)) {
    if ((p - ball.centre_W).norm() > ball.radius_m || (p - ball.centre_W).norm() <= 0.03) continue;
    EXPECT_NE(std::find(points.begin(), points.end(), p), points.end());
  }
}

TEST(TiledCloud, AMergedCloudIsMadeOnRequestAndHasWhatMergedPointsFinds) {
  const PointCloud cloud = scenes::dense_plane();
  std::vector<CloudPoint> points;
  TiledCloud tiled;
  tiled.assign(cloud);
  EXPECT_FALSE(tiled.merged());
  tiled.assign(cloud, 0.002);
  ASSERT_TRUE(tiled.merged());
  const TiledCloud& merged = *tiled.merged();
  for (std::uint32_t i = 0; i < tiled.padded_size(); ++i)
    if (tiled.x()[i] != kFarAway) points.push_back({tiled.point(i), tiled.normal(i), tiled.spacing_m(i)});
  std::vector<Vec3> expected, found = points_of(merged);
  double max_extent_m = 0;
  for (const PointOrDisk& point : merged_points(points, 0.002)) {
    expected.push_back(point.p_W);
    max_extent_m = std::max(max_extent_m, point.extent_m);
  }
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(expected.begin(), expected.end(), before), std::sort(found.begin(), found.end(), before);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(merged.max_extent_m(), max_extent_m);
  for (std::uint32_t i = 0; i < merged.padded_size(); ++i)
    EXPECT_TRUE(merged.x()[i] != kFarAway || merged.columns().extent[i] == 0);
  tiled.assign(scenes::flat_grid(50, 0.002), 0.002);
  EXPECT_FALSE(tiled.merged());
}

// True if the slab of its group holds a point.
bool slab_holds(const SlabColumns& slabs, std::size_t group, const Vec3& p) {
  const Vec3 offset = p - Vec3(slabs.sphere.x[group], slabs.sphere.y[group], slabs.sphere.z[group]);
  const double height = Vec3(slabs.nx[group], slabs.ny[group], slabs.nz[group]).dot(offset);
  return holds(slabs.sphere, group, p) && std::abs(height) <= slabs.half[group];
}

void expect_packed(const TiledCloud& all) {
  const TiledCloud& packed = all.packed();
  ASSERT_TRUE(packed.has_slabs());
  std::set<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < packed.padded_size(); ++i) {
    if (packed.x()[i] == kFarAway) continue;
    const std::uint32_t number = packed.number(i);
    EXPECT_EQ(packed.point(i), all.point(number));
    EXPECT_TRUE(packed.normal(i) == all.normal(number) || !all.normal(number).allFinite());
    EXPECT_EQ(packed.spacing_m(i), all.spacing_m(number));
    EXPECT_TRUE(slab_holds(packed.slabs(), i / kLanes, packed.point(i)));
    EXPECT_TRUE(holds(packed.tile_spheres(), i / kTilePoints, packed.point(i)));
    numbers.insert(number);
  }
  EXPECT_EQ(numbers.size(), points_of(all).size());
  EXPECT_LE(packed.padded_size(), all.padded_size());
}

TEST(TiledCloud, APackedCloudOfDensePointsHasEachOnceInSmallGroups) {
  TiledCloud tiled;
  tiled.assign(scenes::dense_plane(), 0.002);
  expect_packed(tiled);
  const auto mean_radius_m = [](const TiledCloud& cloud) {
    double sum_m = 0;
    for (std::size_t group = 0; group < cloud.padded_size() / kLanes; ++group)
      sum_m += cloud.group_spheres().radius[group];
    return sum_m / static_cast<double>(cloud.padded_size() / kLanes);
  };
  EXPECT_LT(mean_radius_m(tiled.packed()), 0.7 * mean_radius_m(tiled));
  PointCloud some = scenes::cloud_with_normals(3001, 0.002, 6);
  for (const double odd : {kNaN, std::numeric_limits<double>::infinity()})
    some.append({0, odd, 0}, Vec3::UnitY());
  for (int i = 0; i < 20; ++i) some.append({0.001, 0.001, 0}, Vec3::UnitY());
  tiled.assign(some, 0.002);
  expect_packed(tiled);
}

TEST(TiledCloud, OtherCloudsAreTheirOwnPackedOnes) {
  TiledCloud tiled;
  for (const PointCloud& cloud :
       {scenes::flat_grid(50, 0.002), PointCloud{}, scenes::random_cloud(1, 1, 1)}) {
    tiled.assign(cloud, 0.002);
    EXPECT_EQ(&tiled.packed(), &tiled);
    EXPECT_FALSE(tiled.has_slabs());
  }
  tiled.assign(scenes::dense_plane());
  EXPECT_EQ(&tiled.packed(), &tiled);
  EXPECT_EQ(tiled.number(17), 17u);
}

}  // namespace
}  // namespace remote_touch::tiled_cloud_test
