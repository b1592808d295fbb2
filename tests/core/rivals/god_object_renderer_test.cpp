// The triangles of an organised frame, the nearest position that obeys planes, and a god-object on such a
// mesh.
#include "core/rivals/god_object_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/points/neighbour_search.h"
#include "tests/core/rivals/moved_hip.h"
#include "tests/support/scenes.h"

namespace remote_touch::god_object_renderer_test {
namespace {

using namespace moved_hip;

const Ball kEverything{Vec3::Zero(), 1};

GridMesh mesh_of(const NeighbourSearch& search, const Ball& ball = kEverything, double limit_m = 0.004) {
  GridMesh mesh(limit_m);
  mesh.reserve(search.size());
  mesh.assign(scenes::gathered(search, {ball.centre, ball.radius + limit_m}), search.organised_columns(),
              ball);
  return mesh;
}

PointCloud with_hole(PointCloud cloud, std::size_t i) {
  cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  return cloud;
}

// A flat grid whose points are moved at random by at most that much along each axis.
PointCloud rough_grid(int n, const Vec3& most_m, unsigned seed) {
  PointCloud cloud = scenes::flat_grid(n);
  const PointCloud noise = scenes::random_cloud(n * n, 1, seed);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.x[i] += most_m.x() * noise.x[i], cloud.y[i] += most_m.y() * noise.y[i];
    cloud.z[i] += most_m.z() * noise.z[i];
  }
  return cloud;
}

double area(const GridMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles()) sum += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
  return sum;
}

// Each square at a missing point keeps the triangle of its other three corners, so half of its area is lost.
TEST(GridMesh, HasTwoTrianglesForEveryFourNeighboursAndOneForThree) {
  const PointCloud cloud = scenes::flat_grid(8, 0.0015);
  const GridMesh mesh = mesh_of(BruteForceSearch(cloud));
  EXPECT_EQ(mesh.triangles().size(), 2u * 7 * 7);
  for (const Triangle& t : mesh.triangles()) EXPECT_EQ(std::abs(t.normal.y()), 1);
  const double square = 0.0015 * 0.0015;
  EXPECT_NEAR(area(mesh), 49 * square, 1e-15);
  for (const std::size_t inner : {27u, 36u, 18u})
    EXPECT_NEAR(area(mesh_of(BruteForceSearch(with_hole(cloud, inner)))), 47 * square, 1e-15);
  EXPECT_NEAR(area(mesh_of(BruteForceSearch(with_hole(cloud, 0)))), 48.5 * square, 1e-15);
}

TEST(GridMesh, LongEdgesAndTheNextSheetAreLeftOut) {
  PointCloud cloud = scenes::flat_grid(8, 0.0015);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (i % 8 >= 4) cloud.y[i] = 0.01;  // a step between two columns
  EXPECT_EQ(mesh_of(BruteForceSearch(cloud)).triangles().size(), 2u * 7 * 6);

  PointCloud sheets = scenes::flat_grid(8, 0.0015);
  const PointCloud upper = scenes::flat_grid(8, 0.0015, 0.01);
  for (std::size_t i = 0; i < upper.size(); ++i) sheets.append(upper.point(i));
  EXPECT_EQ(mesh_of(BruteForceSearch(sheets)).triangles().size(), 2u * 2 * 7 * 7);
}

TEST(GridMesh, HasAllThatMeetTheBall) {
  const PointCloud cloud = rough_grid(40, {0.0004, 0.0004, 0.0004}, 2);
  const Ball ball{Vec3(0.005, 0.001, -0.003), 0.006};
  const GridMesh all = mesh_of(BruteForceSearch(cloud)), near = mesh_of(BruteForceSearch(cloud), ball);
  EXPECT_LT(near.triangles().size(), all.triangles().size() / 4);
  const PointCloud ends = scenes::random_cloud(400, 0.0034, 5);  // points in a cube inside the ball
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    const Vec3 from = ball.centre + ends.point(i), to = ball.centre + ends.point(i + 1);
    const auto a = all.first_crossing(from, to), b = near.first_crossing(from, to);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_EQ(a->fraction(), b->fraction());
    }
  }
}

