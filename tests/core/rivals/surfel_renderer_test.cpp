// Surfels with normals towards the sensor, against closed forms on planes.
#include "core/rivals/surfel_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/points/point_cloud.h"
#include "tests/support/scenes.h"

namespace remote_touch::surfel_renderer_test {
namespace {

SurfelParameters without_friction() {
  SurfelParameters p;
  p.friction = 0;
  return p;
}

SurfelRenderer over(const PointCloud& cloud, const SurfelParameters& p) {
  SurfelRenderer renderer(p, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

RenderOutput rest(SurfelRenderer& r, const Vec3& hip, int ticks = 40) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step({hip}, 0.001 * i);
  return out;
}

RenderOutput press(SurfelRenderer& r, double depth_m, double from_m = 0.02) {
  for (double y = from_m; y > -depth_m; y -= 0.0005) r.step({Vec3(0, y, 0)}, 0);
  return rest(r, {0, -depth_m, 0});
}

TEST(SurfelRenderer, APlaneHoldsTheProxyOnItAndTheSpringDoesTheRest) {
  SurfelRenderer r = over(scenes::flat_grid(60), {});
  const RenderOutput out = press(r, 0.03);
  EXPECT_NEAR(out.proxy_W.norm(), 0, 1e-8);
  EXPECT_NEAR((out.force_N - Vec3(0, 18, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-9);
  EXPECT_EQ(out.state, ContactState::contact);
  EXPECT_TRUE(out.converged);
}

// f < 0 at the HIP is enough for a contact: the HIP has not crossed the surface on its way.
TEST(SurfelRenderer, HoldsAHipThatAFramePutBehindTheSurface) {
  SurfelRenderer r = over(scenes::flat_grid(60, 0.0015, -0.05), {});
  EXPECT_EQ(rest(r, Vec3::Zero()).state, ContactState::free);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.006), 1));
  const RenderOutput out = rest(r, Vec3::Zero());
  EXPECT_EQ(out.state, ContactState::contact);
  EXPECT_NEAR((out.force_N - Vec3(0, 3.6, 0)).norm(), 0, 1e-5);
}

TEST(SurfelRenderer, LosesAHipThatIsFartherBehindThanTheRadius) {
  SurfelRenderer r = over(scenes::flat_grid(60, 0.0015, -0.05), {});
  rest(r, Vec3::Zero());
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.0101), 1));
  EXPECT_TRUE(rest(r, Vec3::Zero()).force_N.isZero(0));
}

// A tick checks at most 64 positions, R / 8 apart. The hand moves 0.2 m along the plane, and then through it.
TEST(SurfelRenderer, ALongPathIsCheckedToItsEndInLaterTicks) {
  const Vec3 from_m(-0.1, 0.009, 0),
      to_m(0.1, -0.011, 0);  // the HIP is too deep to be found behind the plane
  SurfelRenderer r = over(scenes::flat_grid(200), without_friction());
  r.step({from_m}, 0);
  const RenderOutput first = r.step({to_m}, 0.001);
  EXPECT_NE(first.proxy_W, to_m);
  EXPECT_GT(rest(r, to_m).force_N.y(), 1);
}

// The front is the side of the sensor, not that from which the HIP comes. The HIP is therefore drawn to the
// front.
TEST(SurfelRenderer, TheBackOfASheetPullsTheHandThrough) {
  SurfelRenderer r = over(scenes::flat_grid(60), {});
  for (double y = -0.02; y < -0.002; y += 0.0005) r.step({Vec3(0, y, 0)}, 0);
  EXPECT_GT(rest(r, {0, -0.002, 0}).force_N.y(), 1.1);
  SurfelParameters below;
  below.view_direction = Vec3::UnitY();
  SurfelRenderer seen_from_below = over(scenes::flat_grid(60), below);
  for (double y = -0.02; y < -0.002; y += 0.0005) seen_from_below.step({Vec3(0, y, 0)}, 0);
  EXPECT_TRUE(rest(seen_from_below, {0, -0.002, 0}).force_N.isZero(0));
}

