#include "core/rivals/implicit_surface_renderers.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "core/points/point_cloud.h"
#include "core/rivals/rival_renderer.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"

namespace remote_touch::implicit_surface_renderer_test {
namespace {

using Settings = ImplicitSurfaceParameters;

Settings with(SurfaceKind surface, SurfaceWeight weight = SurfaceWeight::wyvill) {
  Settings p;
  p.surface = surface, p.weight = weight;
  return p;
}

const Settings kAll[] = {with(SurfaceKind::metaballs), with(SurfaceKind::metaballs, SurfaceWeight::wendland),
                         with(SurfaceKind::surfels), with(SurfaceKind::surfels, SurfaceWeight::wendland)};

ImplicitSurfaceRenderer over(const PointCloud& cloud, const Settings& p) {
  ImplicitSurfaceRenderer renderer(p, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

RenderOutput go(ImplicitSurfaceRenderer& r, const Vec3& from, const Vec3& to, int ticks = 40) {
  RenderOutput out;
  for (int i = 0; i <= ticks; ++i)
    out = r.step({i < ticks ? Vec3(from + (to - from) * (double(i) / ticks)) : to}, 0.001 * i);
  return out;
}

PointCloud bumps(int n) {
  PointCloud cloud = scenes::flat_grid(n);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.006) * std::cos(cloud.z[i] / 0.008);
  return cloud;
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

TEST(ImplicitSurfaceRenderer, SurfelsOfAPlaneHoldTheProxyOnIt) {
  for (const SurfaceWeight weight : {SurfaceWeight::wyvill, SurfaceWeight::wendland}) {
    ImplicitSurfaceRenderer r = over(scenes::flat_grid(60), with(SurfaceKind::surfels, weight));
    const RenderOutput out = go(r, {0, 0.03, 0}, {0.004, -0.03, 0.003});
    EXPECT_NEAR((out.proxy_W - Vec3(0.004, 0, 0.003)).norm(), 0, 1e-8);
    EXPECT_NEAR((out.force_N - Vec3(0, 18, 0)).norm(), 0, 1e-5);
    EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-9);
  }
}

// The level set of metaballs lies off the points, by less than R.
TEST(ImplicitSurfaceRenderer, MetaballsOfAPlaneHoldTheProxyAtAnEvenHeight) {
  ImplicitSurfaceRenderer r = over(scenes::flat_grid(60), with(SurfaceKind::metaballs));
  double low = 1, high = 0;
  for (int i = 0; i <= 20; ++i) {
    const RenderOutput out = go(r, {0.0002 * i, 0.02, 0}, {0.0002 * i, -0.02, 0});
    low = std::min(low, out.proxy_W.y()), high = std::max(high, out.proxy_W.y());
  }
  EXPECT_GT(low, 0.5 * 0.01);
  EXPECT_LT(high, 0.01);
  EXPECT_LT(high - low, 1e-5);
}

TEST(ImplicitSurfaceRenderer, ProxyIsOnTheSurfaceWhileTheHipPressesAndSlides) {
  const PointCloud cloud = bumps(60);
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer r = over(cloud, p);
    const PointSurface surface(p.surface, p.weight, p.support_radius_m, p.threshold);
    Neighbourhood near = scenes::neighbourhood(make_search(cloud), p.support_radius_m);
    go(r, {-0.02, 0.03, 0}, {-0.02, -0.01, 0});
    for (int tick = 0; tick < 400; ++tick) {
      const RenderOutput out =
          r.step({Vec3(-0.02 + 0.0001 * tick, -0.01, 0.005 * std::sin(0.02 * tick))}, 0.001 * tick);
      ASSERT_EQ(out.state, ContactState::contact) << tick;
      const PointsView points = near.around(out.proxy_W).view();
      const SurfaceSample at = surface.at(points, near.sum_grid(), out.proxy_W, Vec3::UnitY());
      ASSERT_NEAR(at.distance(), 0, 1.1e-8) << tick;
      ASSERT_GT(out.force_N.y(), 0) << tick;
    }
  }
}

TEST(ImplicitSurfaceRenderer, LeavesWithoutAForce) {
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer r = over(bumps(60), p);
    go(r, {0, 0.03, 0}, {0, -0.01, 0});
    const RenderOutput out = go(r, {0, -0.01, 0}, {0, 0.02, 0});
    EXPECT_EQ(out.proxy_W, Vec3(0, 0.02, 0));
    EXPECT_TRUE(out.force_N.isZero(0));
    EXPECT_EQ(out.state, ContactState::free);
  }
}

// The HIP jumps to the far side in one tick. The renderer checks the way there.
TEST(ImplicitSurfaceRenderer, DoesNotJumpThrough) {
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer r = over(scenes::flat_grid(60), p);
    r.step({Vec3(0, 0.05, 0)}, 0);
    const RenderOutput out = r.step({Vec3(0.001, -0.05, 0)}, 0.001);
    EXPECT_GE(out.proxy_W.y(), -1e-9);
    EXPECT_GT(out.force_N.y(), 1);
  }
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

// A jump of the cloud that is shorter than the support radius is followed. After a jump far beyond it, the
// contact is lost.
TEST(ImplicitSurfaceRenderer, IsBroughtBackFromASmallJumpOfTheCloudOnly) {
  for (const Settings& p : kAll) {
    for (const double jump : {0.003, 0.03}) {
      ImplicitSurfaceRenderer r = over(scenes::flat_grid(60), p);
      const double held = go(r, {0, 0.03, 0}, {0, -0.01, 0}).proxy_W.y();
      r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, jump), 1));
      const RenderOutput out = r.step({Vec3(0, -0.01, 0)}, 0.05);
      if (jump < 0.01) {
        EXPECT_NEAR(out.proxy_W.y(), held + jump, 1e-7);
      } else {
        EXPECT_EQ(out.state, ContactState::free) << "popped through";
      }
    }
  }
}

