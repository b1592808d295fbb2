// Proxies on metaballs and surfels: what each of them has beside what all proxies on surfaces of points have.
#include "core/rivals/implicit_surface_renderers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/points/point_cloud.h"
#include "tests/core/rivals/moved_hip.h"
#include "tests/support/scenes.h"

namespace remote_touch::implicit_surface_renderer_test {
namespace {

using namespace moved_hip;
using Settings = ImplicitSurfaceParameters;

Settings with(SurfaceKind surface, SurfaceWeight weight = SurfaceWeight::wyvill) {
  Settings p;
  p.surface = surface, p.weight = weight;
  return p;
}

const Settings kAll[] = {with(SurfaceKind::metaballs, SurfaceWeight::wyvill),
                         with(SurfaceKind::metaballs, SurfaceWeight::wendland),
                         with(SurfaceKind::surfels, SurfaceWeight::wyvill),
                         with(SurfaceKind::surfels, SurfaceWeight::wendland)};

ImplicitSurfaceRenderer over(const PointCloud& cloud, const Settings& p) {
  return moved_hip::over<ImplicitSurfaceRenderer>(cloud, p);
}

// A metaball of one point: w(q) = T at q = 0.5 for T = w(0.5).
TEST(ImplicitSurfaceRenderer, OnePointIsABallOfTheRadiusWhereItsWeightIsTheThreshold) {
  const PointCloud cloud = scenes::cloud_of({Vec3::Zero()});
  Settings p;
  p.threshold = 1 - 4.0 / 9 / 64 + 17.0 / 9 / 16 - 22.0 / 9 / 4;
  ImplicitSurfaceRenderer r = over(cloud, p);
  go(r, {0, 0.03, 0}, {0.0001, 0.001, 0});
  const RenderOutput out = go(r, {0.0001, 0.001, 0}, {0.0001, 0.001, 0});  // it comes nearer by fifths
  const Vec3 up = Vec3(0.0001, 0.001, 0).normalized();
  EXPECT_NEAR(out.proxy_W.norm(), 0.5 * p.support_radius_m, 1e-9);
  EXPECT_NEAR((out.proxy_W.normalized() - up).norm(), 0, 1e-5) << "the place on the ball nearest to the HIP";
  EXPECT_NEAR((out.force_N - 600 * (out.proxy_W - Vec3(0.0001, 0.001, 0))).norm(), 0, 1e-12);
  EXPECT_EQ(out.state, ContactState::contact);
  EXPECT_TRUE(out.converged);
  EXPECT_EQ(out.contact_count, 1);
}

// Regions that enclose the proxy, although no point is within its support.
TEST(ImplicitSurfaceRenderer, DoesNotJumpThroughPointsWithRegions) {
  PointCloud cloud = scenes::flat_grid(60);
  cloud.fixture_radius_m.assign(cloud.size(), 0.2);
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer with_regions = over(cloud, p), without = over(scenes::flat_grid(60), p);
    const Vec3 above(0, 0.05, 0), below(0.001, -0.05, 0);
    with_regions.step({above}, 0), without.step({above}, 0);
    const RenderOutput out = with_regions.step({below}, 0.001);
    EXPECT_GE(out.proxy_W.y(), -1e-9);
    EXPECT_GT(out.force_N.y(), 1);
    EXPECT_NEAR((out.proxy_W - without.step({below}, 0.001).proxy_W).norm(), 0, 1e-6) << "r_f is ignored";
  }
}

// --- surfels with normals towards the sensor ---

SurfelParameters without_friction() {
  SurfelParameters p;
  p.friction = 0;
  return p;
}

SurfelRenderer surfels_over(const PointCloud& cloud, const SurfelParameters& p) {
  return moved_hip::over<SurfelRenderer>(cloud, p);
}

TEST(SurfelRenderer, LosesAHipThatIsFartherBehindThanTheRadius) {
  SurfelRenderer r = surfels_over(scenes::flat_grid(60, 0.0015, -0.05), {});
  rest(r, Vec3::Zero());
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.0101), 1));
  EXPECT_TRUE(rest(r, Vec3::Zero()).force_N.isZero(0));
}

// The front is the side of the sensor, not that from which the HIP comes. The HIP is therefore drawn to the
// front.
TEST(SurfelRenderer, TheBackOfASheetPullsTheHandThrough) {
  SurfelParameters below;
  below.view_direction = Vec3::UnitY();
  SurfelRenderer r = surfels_over(scenes::flat_grid(60), {}),
                 other = surfels_over(scenes::flat_grid(60), below);
  EXPECT_GT(go(r, {0, -0.02, 0}, {0, -0.002, 0}).force_N.y(), 1.1);
  EXPECT_TRUE(go(other, {0, -0.02, 0}, {0, -0.002, 0}).force_N.isZero(0));
}

// A HIP beside the proxy: without friction the proxy ends over it, with friction mu it stays back by mu times
// the depth.
TEST(SurfelRenderer, FrictionHoldsTheProxyBackByItsConeAndNoMore) {
  for (const double mu : {0.0, 0.2, 0.7}) {
    SurfelParameters p;
    p.friction = mu;
    SurfelRenderer r = surfels_over(scenes::flat_grid(60), p);
    press(r, 0.01);
    const RenderOutput out = rest(r, {0.02, -0.01, 0}, 200);
    EXPECT_NEAR(out.proxy_W.x(), 0.02 - mu * 0.01, 1e-6) << mu;
    EXPECT_NEAR(out.force_N.x(), -600 * mu * 0.01, 1e-3) << mu;
  }
}