TEST(SurfelRenderer, ACameraTurnsTheNormals) {
  const CameraIntrinsics camera{64, 64, 200, 200, 31.5, 31.5};
  DepthImage image{64, 64, std::vector<double>(64 * 64, 0.5)};
  RigidTransform X_WC = RigidTransform::Identity();  // the camera faces +z
  SurfelParameters p;
  p.view_direction = {0, 0, -1};  // opposite direction: must not be used
  SurfelRenderer r = over(cloud_from_depth(image, camera, X_WC), p);
  for (double z = 0.47; z < 0.505; z += 0.0005) r.step({Vec3(0, 0, z)}, 0);
  EXPECT_NEAR(rest(r, {0, 0, 0.505}).force_N.z(), -600 * 0.005, 1e-5);
}

// A HIP beside the proxy: without friction the proxy ends over it, with friction mu it stays back by mu times
// the depth.
TEST(SurfelRenderer, FrictionHoldsTheProxyBackByItsConeAndNoMore) {
  for (const double mu : {0.0, 0.2, 0.7}) {
    SurfelParameters p;
    p.friction = mu;
    SurfelRenderer r = over(scenes::flat_grid(60), p);
    press(r, 0.01);
    const RenderOutput out = rest(r, {0.02, -0.01, 0}, 200);
    EXPECT_NEAR(out.proxy_W.x(), 0.02 - mu * 0.01, 1e-6) << mu;
    EXPECT_NEAR(out.force_N.x(), -600 * mu * 0.01, 1e-3) << mu;
  }
}

// The first tick after a jump of the surface brings the proxy out by R / 2, the second by the rest.
TEST(SurfelRenderer, ProjectsByHalfTheRadiusPerTick) {
  SurfelRenderer r = over(scenes::flat_grid(60), without_friction());
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
    SurfelRenderer r = over(scenes::flat_grid(60), p);
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
  SurfelRenderer r = over(scenes::flat_grid(60, 0.002), p);  // R = 6 mm, but for the border
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
    SurfelRenderer r = over(halves[0], p);
    r.on_frame(scenes::frame(halves[1], 1));
    for (double y = 0.02; y > -0.005; y -= 0.0005) r.step({Vec3(-0.02, y, 0)}, 0);
    const double force = rest(r, {-0.02, -0.005, 0}).force_N.y();
    if (fused == 1)
      EXPECT_EQ(force, 0);
    else
      EXPECT_NEAR(force, 3, 1e-5);
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
    SurfelRenderer r = over(image, p);
    for (int frame = 1; frame < 6; ++frame) r.on_frame(scenes::frame(image, frame));
    for (double y = -0.02; y < 0.005; y += 0.0005) r.step({Vec3(0, y, 0)}, 0);
    const RenderOutput out = rest(r, {0, 0.005, 0});
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
  SurfelRenderer r = over(halves[0], p);
  r.on_frame(scenes::frame(halves[1], 1));
  for (double y = 0.02; y > -0.005; y -= 0.0005) r.step({Vec3(0.004, y, 0)}, 0);
  const RenderOutput out = rest(r, {0.004, -0.005, 0});
  double weights = 0, sum = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double q = std::min((whole.point(i) - out.proxy_W).norm() / p.support_radius_m, 1.0);
    const double weight = std::pow(1 - q, 4) * (4 * q + 1);
    weights += weight, sum += weight * stiffness(whole.point(i));
  }
  ASSERT_GT(sum / weights, 350);
  EXPECT_NEAR(out.force_N.norm() / (out.proxy_W - Vec3(0.004, -0.005, 0)).norm(), sum / weights, 0.01);
}

TEST(SurfelRenderer, LeavingAndAnEmptyFrameEndTheContact) {
  SurfelRenderer r = over(scenes::flat_grid(60), {});
  press(r, 0.01);
  RenderOutput out = rest(r, {0, 0.02, 0});
  EXPECT_EQ(out.proxy_W, Vec3(0, 0.02, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
  press(r, 0.01);
  r.on_frame(scenes::frame({}, 1));
  out = r.step({Vec3(0, -0.01, 0)}, 0.1);
  EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
}

}  // namespace
}  // namespace remote_touch::surfel_renderer_test
