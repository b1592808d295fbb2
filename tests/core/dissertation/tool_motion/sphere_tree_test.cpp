#include "core/dissertation/tool_motion/sphere_tree_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/leaf_pairs.h"
#include "tests/support/scenes.h"

namespace remote_touch::sphere_tree_renderer_test {
namespace {

// The renderer of chapter 7 against closed forms: a tool of one ball among few regions.

constexpr double kRegion_m = 0.04, kBall_m = 0.01;
constexpr double kSettled_m = 1e-4;
const Vec3 kAway(0, 0.2, 0);

std::shared_ptr<const SphereTree> leaves_at(const std::vector<Vec3>& places) {
  std::vector<Sphere> leaves;
  for (const Vec3& place : places) leaves.push_back({place, kBall_m});
  auto tree = std::make_shared<SphereTree>();
  tree->add(leaves);
  tree->finish();
  return tree;
}

SphereTreeRenderer renderer(const std::vector<Vec3>& leaves = {Vec3::Zero()}, const ToolParameters& p = {}) {
  return {p, scenes::box_tool({0.02, 0.005, 0.01}), leaves_at(leaves), scenes::kernels()};
}

PointCloud regions_at(const std::vector<Vec3>& places) {
  PointCloud cloud = scenes::cloud_of(places);
  cloud.fixture_radius_m.assign(cloud.size(), kRegion_m);
  return cloud;
}

// Returns the output after enough ticks for the tool to rest.
RenderOutput held(SphereTreeRenderer& r, const DeviceState& device, int ticks = 20) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step(device, 0.001 * i);
  return out;
}

TEST(SphereTreeRenderer, ABallIsKeptOutByASpringOfItsDepth) {
  SphereTreeRenderer r = renderer();
  r.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
  held(r, {kAway});
  const RenderOutput out = held(r, {{0, 0.03, 0}});
  EXPECT_NEAR(out.proxy_W.y(), 0.05, kSettled_m);
  EXPECT_NEAR(out.force_N.y(), 600 * (out.proxy_W.y() - 0.03), 1e-9);
  EXPECT_EQ(out.state, ContactState::contact);
  EXPECT_EQ(out.contact_count, 1);
  EXPECT_EQ(out.tool->contact_clusters, 1);
  EXPECT_EQ(out.tool->active_constraints, 1);
  EXPECT_LT(out.tool->tool_penetration_m, kSettled_m);
  EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-6);
  EXPECT_TRUE(out.converged);
}

TEST(SphereTreeRenderer, ReportsNoDistanceBeyondTheLookAhead) {
  SphereTreeRenderer r = renderer();
  r.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
  const DeviceState device{{0, 0.0521, 0}, rotation({0.3, -0.2, 0.9})};
  const RenderOutput out = held(r, device);
  EXPECT_EQ(out.proxy_W, device.position_W);
  EXPECT_EQ(out.tool->orientation_W.coeffs(), device.orientation_W.normalized().coeffs());
  EXPECT_TRUE(out.force_N.isZero(0) && out.tool->torque_Nm.isZero(0));
  EXPECT_TRUE(std::isinf(out.nearest_distance_m));
  EXPECT_EQ(out.state, ContactState::free);
}

TEST(SphereTreeRenderer, ReportsTheGapWithinTheLookAhead) {
  SphereTreeRenderer r = renderer();
  r.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
  const RenderOutput out = held(r, {{0, 0.051, 0}});
  EXPECT_NEAR(out.nearest_distance_m, 0.001, 1e-12);
  EXPECT_EQ(out.contact_count, 0);
  EXPECT_EQ(out.tool->tool_penetration_m, 0);
}

// Points without r_f have no region, so the tool passes through them.
TEST(SphereTreeRenderer, PointsWithoutARadiusHoldNothing) {
  SphereTreeRenderer r = renderer();
  PointCloud cloud = regions_at({{0, 0, 0}});
  cloud.fixture_radius_m[0] = 0;
  r.on_frame(scenes::frame(cloud));
  held(r, {kAway});
  EXPECT_TRUE(held(r, {{0, 0, 0}}).force_N.isZero(0));
}

TEST(SphereTreeRenderer, TheStiffnessOfTheRegionIsThatOfTheCoupling) {
  SphereTreeRenderer r = renderer();
  PointCloud cloud = regions_at({{-0.3, 0, 0}, {0.3, 0, 0}});
  cloud.stiffness_N_per_m = {150, std::numeric_limits<double>::quiet_NaN()};
  r.on_frame(scenes::frame(cloud));
  for (const auto& [x, stiffness] : {std::pair(-0.3, 150.0), std::pair(0.3, 600.0)}) {
    held(r, {Vec3(x, 0.2, 0)}, 400);
    const RenderOutput out = held(r, {Vec3(x, 0.04, 0)});
    EXPECT_NEAR(out.force_N.y(), stiffness * (out.proxy_W.y() - 0.04), 1e-9) << x;
  }
}