TEST(GridMesh, HasNoGapBetweenTriangles) {
  const GridMesh mesh = mesh_of(BruteForceSearch(scenes::flat_grid(8, 0.0015)));
  const double corner = 0.0015 * 3.5;
  for (int i = 0; i <= 14; ++i)
    for (int j = 0; j <= 14; ++j) {  // corners, edges and middles
      const Vec3 at(corner * (i / 7.0 - 1), 0, corner * (j / 7.0 - 1));
      const auto down = mesh.first_crossing(at + Vec3(1e-4, 0.001, 0), at - Vec3(1e-4, 0.001, 0));
      const auto up = mesh.first_crossing(at - Vec3(0, 0.001, 0), at + Vec3(0, 0.001, 0));
      ASSERT_TRUE(down && up) << i << " " << j;
      EXPECT_NEAR(down->fraction(), 0.5, 1e-12);
    }
  EXPECT_FALSE(mesh.first_crossing({0, 0.001, 0}, {0.003, 1e-9, 0}));
  EXPECT_FALSE(mesh.first_crossing({0, 0, 0}, {0, -0.001, 0})) << "from the plane itself there is no side";
  EXPECT_TRUE(mesh.first_crossing({0, 0.001, 0}, {0, 0, 0}));
}

TEST(PlaneConstraints, AreObeyedForOneTwoAndThreePlanes) {
  PlaneConstraints planes(1e-12);
  EXPECT_EQ(planes.nearest({1, 2, 3}).position, Vec3(1, 2, 3));
  EXPECT_EQ(planes.nearest({1, 2, 3}).active_planes, 0);
  planes.add(Vec3::UnitY(), {5, 1, 5}, 0.5);
  EXPECT_EQ(planes.nearest({1, -2, 3}).position, Vec3(1, 1.5, 3));
  const Vec3 tilted = Vec3(-1, 1, 0).normalized();
  planes.add(tilted, {2, 1.5, 0}, 0);
  EXPECT_NEAR((planes.nearest({2.5, -2, 3}).position - Vec3(2, 1.5, 3)).norm(), 0, 1e-12) << "the valley";
  EXPECT_EQ(planes.nearest({2.5, -2, 3}).active_planes, 2);
  EXPECT_EQ(planes.nearest({0, -2, 3}).active_planes, 1);
  planes.add(Vec3::UnitZ(), {0, 0, 4}, 0);
  EXPECT_NEAR((planes.nearest({2.5, -2, 3}).position - Vec3(2, 1.5, 4)).norm(), 0, 1e-12) << "the corner";
  EXPECT_EQ(planes.nearest({2.5, -2, 3}).active_planes, 3);
}

// No random position that obeys the planes is nearer to the goal.
TEST(PlaneConstraints, IsNearestAmongThoseThatObey) {
  constexpr std::size_t kPlanes = PlaneConstraints::kMaxCount;
  const PointCloud normals = scenes::random_cloud(kPlanes * 40, 1, 9),
                   places = scenes::random_cloud(2000, 2, 10);
  for (int run = 0; run < 40; ++run) {
    PlaneConstraints planes(1e-12);
    std::vector<Vec3> n;
    for (std::size_t i = 0; i < kPlanes; ++i) {
      n.push_back(normals.point(kPlanes * static_cast<std::size_t>(run) + i).normalized());
      ASSERT_TRUE(planes.add(n.back(), Vec3::Zero(), -0.3));
    }
    const Vec3 goal = 2 * normals.point(static_cast<std::size_t>(run));
    const PlaneConstraints::Nearest nearest = planes.nearest(goal);
    ASSERT_TRUE(nearest.found);
    const auto obeys = [&](const Vec3& y, double slack) {
      return std::all_of(n.begin(), n.end(), [&](const Vec3& v) { return v.dot(y) >= -0.3 - slack; });
    };
    EXPECT_TRUE(obeys(nearest.position, 1e-9));
    for (std::size_t i = 0; i < places.size(); ++i)
      if (obeys(places.point(i), 0)) {
        EXPECT_GE((places.point(i) - goal).norm(), (nearest.position - goal).norm() - 1e-12);
      }
  }
}