TEST(ImplicitSurfaceRenderer, AFrameWithTheSamePointsChangesNothing) {
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer a = over(bumps(60), p), b = over(bumps(60), p);
    for (int tick = 0; tick < 100; ++tick) {
      if (tick % 7 == 3) b.on_frame(scenes::frame(bumps(60), 1 + tick));
      const DeviceState device{Vec3(0.0002 * tick, std::max(0.02 - 0.001 * tick, -0.01), 0)};
      const RenderOutput x = a.step(device, 0.001 * tick), y = b.step(device, 0.001 * tick);
      ASSERT_EQ(x.proxy_W, y.proxy_W) << tick;
      ASSERT_EQ(x.steps, y.steps) << tick;
    }
  }
}

// Slides over the wave of 4.3.3 and presses in slowly. Returns the largest change of the force in a tick,
// divided by the change that a spring to a fixed position would give for the same motion of the HIP. The
// surface that is felt lies off_m above the points. The HIP must not be deeper under a ridge than the ridge's
// radius, because every proxy changes sides at once there.
double roughest(Renderer& r, const TriangleWave& wave, double off_m) {
  r.on_frame({0, 0, 0, wave.points(0)});
  Vec3 last_hip = Vec3::Zero(), last_force = Vec3::Zero();
  double roughest = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    const double x = -0.1 + 0.0001 * tick, press = off_m + 0.008 - 8e-6 * tick;
    const Vec3 hip(x, wave.surface_height(x, 0, 0) + press, 0.0003);
    const Vec3 force = r.step({hip}, 0.001 * tick).force_N;
    if (tick > 20)
      roughest = std::max(roughest, (force - last_force).norm() / (600 * (hip - last_hip).norm()));
    last_hip = hip, last_force = force;
  }
  return roughest;
}

TEST(ImplicitSurfaceRenderer, IsSmootherOverATriangleWaveThanDirectRendering) {
  const TriangleWave wave({}, NoiseKey{1}, scenes::kernels());
  PenaltyRenderer direct({}, 1000, scenes::kernels());
  const double direct_roughness = roughest(direct, wave, 0);
  EXPECT_GT(direct_roughness, 10) << "its force turns round at the surface";
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer r(p, 1000, scenes::kernels());
    const double off_m = p.surface == SurfaceKind::metaballs ? 0.0086 : 0;
    EXPECT_LT(roughest(r, wave, off_m), 2);
  }
}

TEST(ImplicitSurfaceRenderer, AnEmptyFrameEndsTheContact) {
  for (const Settings& p : kAll) {
    ImplicitSurfaceRenderer r = over(scenes::flat_grid(60), p);
    go(r, {0, 0.03, 0}, {0, -0.01, 0});
    r.on_frame(scenes::frame({}, 1));
    const RenderOutput out = r.step({Vec3(0, -0.01, 0)}, 0.05);
    EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
    EXPECT_TRUE(out.force_N.isZero(0));
  }
}

}  // namespace
}  // namespace remote_touch::implicit_surface_renderer_test

// Surfels with normals towards the sensor, against closed forms on planes.
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