// Two balls on a rod. A region holds one of them, so the rod turns when it is pushed down, and the hand feels
// it.
TEST(SphereTreeRenderer, ARodHeldAtOneEndTurns) {
  SphereTreeRenderer r = renderer({{-0.03, 0, 0}, {0.03, 0, 0}});
  r.on_frame(scenes::frame(regions_at({{0.03, -0.05, 0}})));
  held(r, {kAway}, 5);
  const RenderOutput out = held(r, {{0, -0.01, 0}}, 100);
  EXPECT_GT(rotation_vector(out.tool->orientation_W).z(), 0.02);  // the free end moves further down
  EXPECT_GT(out.tool->torque_Nm.z(), 0.001);
  EXPECT_GT(out.force_N.y(), 0.5);
  EXPECT_LT(out.tool->tool_penetration_m, kSettled_m);
}

TEST(SphereTreeRenderer, AFrameThatSwallowsTheToolPushesItOut) {
  SphereTreeRenderer r = renderer();
  r.on_frame(scenes::frame(regions_at({{0, -1, 0}}), 0));
  held(r, {{0, 0.02, 0}});
  r.on_frame(scenes::frame(regions_at({{0, 0, 0}}), 1));
  const RenderOutput out = r.step({{0, 0.02, 0}}, 1);
  EXPECT_LT(out.tool->tool_penetration_m, kSettled_m);
  EXPECT_NEAR(out.proxy_W.y(), 0.05, 2e-4);
}

TEST(SphereTreeRenderer, AnOldFrameIsDroppedAndReportedOnce) {
  SphereTreeRenderer r = renderer();
  r.on_frame(scenes::frame(regions_at({{0, 0, 0}}), 5));
  r.on_frame(scenes::frame(regions_at({{0, 0.1, 0}}), 4));
  EXPECT_EQ(r.step({kAway}, 0).status, RenderStatus::stale_frame_dropped);
  const RenderOutput out = r.step({kAway}, 0.001);
  EXPECT_EQ(out.status, RenderStatus::ok);
  EXPECT_EQ(out.frame_index, 5);
}

TEST(SphereTreeRenderer, SlaveIsNotSentAnywhereBeforeTheDeviceIsKnown) {
  const Vec3 lost = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const SlaveCommand command : {SlaveCommand::rendered, SlaveCommand::hip}) {
    ToolParameters p;
    p.slave_command = command;
    SphereTreeRenderer r = renderer({Vec3::Zero()}, p);
    r.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
    EXPECT_TRUE(r.step({lost}, 0).slave_W.array().isNaN().all());
    EXPECT_EQ(r.step({kAway}, 0.001).slave_W, kAway);
    EXPECT_EQ(r.step({lost}, 0.002).slave_W, kAway);
  }
}

TEST(SphereTreeRenderer, RegionParametersAreTheToolParametersThatApply) {
  ToolParameters p;
  std::set<std::string> all, kept;
  for (const Parameter& parameter : parameters(p)) all.insert(parameter.name);
  for (const Parameter& parameter : region_parameters(p)) kept.insert(parameter.name);
  for (const char* other :
       {"contact_rule", "free_accuracy_m", "exit_accuracy_m", "disk_radius_ratio", "merged_disk_m",
        "frame_reach_m", "velocity_estimate", "max_prediction_s", "velocity_force"}) {
    EXPECT_TRUE(all.erase(other)) << other;
  }
  EXPECT_EQ(kept, all);
}

}  // namespace
}  // namespace remote_touch::sphere_tree_renderer_test

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

TEST(SphereTree, IsEmptyIfThereAreNoSpheres) {
  SphereTree tree;
  tree.add({});
  tree.finish();
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.level_count(), 0u);
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

TEST(RegionTree, KeepsTheStiffnessOfItsPoints) {
  PointCloud cloud = scenes::random_cloud(500, 0.1, 5);
  cloud.fixture_radius_m.assign(cloud.size(), 0.01);
  RegionTree tree;
  tree.assign(cloud);
  EXPECT_TRUE(std::isnan(tree.stiffness_N_per_m(0)));
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.stiffness_N_per_m.push_back(10.0 * static_cast<double>(i));
  tree.assign(cloud);
  for (std::uint32_t leaf = 0; leaf < tree.points().size(); ++leaf)
    EXPECT_EQ(tree.stiffness_N_per_m(leaf), 10.0 * tree.points()[leaf]);
}

// Frames of one size: the memory that the first one needed serves the next.
TEST(RegionTree, KeepsItsMemoryFromFrameToFrame) {
  PointCloud cloud = image_of(200, 200);
  cloud.fixture_radius_m.assign(cloud.size(), 0.01);
  RegionTree tree;
  tree.assign(cloud);
  std::fill_n(cloud.fixture_radius_m.begin(), 5000, 0.0);
  const std::size_t before = allocation_count();
  tree.assign(cloud);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_EQ(tree.points().size(), cloud.size() - 5000);
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
  const SphereTree tool = tree_of(random_spheres(20, 0.03, 1), 8), nothing;
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

}  // namespace
}  // namespace remote_touch::sphere_tree_test
