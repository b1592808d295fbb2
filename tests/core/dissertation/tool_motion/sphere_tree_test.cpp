// Trees of spheres, their collision compared with all pairs of leaves, and the spheres that cover a tool.
#include "core/dissertation/tool_motion/sphere_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/sphere_tree_renderer.h"
#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "tests/support/box_tool.h"
#include "tests/support/leaf_pairs.h"
#include "tests/support/scenes.h"

namespace remote_touch::sphere_tree_test {
namespace {

// random_cloud() as spheres of different sizes.
std::vector<Sphere> random_spheres(int count, double half_m, int seed) {
  const PointCloud places = scenes::random_cloud(count, half_m, seed);
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < places.size(); ++i)
    spheres.push_back({places.point(i), 0.001 * static_cast<double>(1 + i % 5)});
  return spheres;
}

SphereTree tree_of(const std::vector<Sphere>& leaves, std::size_t patch) {
  SphereTree tree;
  for (std::size_t first = 0; first < leaves.size(); first += patch)
    tree.add(std::span(leaves).subspan(first, std::min(patch, leaves.size() - first)));
  tree.finish();
  return tree;
}

TEST(BoundingSphere, IsThatOfTheEquation) {
  const std::vector<Sphere> three = {{{0, 0, 0}, 1}, {{3, 0, 0}, 1}, {{0, 0, 3}, 2}};
  const Sphere sphere = bounding_sphere(three);
  EXPECT_NEAR((sphere.centre - Vec3(1, 0, 1)).norm(), 0, 1e-15);
  EXPECT_NEAR(sphere.radius_m, std::sqrt(5.0) + 2, 1e-11);
}

TEST(SphereTree, EveryNodeEnclosesItsChildrenAndEveryLeafHasOne) {
  const std::vector<Sphere> leaves = random_spheres(1000, 0.1, 3);
  const SphereTree tree = tree_of(leaves, 7);
  ASSERT_EQ(tree.leaves().size(), leaves.size());
  ASSERT_EQ(tree.level_count(), 3u);  // levels of 143, 18 and 3 nodes
  for (std::size_t level = 0; level < tree.level_count(); ++level) {
    std::size_t next = 0;
    for (const SphereNode& node : tree.level(level)) {
      EXPECT_EQ(node.first, next);
      next += node.count;
      for (std::uint32_t child = node.first; child < node.first + node.count; ++child) {
        const Sphere& below = level == 0 ? tree.leaves()[child] : tree.level(level - 1)[child].sphere;
        EXPECT_LE((below.centre - node.sphere.centre).norm() + below.radius_m, node.sphere.radius_m);
      }
    }
    EXPECT_EQ(next, level == 0 ? leaves.size() : tree.level(level - 1).size());
  }
  EXPECT_LE(tree.top().size(), SphereTree::kBranching);
}

// --- the regions of a frame ---

TEST(RegionTree, HasALeafForEveryMeasuredPointWithARegion) {
  PointCloud cloud = scenes::random_cloud(3000, 0.1, 5);
  cloud.fixture_radius_m.assign(cloud.size(), 0.04);
  cloud.fixture_radius_m[7] = 0;
  cloud.fixture_radius_m[8] = 0.01;
  cloud.y[9] = std::nan("");
  RegionTree tree;
  for (int again = 0; again < 2; ++again) {
    tree.assign(cloud);
    ASSERT_EQ(tree.points().size(), cloud.size() - 2);
    ASSERT_EQ(tree.spheres().leaves().size(), cloud.size() - 2);
    EXPECT_EQ(tree.spheres().level(0).size(), (cloud.size() - 2 + 255) / 256);
    std::vector<int> seen(cloud.size(), 0);
    for (std::size_t leaf = 0; leaf < tree.points().size(); ++leaf) {
      const std::uint32_t point = tree.points()[leaf];
      ++seen[point];
      EXPECT_EQ(tree.spheres().leaves()[leaf].centre, cloud.point(point));
      EXPECT_EQ(tree.spheres().leaves()[leaf].radius_m, cloud.fixture_radius_m[point]);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i == 7 || i == 9 ? 0 : 1);
  }
}

PointCloud image_of(int width, int height) {
  PointCloud cloud;
  cloud.image.emplace();
  cloud.image->camera = {width, height, 100, 100, 0.5 * width, 0.5 * height};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) cloud.append(Vec3(0.001 * u, 0.001 * v, 1));
  return cloud;
}