TEST(PlaneConstraints, FindNoPointIfThePlanesContradictEachOther) {
  PlaneConstraints planes(1e-12);
  planes.add(Vec3::UnitY(), Vec3::Zero(), 1);
  planes.add(-Vec3::UnitY(), Vec3::Zero(), 1);
  EXPECT_FALSE(planes.nearest(Vec3::Zero()).found);
  for (std::size_t i = 2; i < PlaneConstraints::kMaxCount; ++i)
    EXPECT_TRUE(planes.add(Vec3::UnitX(), Vec3::Zero(), 0));
  EXPECT_FALSE(planes.add(Vec3::UnitX(), Vec3::Zero(), 0));
}

constexpr double kOffset_m = 1e-5, kStiffness_N_per_m = 600;

using Height = std::function<double(double x, double z)>;

PointCloud surface(const Height& height, int n = 61, double spacing = 0.0015) {
  PointCloud cloud = scenes::flat_grid(n, spacing);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] = height(cloud.x[i], cloud.z[i]);
  return cloud;
}

GodObjectRenderer over(const PointCloud& cloud) {
  return moved_hip::over<GodObjectRenderer>(cloud, GodObjectParameters());
}

TEST(GodObject, IsTheFootOfTheHipOnATiltedPlane) {
  const Vec3 n = Vec3(-0.5, 1, -0.25).normalized();
  GodObjectRenderer r = over(surface([](double x, double z) { return 0.5 * x + 0.25 * z; }));
  const Vec3 hip(0.003, -0.01, 0.002);
  const RenderOutput out = go(r, {0, 0.02, 0}, hip);
  const Vec3 foot = hip - n.dot(hip) * n + kOffset_m * n;
  EXPECT_NEAR((out.proxy_W - foot).norm(), 0, 1e-9);
  EXPECT_NEAR((out.force_N - kStiffness_N_per_m * (foot - hip)).norm(), 0, 1e-6);
  EXPECT_NEAR((out.normal_W - n).norm(), 0, 1e-6);
  EXPECT_EQ(out.contact_count, 1);
  EXPECT_EQ(out.state, ContactState::contact);
  EXPECT_TRUE(out.converged);
}

