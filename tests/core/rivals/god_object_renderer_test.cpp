#include "core/rivals/god_object_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/scenes.h"

namespace remote_touch::god_object_renderer_test {
namespace {

constexpr double kOffset_m = 1e-5, kStiffness_N_per_m = 600;
const GodObjectParameters kDefault;

using Height = std::function<double(double x, double z)>;

PointCloud surface(const Height& height, int n = 61, double spacing = 0.0015) {
  PointCloud cloud = scenes::flat_grid(n, spacing);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] = height(cloud.x[i], cloud.z[i]);
  return cloud;
}

GodObjectRenderer over(const PointCloud& cloud) {
  GodObjectRenderer renderer(kDefault, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

RenderOutput go(GodObjectRenderer& r, const Vec3& from, const Vec3& to, int ticks = 60) {
  RenderOutput out;
  for (int i = 0; i <= ticks; ++i)
    out = r.step({i < ticks ? Vec3(from + (to - from) * (double(i) / ticks)) : to}, 0.001 * i);
  return out;
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
  PointCloud cloud = scenes::flat_grid(60);
  const PointCloud noise = scenes::random_cloud(static_cast<int>(cloud.size()), 0.0006, 7);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += noise.x[i], cloud.y[i] += 3 * noise.y[i], cloud.z[i] += noise.z[i];
  GodObjectRenderer r = over(cloud);
  GridMesh mesh(kDefault.max_edge_length_m);
  BruteForceSearch search(cloud);
  mesh.reserve(search.size());
  mesh.assign(scenes::gathered(search, {Vec3::Zero(), 1}), 60, {Vec3::Zero(), 1});
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
TEST(GodObject, AMeshThatPassesOverItLeavesItBehind) {
  GodObjectRenderer r = over(scenes::flat_grid(60));
  EXPECT_GT(go(r, {0, 0.02, 0}, {0, -0.01, 0}).force_N.y(), 5);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.001), 1));
  EXPECT_TRUE(r.step({Vec3(0, -0.01, 0)}, 0.05).force_N.isZero(0));
}

TEST(GodObject, AFrameThatFallsBackIsFollowed) {
  GodObjectRenderer r = over(scenes::flat_grid(60));
  go(r, {0, 0.02, 0}, {0, -0.01, 0});
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, -0.003), 1));
  EXPECT_NEAR(r.step({Vec3(0, -0.01, 0)}, 0.05).proxy_W.y(), -0.003 + kOffset_m, 1e-9);
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

TEST(GodObject, TakesTheStiffnessOfThePoints) {
  PointCloud cloud = scenes::flat_grid(60);
  cloud.stiffness_N_per_m.assign(cloud.size(), 200);
  GodObjectRenderer r = over(cloud);
  EXPECT_NEAR(go(r, {0, 0.02, 0}, {0, -0.01, 0}).force_N.y(), 200 * (0.01 + kOffset_m), 1e-6);
}

TEST(GodObject, TheOffsetMustBeSmallBesideTheEdges) {
  GodObjectParameters p;
  EXPECT_EQ(validate(p), "");
  p.max_edge_length_m = 0.00005;
  EXPECT_EQ(validate(p), "surface_offset_m = 1e-05: expected at most a tenth of max_edge_length_m = 5e-05");
}

}  // namespace
}  // namespace remote_touch::god_object_renderer_test