// Patches of 16 x 16 pixels: one for each that has a region, none for the others.
TEST(RegionTree, HasAPatchForEverySquareOfTheImageWithARegion) {
  PointCloud cloud = image_of(100, 70);
  cloud.fixture_radius_m.assign(cloud.size(), 0);
  for (const auto& [u, v] : {std::pair{0, 0}, {15, 15}, {16, 15}, {99, 69}})
    cloud.fixture_radius_m[static_cast<std::size_t>(v * 100 + u)] = 0.02;
  RegionTree tree;
  tree.assign(cloud);
  EXPECT_EQ(tree.points(), (std::vector<std::uint32_t>{0, 1515, 1516, 6999}));
  ASSERT_EQ(tree.spheres().level(0).size(), 3u);
  EXPECT_EQ(tree.spheres().level(0)[0].count, 2u);
}

TEST(RegionTree, IsEmptyIfThereAreNoRegions) {
  PointCloud cloud = scenes::random_cloud(100, 0.1, 5);
  RegionTree tree;
  tree.assign(cloud);
  EXPECT_TRUE(tree.spheres().empty());
  cloud.fixture_radius_m.assign(cloud.size(), 0);
  tree.assign(cloud);
  EXPECT_TRUE(tree.spheres().empty());
  tree.assign({});
  EXPECT_TRUE(tree.spheres().empty());
}

// --- tree against tree ---

TEST(TreeCollision, FindsWhatBruteForceFinds) {
  const SphereTree tool = tree_of(random_spheres(112, 0.03, 1), 8),
                   regions = tree_of(random_spheres(4000, 0.05, 2), 100);
  TreeCollision collision(tool, scenes::kernels());
  collision.on_frame(regions);
  std::size_t max = 0, none = 0;
  for (int i = 0; i < 40; ++i) {
    const ToolPose pose{{0.008 * i - 0.1, 0.004 * i, 0.01}, rotation({0.1 * i, 0.3, -0.05 * i})};
    for (const double margin_m : {-0.001, 0.0, 0.004}) {
      const std::vector<LeafPair> pairs = near_pairs(collision, pose, margin_m);
      ASSERT_TRUE(pairs == naive_pairs(tool, pose, regions, margin_m)) << i << " " << margin_m;
      max = std::max(max, pairs.size()), none += pairs.empty() ? 1 : 0;
    }
  }
  EXPECT_GT(max, 500u);
  EXPECT_GT(none, 10u);
}

TEST(TreeCollision, FindsNothingNearAnEmptyTreeOrANanPose) {
  const SphereTree tool = tree_of(random_spheres(20, 0.03, 1), 8);
  SphereTree nothing;
  nothing.add({});
  nothing.finish();
  EXPECT_TRUE(nothing.empty());
  EXPECT_EQ(nothing.level_count(), 0u);
  const auto count = [&](const SphereTree& of, const SphereTree& regions, const ToolPose& pose) {
    TreeCollision collision(of, scenes::kernels());
    collision.on_frame(regions);
    return near_pairs(collision, pose, 1).size();
  };
  EXPECT_GT(count(tool, tool, {}), 100u);
  EXPECT_EQ(count(tool, nothing, {}), 0u);
  EXPECT_EQ(count(nothing, tool, {}), 0u);
  ToolPose pose;
  pose.p_W.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count(tool, tool, pose), 0u);
}

// --- the spheres of a tool ---

