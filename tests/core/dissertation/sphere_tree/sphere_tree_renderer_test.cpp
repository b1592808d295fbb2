// The renderer of chapter 7 against closed forms: a tool of one ball among few regions.
#include "core/dissertation/sphere_tree/sphere_tree_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/geometry/rotation.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::sphere_tree_renderer_test {
namespace {

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
