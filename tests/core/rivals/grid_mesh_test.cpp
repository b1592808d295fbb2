// The triangles of an organised frame, and the nearest position that obeys planes.
#include "core/rivals/grid_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/rivals/plane_constraints.h"
#include "core/search/neighbour_search.h"
#include "tests/support/scenes.h"

namespace remote_touch::grid_mesh_test {
namespace {

constexpr double kLimit_m = 0.004;
const Ball kEverything{Vec3::Zero(), 1};

GridMesh mesh_of(const NeighbourSearch& search, const Ball& ball = kEverything) {
  GridMesh mesh(kLimit_m);
  mesh.reserve(search.size());
  mesh.assign(scenes::gathered(search, {ball.centre, ball.radius + kLimit_m}), search.organised_columns(),
              ball);
  return mesh;
}

PointCloud with_hole(PointCloud cloud, std::size_t i) {
  cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  return cloud;
}

double area(const GridMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles()) sum += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
  return sum;
}

TEST(GridMesh, HasTwoTrianglesForEveryFourNeighbours) {
  const GridMesh mesh = mesh_of(BruteForceSearch(scenes::flat_grid(8, 0.0015)));
  EXPECT_EQ(mesh.triangles().size(), 2u * 7 * 7);
  EXPECT_NEAR(area(mesh), 49 * 0.0015 * 0.0015, 1e-15);
  for (const Triangle& t : mesh.triangles()) EXPECT_EQ(std::abs(t.normal.y()), 1);
}

// Each square at a missing point keeps the triangle of its other three corners, so half of its area is lost.
TEST(GridMesh, AMissingPointTakesHalfOfEachSquareAroundIt) {
  const double square = 0.0015 * 0.0015;
  for (const std::size_t inner : {27u, 36u, 18u})
    EXPECT_NEAR(area(mesh_of(BruteForceSearch(with_hole(scenes::flat_grid(8, 0.0015), inner)))), 47 * square,
                1e-15);
  EXPECT_NEAR(area(mesh_of(BruteForceSearch(with_hole(scenes::flat_grid(8, 0.0015), 0)))), 48.5 * square,
              1e-15);
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

TEST(GridMesh, PointsInNoOrderHaveNone) {
  PointCloud cloud = scenes::flat_grid(8);
  cloud.grid_columns = 0;
  EXPECT_EQ(BruteForceSearch(cloud).organised_columns(), 0);
}

TEST(GridMesh, IsTheSameForEverySearchAndHasAllThatMeetTheBall) {
  PointCloud cloud = scenes::flat_grid(40);
  const PointCloud noise = scenes::random_cloud(static_cast<int>(cloud.size()), 0.0004, 2);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += noise.x[i], cloud.y[i] += noise.y[i], cloud.z[i] += noise.z[i];
  const Ball ball{Vec3(0.005, 0.001, -0.003), 0.006};
  const GridMesh all = mesh_of(BruteForceSearch(cloud)), near = mesh_of(BruteForceSearch(cloud), ball);
  const GridMesh by_grid = mesh_of(UniformGridSearch(cloud, 0.003), ball);
  ASSERT_EQ(by_grid.triangles().size(), near.triangles().size());
  for (std::size_t i = 0; i < near.triangles().size(); ++i) {
    EXPECT_EQ(near.triangles()[i].a, by_grid.triangles()[i].a);
    EXPECT_EQ(near.triangles()[i].normal, by_grid.triangles()[i].normal);
  }
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

// --- planes ---

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

}  // namespace
}  // namespace remote_touch::grid_mesh_test