// Its longest side is the second.
const TriangleMesh kTriangle{{{0.01, 0, 0}, {0, 0, 0.03}, {0, 0.04, 0}}, {{0, 1, 2}}};

double distance(const Vec3& place, const std::vector<Vec3>& samples) {
  double min = 1;
  for (const Vec3& sample : samples) min = std::min(min, (place - sample).norm());
  return min;
}

TEST(SurfaceSamples, AreOfATriangleAndLeaveNoPlaceOut) {
  const auto& v = kTriangle.vertices;
  const Vec3 normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  for (const double spacing_m : {0.001, 0.004, 0.0101, 1.0}) {
    const std::vector<Vec3> samples = surface_samples(kTriangle, spacing_m);
    for (const Vec3& corner : v) EXPECT_LT(distance(corner, samples), 1e-12) << spacing_m;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        EXPECT_LT(distance(v[0] + (i * (v[1] - v[0]) + j * (v[2] - v[0])) / 60, samples),
                  std::min(spacing_m, 0.03));
    for (const Vec3& sample : samples) {
      EXPECT_NEAR(normal.dot(sample - v[0]), 0, 1e-15);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_GT(normal.cross(v[(i + 1) % 3] - v[i]).dot(sample - v[i]), -1e-15);
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

VoxelTool tool_of(const std::string& name) {
  ToolReport report;
  return make_voxel_tool(find_generated_tool(name)->make(), {.voxel_m = 1e-3}, report);
}

constexpr double kRounding_m = 1e-9;

// Greedy search: it adds one sphere after the other, each time the one that covers most of the remaining
// points.
std::vector<Sphere> plain_cover(const std::vector<Vec3>& points, const std::vector<Sphere>& choice,
                                double inflation_m, std::size_t max) {
  std::vector<Vec3> left = points;
  std::vector<Sphere> taken;
  while (!left.empty() && taken.size() <= max) {
    std::size_t best = 0, best_count = 0;
    const auto covers = [&](const Sphere& sphere, const Vec3& p) {
      return (p - sphere.centre).norm() <= sphere.radius_m + inflation_m;
    };
    for (std::size_t i = 0; i < choice.size(); ++i) {
      const auto count = static_cast<std::size_t>(
          std::count_if(left.begin(), left.end(), [&](const Vec3& p) { return covers(choice[i], p); }));
      if (count > best_count) best = i, best_count = count;
    }
    if (best_count == 0) break;
    taken.push_back({choice[best].centre, choice[best].radius_m + inflation_m});
    std::erase_if(left, [&](const Vec3& p) { return covers(choice[best], p); });
  }
  return taken;
}

TEST(SphereCover, TakesWhatAPlainSearchTakes) {
  const PointCloud points = scenes::random_cloud(2000, 0.05, 1), centres = scenes::random_cloud(300, 0.06, 2);
  std::vector<Vec3> places;
  std::vector<Sphere> choice;
  for (std::size_t i = 0; i < points.size(); ++i) places.push_back(points.point(i));
  for (std::size_t i = 0; i < centres.size(); ++i)
    choice.push_back({centres.point(i), 0.005 + 1e-5 * static_cast<double>(i % 700)});
  const SphereCover cover(places, choice, 0.004);
  for (const double inflation_m : {0.0, 0.004, 0.02}) {
    const SphereCover::Result result = cover.cover(inflation_m, 60);
    const std::vector<Sphere> expected = plain_cover(places, choice, inflation_m, 60);
    ASSERT_EQ(result.spheres.size(), expected.size()) << inflation_m;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(result.spheres[i].centre, expected[i].centre) << inflation_m << ", sphere " << i;
  }
}

// A box of ten metres would need 1e12 cells of a millimetre, although it holds few points.
TEST(SphereCover, TakesFewPointsFarApartWithoutACellForEveryMillimetre) {
  const Vec3 far = Vec3::Constant(5);
  const std::vector<Sphere> choice{{far, 0.001}, {-far, 0.001}, {Vec3::Zero(), 0.001}};
  for (const Vec3& middle : {Vec3(0, 0, 0), Vec3(7, -7, 7)}) {
    std::vector<Sphere> there = choice;
    for (Sphere& sphere : there) sphere.centre += middle;
    const SphereCover cover({middle - far, middle + far}, there, 0.001);
    const SphereCover::Result result = cover.cover(0, 10);
    EXPECT_EQ(result.spheres.size(), 2u);
    EXPECT_EQ(result.uncovered_count, 0u);
  }
}

// Checks that the surface lies inside the union of spheres and that the union stays close to the tool.
double outside_of_cover_m(const VoxelTool& tool, int leaves) {
  const ToolSpheres made = make_tool_spheres(tool, leaves);
  EXPECT_LE(made.spheres.leaves().size(), static_cast<std::size_t>(leaves));
  EXPECT_LE(made.outside_m, made.inflation_m + kRounding_m) << leaves;
  EXPECT_LT(made.surface_outside_m, kRounding_m) << leaves;
  return made.outside_m;
}

// Two layers of nodes lie inside a plate of a few voxels, each next to an end of the field. Balls of only one
// layer would have to grow by a voxel to cover the other side.
TEST(ToolSpheres, CoverAToolClosely) {
  EXPECT_LT(outside_of_cover_m(tool_of("husky"), 16), 0.02);
  EXPECT_LT(outside_of_cover_m(tool_of("ball"), 1), 1e-3) << "nearly one sphere";
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 half_m(0.53, 0.53, 0.53);
    half_m[axis] = 0.13;
    ToolReport report;
    const VoxelTool plate = make_voxel_tool(scenes::box_mesh(half_m), {.voxel_m = 0.1}, report);
    ASSERT_EQ(plate.grid.cells[static_cast<std::size_t>(axis)], 3);
    EXPECT_LT(outside_of_cover_m(plate, 400), 0.07) << axis;
  }
}

// Both errors are computed in another way: the distance to a box has a closed form, and its surface is easy
// to sample.
TEST(ToolSpheres, ReportedErrorsOfABoxAreTrue) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  const ToolSpheres made = make_tool_spheres(*scenes::box_tool(half_m, 1e-3), 60);
  const PointCloud directions = scenes::random_cloud(3000, 1, 8);
  double outside_m = 0, surface_outside_m = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (const Sphere& leaf : made.spheres.leaves())
      outside_m = std::max(
          outside_m,
          scenes::box_distance(half_m, leaf.centre + leaf.radius_m * directions.point(i).normalized()));
    const Vec3 on_cube =
        directions.point(i) / directions.point(i).cwiseAbs().maxCoeff();  // a point on a side of the box
    double min_m = 1;
    for (const Sphere& leaf : made.spheres.leaves())
      min_m = std::min(min_m, (half_m.cwiseProduct(on_cube) - leaf.centre).norm() - leaf.radius_m);
    surface_outside_m = std::max(surface_outside_m, min_m);
  }
  EXPECT_GT(made.inflation_m, 1e-3);  // otherwise there would be no error to compare
  EXPECT_NEAR(made.outside_m, outside_m, 0.1 * outside_m);
  EXPECT_LT(outside_m, made.inflation_m + 1e-6);
  EXPECT_LT(surface_outside_m, 5e-5);
}

TEST(ToolSpheres, RoundsTheReportedErrorUp) {
  ToolSpheres made;
  made.outside_m = 0.001291;
  EXPECT_EQ(text(made),
            "0 spheres, at most 1.30 mm outside the mesh; its surface is at most 0.00 mm outside them");
}

TEST(ToolSpheres, AToolWithoutInsideIsRefused) {
  VoxelTool tool = *scenes::box_tool({0.002, 0.002, 0.002});
  for (float& distance : tool.distance_m) distance = std::abs(distance) + 1e-6f;
  EXPECT_THROW(make_tool_spheres(tool, 10), InputError);
}

}  // namespace
}  // namespace remote_touch::sphere_tree_test