// Two planes hold the proxy at the bottom of the valley. Its position along the valley is that of the HIP.
TEST(GodObject, TwoPlanesHoldItInAValley) {
  GodObjectRenderer r = over(surface([](double x, double) { return std::abs(x); }));
  const RenderOutput out = go(r, {0.004, 0.03, 0}, {0.001, -0.01, 0.0037}, 100);
  EXPECT_NEAR(out.proxy_W.x(), 0, 1e-9);
  EXPECT_NEAR(out.proxy_W.y(), kOffset_m * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(out.proxy_W.z(), 0.0037, 1e-9);
  EXPECT_EQ(out.contact_count, 2);
}

// A pyramid upside down, whose three edges are edges of the mesh: three planes hold it in the corner.
TEST(GodObject, ThreePlanesHoldItInACorner) {
  const auto pit = [](double x, double z) { return 0.5 * std::max({x + 2 * z, -2 * x - z, x - z}); };
  GodObjectRenderer r = over(surface(pit));
  const Vec3 hip(0.0004, -0.01, 0.0003);
  go(r, {0.001, 0.03, 0.001}, hip, 100);
  const RenderOutput out = r.step({hip}, 0.2);
  EXPECT_EQ(out.contact_count, 3);
  EXPECT_NEAR(out.proxy_W.norm(), 0, 3 * kOffset_m);
  EXPECT_TRUE(out.converged);
  EXPECT_EQ(r.step({hip}, 0.201).proxy_W, out.proxy_W) << "at rest";
}

// It slides up one side of a ridge, passes it when the foot of the HIP does, and goes down the other side.
TEST(GodObject, GoesOverARidge) {
  GodObjectRenderer r = over(surface([](double x, double) { return -0.5 * std::abs(x); }));
  go(r, {-0.02, 0.02, 0.0002}, {-0.02, -0.022, 0.0002});
  double passed_at = 0;
  RenderOutput out;
  for (int i = 0; i <= 450; ++i) {
    const Vec3 hip(-0.02 + 0.0001 * i, -0.022, 0.0002);
    out = r.step({hip}, 0.001 * i);
    ASSERT_GE(out.proxy_W.y(), -0.5 * std::abs(out.proxy_W.x()) + 0.5 * kOffset_m) << i;
    if (out.proxy_W.x() > 0 && passed_at == 0) passed_at = hip.x();
  }
  EXPECT_NEAR(passed_at, 0.5 * 0.022, 0.0003);
  const Vec3 hip(0.025, -0.022, 0.0002), n = Vec3(0.5, 1, 0).normalized();
  EXPECT_NEAR((out.force_N.normalized() - n).norm(), 0, 1e-6);
  EXPECT_NEAR(out.force_N.norm(), kStiffness_N_per_m * (kOffset_m - n.dot(hip)), 1e-6);
}

TEST(GodObject, HoldsFromBothSides) {
  GodObjectRenderer r = over(scenes::flat_grid(60));
  const RenderOutput out = go(r, {0, -0.03, 0}, {0.002, 0.01, 0});
  EXPECT_NEAR(out.proxy_W.y(), -kOffset_m, 1e-12);
  EXPECT_NEAR(out.force_N.y(), -kStiffness_N_per_m * (0.01 + kOffset_m), 1e-9);
}

// Random pushes and pulls against a rough mesh that rests.
TEST(GodObject, NeverPassesAMeshThatRests) {
  const PointCloud cloud = rough_grid(60, {0.0006, 0.0018, 0.0006}, 7);
  GodObjectRenderer r = over(cloud);
  const GridMesh mesh =
      mesh_of(BruteForceSearch(cloud), kEverything, GodObjectParameters().max_edge_length_m);
  const PointCloud goals = scenes::random_cloud(60, 0.02, 11);
  Vec3 hip(0, 0.02, 0), proxy = r.step({hip}, 0).proxy_W;
  const auto is_above = [&](const Vec3& p) {  // parity of the crossings straight up: the mesh may overhang
    int count = 0;
    Vec3 from = p;
    while (const auto hit = mesh.first_crossing(from, Vec3(p.x(), 0.1, p.z()))) {
      ++count;
      from.y() += hit->fraction() * (0.1 - from.y()) + 1e-9;
    }
    return count % 2 == 0;
  };
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const Vec3 goal = goals.point(k), start = hip;
    for (int i = 1; i <= 50; ++i) {
      hip = start + (goal - start) * (i / 50.0);
      proxy = r.step({hip}, 0.05 * static_cast<double>(k) + 0.001 * i).proxy_W;
      ASSERT_TRUE(is_above(proxy)) << k << " " << i << " at " << proxy.transpose();
    }
  }
}

TEST(GodObject, FallsThroughAHole) {
  PointCloud cloud = scenes::flat_grid(60);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (std::hypot(cloud.x[i], cloud.z[i]) < 0.005)
      cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  GodObjectRenderer r = over(cloud);
  EXPECT_GT(go(r, {0.02, 0.02, 0}, {0.02, -0.01, 0}).force_N.y(), 5);
  const RenderOutput out = go(r, {0.02, -0.01, 0}, {0, -0.01, 0}, 100);
  EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
}

// The stated limit of the method: the motion of the surface is not known.
TEST(GodObject, AMeshThatPassesOverItLeavesItBehindAndOneThatFallsBackIsFollowed) {
  for (const double moved_m : {0.001, -0.003}) {
    GodObjectRenderer r = over(scenes::flat_grid(60));
    EXPECT_GT(press(r, 0.01).force_N.y(), 5);
    r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, moved_m), 1));
    const RenderOutput out = r.step({Vec3(0, -0.01, 0)}, 0.05);
    EXPECT_NEAR(out.proxy_W.y(), moved_m > 0 ? -0.01 : moved_m + kOffset_m, 1e-9);
    EXPECT_EQ(out.force_N.isZero(0), moved_m > 0);
  }
}

TEST(GodObject, AFrameOfUnorganisedPointsIsNotUsed) {
  PointCloud cloud = scenes::flat_grid(60);
  cloud.grid_columns = 0;
  GodObjectRenderer r = over(cloud);
  const RenderOutput out = go(r, {0, 0.02, 0}, {0, -0.01, 0});
  EXPECT_EQ(out.status, RenderStatus::no_frame);
  EXPECT_EQ(out.frame_index, 0);
  EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
}

}  // namespace
}  // namespace remote_touch::god_object_renderer_test