// The first tick after a jump of the surface brings the proxy out by R / 2, the second by the rest.
TEST(SurfelRenderer, ProjectsByHalfTheRadiusPerTick) {
  SurfelRenderer r = surfels_over(scenes::flat_grid(60), without_friction());
  press(r, 0.01);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.007), 1));
  const RenderOutput first = r.step({Vec3(0, -0.01, 0)}, 0.1);
  EXPECT_NEAR(first.proxy_W.y(), 0.005, 1e-8);
  EXPECT_EQ(first.state, ContactState::entrenched);
  const RenderOutput second = r.step({Vec3(0, -0.01, 0)}, 0.101);
  EXPECT_NEAR(second.proxy_W.y(), 0.007, 1e-8);
  EXPECT_EQ(second.state, ContactState::contact);
}

// A plane that turns by an angle between two frames: the normal of the first tick lies between both.
TEST(SurfelRenderer, BlendsTheNormalWithThatOfTheTickBefore) {
  for (const double memory : {0.0, 0.4}) {
    SurfelParameters p = without_friction();
    p.previous_normal_fraction = memory;
    SurfelRenderer r = surfels_over(scenes::flat_grid(60), p);
    press(r, 0.002);
    PointCloud turned = scenes::flat_grid(60);
    const double angle = 0.1;
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const double x = turned.x[i];
      turned.x[i] = x * std::cos(angle), turned.y[i] = x * std::sin(angle);
    }
    r.on_frame(scenes::frame(turned, 1));
    const Vec3 to(-std::sin(angle), std::cos(angle), 0);
    const Vec3 expected = (memory * Vec3::UnitY() + (1 - memory) * to).normalized();
    EXPECT_NEAR((r.step({Vec3(0, -0.002, 0)}, 0.1).normal_W - expected).norm(), 0, 1e-6) << memory;
  }
}

TEST(SurfelRenderer, TheDefaultRadiusOfTheAuthorsIsThreeSpacings) {
  SurfelParameters p;
  p.support_radius_m = 0;
  SurfelRenderer r = surfels_over(scenes::flat_grid(60, 0.002), p);  // R = 6 mm, but for the border
  EXPECT_EQ(rest(r, {0, 0.0065, 0}).contact_count, 0);
  EXPECT_GT(rest(r, {0, 0.0055, 0}).contact_count, 0);
}

// Two frames with half of the points each, fused, hold the proxy as the whole cloud does.
TEST(SurfelRenderer, FusesTheNewestFrames) {
  const PointCloud whole = scenes::flat_grid(60);
  PointCloud halves[2];
  for (std::size_t i = 0; i < whole.size(); ++i) halves[i % 60 < 30 ? 0 : 1].append(whole.point(i));
  for (const int fused : {1, 2}) {
    SurfelParameters p;
    p.fused_frames = fused;
    SurfelRenderer r = surfels_over(halves[0], p);
    r.on_frame(scenes::frame(halves[1], 1));
    EXPECT_NEAR(go(r, {-0.02, 0.02, 0}, {-0.02, -0.005, 0}).force_N.y(), fused == 1 ? 0 : 3, 1e-5);
  }
}

// A plane at rest that a camera sees from below, where the default view direction is wrong. However many
// equal frames are joined, the proxy is held on the side of the camera.
TEST(SurfelRenderer, AStillImageHoldsTheSameHoweverManyFramesAreJoined) {
  const CameraIntrinsics camera{61, 61, 200, 200, 30, 30};
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // looks along +y
  X_WC.translation() = Vec3(0, -0.3, 0);
  DepthImage depth;
  depth.width = 61, depth.height = 61, depth.z_m.assign(camera.pixels(), 0.3);
  const PointCloud image = cloud_from_depth(depth, camera, X_WC);
  for (int fused = 1; fused <= 4; ++fused) {
    SurfelParameters p = without_friction();
    p.fused_frames = fused;
    SurfelRenderer r = surfels_over(image, p);
    for (int frame = 1; frame < 6; ++frame) r.on_frame(scenes::frame(image, frame));
    const RenderOutput out = go(r, {0, -0.02, 0}, {0, 0.005, 0});
    EXPECT_NEAR((out.force_N - Vec3(0, -3, 0)).norm(), 0, 1e-6) << fused;
    EXPECT_NEAR((out.normal_W + Vec3::UnitY()).norm(), 0, 1e-9) << fused;
  }
}

// (5.8) uses the points around the proxy from both frames. Stiff points lie to the right, soft ones to the
// left.
TEST(SurfelRenderer, PointsOfAllFramesGiveTheirStiffness) {
  const PointCloud whole = scenes::flat_grid(60);
  PointCloud halves[2];
  const auto stiffness = [](const Vec3& p) { return p.x() > 0 ? 400.0 : 200.0; };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    halves[i % 2].append(whole.point(i));
    halves[i % 2].stiffness_N_per_m.push_back(stiffness(whole.point(i)));
  }
  SurfelParameters p = without_friction();
  p.support_radius_m = 0.01, p.fused_frames = 2;
  SurfelRenderer r = surfels_over(halves[0], p);
  r.on_frame(scenes::frame(halves[1], 1));
  const RenderOutput out = go(r, {0.004, 0.02, 0}, {0.004, -0.005, 0});
  double weights = 0, sum = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double q = std::min((whole.point(i) - out.proxy_W).norm() / p.support_radius_m, 1.0);
    const double weight = std::pow(1 - q, 4) * (4 * q + 1);
    weights += weight, sum += weight * stiffness(whole.point(i));
  }
  ASSERT_GT(sum / weights, 350);
  EXPECT_NEAR(out.force_N.norm() / (out.proxy_W - Vec3(0.004, -0.005, 0)).norm(), sum / weights, 0.01);
}

}  // namespace
}  // namespace remote_touch::implicit_surface_renderer_test
