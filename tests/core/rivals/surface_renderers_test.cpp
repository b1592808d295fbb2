// The proxy on moving least squares surfaces, against closed forms on planes and on a sphere.
#include "core/rivals/mls_surface_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"

namespace remote_touch::mls_surface_renderer_test {
namespace {

using Settings = MlsSurfaceParameters;

Settings with(OutsideRule outside, int degree = 2) {
  Settings p;
  p.outside = outside, p.degree = degree;
  return p;
}

const Settings kAll[] = {with(OutsideRule::sensor), with(OutsideRule::path), with(OutsideRule::sensor, 1),
                         with(OutsideRule::path, 1)};

MlsSurfaceRenderer over(const PointCloud& cloud, const Settings& p = {}) {
  MlsSurfaceRenderer renderer(p, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

RenderOutput rest(MlsSurfaceRenderer& r, const Vec3& hip, int ticks = 40) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step({hip}, 0.001 * i);
  return out;
}

RenderOutput go(MlsSurfaceRenderer& r, const Vec3& from, const Vec3& to, int ticks = 60) {
  for (int i = 0; i < ticks; ++i) r.step({Vec3(from + (to - from) * (double(i) / ticks))}, 0.001 * i);
  return rest(r, to);
}

RenderOutput press(MlsSurfaceRenderer& r, double depth_m) {
  return go(r, {0, 0.02, 0}, {0, -depth_m, 0});
}

PointCloud bumps() {
  PointCloud cloud = scenes::flat_grid(60);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.009) * std::cos(cloud.z[i] / 0.012);
  return cloud;
}

constexpr double kRadius_m = 0.04;

// The upper half of a sphere around the origin, points about 1.2 mm apart.
PointCloud dome() {
  constexpr int kCount = 14000;
  const double turn = 3.14159265358979323846 * (3 - std::sqrt(5.0));
  PointCloud cloud;
  for (int i = 0; 2 * i < kCount; ++i) {
    const double y = 1 - (2 * i + 1.0) / kCount, r = std::sqrt(1 - y * y);
    cloud.append(kRadius_m * Vec3(r * std::cos(turn * i), y, r * std::sin(turn * i)));
  }
  return cloud;
}

TEST(MlsSurfaceRenderer, APlaneHoldsTheProxyOnItAndTheSpringDoesTheRest) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
    const RenderOutput out = go(r, {0, 0.03, 0}, {0.004, -0.03, 0.003});
    EXPECT_NEAR((out.proxy_W - Vec3(0.004, 0, 0.003)).norm(), 0, 2e-7);
    EXPECT_NEAR((out.force_N - Vec3(0, 18, 0)).norm(), 0, 2e-4);
    EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-9);
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_TRUE(out.converged);
  }
}

// The contact point is the position on the sphere nearest to the HIP. The polynomial of degree 2 is wrong by
// less than h^4 / (4 rho^3) = 1.6 um there, see mls_projection_test.cpp.
TEST(MlsSurfaceRenderer, ASphereIsHeldAtItsNearestPoint) {
  MlsSurfaceRenderer r = over(dome());
  go(r, {0, 0.05, 0}, {0, 0.03, 0});
  for (int tick = 0; tick <= 200; ++tick) {
    const double angle = 0.004 * tick;
    const Vec3 hip = 0.032 * Vec3(0.8 * std::sin(angle), std::cos(angle), 0.6 * std::sin(angle));
    const RenderOutput out = r.step({hip}, 0.001 * tick);
    ASSERT_EQ(out.state, ContactState::contact) << tick;
    if (tick == 0) continue;  // the HIP jumps
    EXPECT_NEAR(out.proxy_W.norm(), kRadius_m, 5e-6) << tick;
    EXPECT_NEAR((out.proxy_W.normalized() - hip.normalized()).norm(), 0, 1e-3) << tick;
    EXPECT_NEAR((out.force_N - 600 * (out.proxy_W - hip)).norm(), 0, 1e-12) << tick;
  }
}

// f is zero h^2 / (2 rho) = 0.25 mm inside the sphere. The contact begins at the surface all the same.
TEST(MlsSurfaceRenderer, TheForceBeginsAtNothing) {
  MlsSurfaceRenderer r = over(dome());
  for (int tick = 0; tick < 400; ++tick) {
    const double height = kRadius_m + 0.0001 - 1e-6 * tick;
    const double force = r.step({Vec3(0, height, 0)}, 0.001 * tick).force_N.norm();
    EXPECT_NEAR(force, 600 * std::max(0.0, kRadius_m - height), 600 * 3e-6) << tick;
  }
}

TEST(MlsSurfaceRenderer, ProxyIsOnTheSurfaceWhileTheHipPressesAndSlides) {
  const PointCloud cloud = bumps();
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(cloud, p);
    const MlsProjection surface(p.weight_width_m, p.degree);
    Neighbourhood near = scenes::neighbourhood(make_search(cloud), surface.support_radius_m());
    go(r, {-0.02, 0.03, 0}, {-0.02, -0.006, 0});
    for (int tick = 0; tick < 400; ++tick) {
      const RenderOutput out =
          r.step({Vec3(-0.02 + 0.0001 * tick, -0.006, 0.005 * std::sin(0.02 * tick))}, 0.001 * tick);
      ASSERT_EQ(out.state, ContactState::contact) << tick;
      const MlsFoot foot = surface.project(near, out.proxy_W, out.normal_W);
      ASSERT_TRUE(foot.found);
      ASSERT_NEAR((foot.p_W - out.proxy_W).norm(), 0, 1e-8) << tick;
      ASSERT_GT(out.force_N.y(), 0) << tick;
    }
  }
}

TEST(MlsSurfaceRenderer, LeavesWithoutAForce) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(bumps(), p);
    go(r, {0, 0.03, 0}, {0, -0.01, 0});
    const RenderOutput out = go(r, {0, -0.01, 0}, {0, 0.02, 0});
    EXPECT_EQ(out.proxy_W, Vec3(0, 0.02, 0));
    EXPECT_TRUE(out.force_N.isZero(0));
    EXPECT_EQ(out.state, ContactState::free);
    EXPECT_TRUE(out.converged);
  }
}

// The HIP jumps to the far side in one tick. The renderer checks the way there.
TEST(MlsSurfaceRenderer, DoesNotJumpThrough) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
    r.step({Vec3(0, 0.05, 0)}, 0);
    r.step({Vec3(0.001, -0.05, 0)}, 0.001);
    const RenderOutput out = rest(r, {0.001, -0.05, 0});
    EXPECT_NEAR(out.proxy_W.y(), 0, 1e-9);
    EXPECT_NEAR(out.force_N.y(), 30, 1e-3);
  }
}

// The hand moves 0.2 m along the plane in one tick, and then through it. A tick checks at most 20 positions.
TEST(MlsSurfaceRenderer, ALongPathIsCheckedToItsEndInLaterTicks) {
  const Vec3 from_m(-0.1, 0.009, 0), to_m(0.1, -0.03, 0);
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(200), p);
    r.step({from_m}, 0);
    const RenderOutput first = r.step({to_m}, 0.001);
    EXPECT_NE(first.proxy_W, to_m);
    EXPECT_LE(first.steps, 22);
    EXPECT_NEAR(rest(r, to_m, 200).force_N.y(), 18, 1e-3);
  }
}

TEST(MlsSurfaceRenderer, EveryTickMakesProgressWithTheFewestSteps) {
  Settings p;
  p.steps_per_tick = 4;
  MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
  for (int tick = 0; tick < 60; ++tick) EXPECT_LE(r.step({Vec3(0, 0.02 - 0.0005 * tick, 0)}, 0).steps, 6);
  EXPECT_NEAR((rest(r, {0.01, -0.01, 0}, 100).proxy_W - Vec3(0.01, 0, 0)).norm(), 0, 2e-7);
}

// --- the side ---

// The rule of the sensor draws a HIP behind the sheet to the front. The rule of the path gives the sheet two
// sides.
TEST(MlsSurfaceRenderer, TheRuleOfTheOutsideDecidesAtTheBackOfASheet) {
  const auto force_from_below = [](const Settings& p) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
    return go(r, {0, -0.02, 0}, {0, 0.002, 0}).force_N.y();
  };
  const auto force_below = [](const Settings& p) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
    return go(r, {0, -0.02, 0}, {0, -0.003, 0}).force_N.y();
  };
  EXPECT_NEAR(force_below(with(OutsideRule::sensor)), 600 * 0.003, 1e-4);
  EXPECT_EQ(force_from_below(with(OutsideRule::sensor)), 0) << "it is in front";
  EXPECT_EQ(force_below(with(OutsideRule::path)), 0);
  EXPECT_NEAR(force_from_below(with(OutsideRule::path)), -600 * 0.002, 1e-4);
  Settings seen_from_below;
  seen_from_below.view_direction = Vec3::UnitY();
  EXPECT_EQ(force_below(seen_from_below), 0);
}

TEST(MlsSurfaceRenderer, TheSensorOfAnImageIsItsCamera) {
  const CameraIntrinsics camera{64, 64, 200, 200, 31.5, 31.5};
  const DepthImage image{64, 64, std::vector<double>(64 * 64, 0.5)};
  Settings p;
  p.view_direction = {0, 0, -1};  // opposite direction: must not be used
  MlsSurfaceRenderer r = over(cloud_from_depth(image, camera, RigidTransform::Identity()), p);
  EXPECT_NEAR(go(r, {0, 0, 0.47}, {0, 0, 0.505}).force_N.z(), -600 * 0.005, 1e-4);
}

// --- frames ---

// The HIP has not crossed the surface on its way.
TEST(MlsSurfaceRenderer, HoldsAHipThatAFramePutBehindTheSurface) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(60, 0.0015, -0.004), p);
    EXPECT_EQ(rest(r, Vec3::Zero()).state, ContactState::free);
    r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.006), 1));
    const RenderOutput out = rest(r, Vec3::Zero());
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_NEAR((out.force_N - Vec3(0, 3.6, 0)).norm(), 0, 1e-4);
  }
}

// A jump of the cloud by less than R = 11.25 mm is followed. After a longer one the contact is lost.
TEST(MlsSurfaceRenderer, FollowsAJumpOfTheCloudByLessThanTheRadius) {
  for (const Settings& p : kAll) {
    for (const double jump_m : {0.003, 0.009, 0.013}) {
      MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
      press(r, 0.01);
      r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, jump_m), 1));
      const RenderOutput out = r.step({Vec3(0, -0.01, 0)}, 0.05);
      if (jump_m < 0.011) {
        EXPECT_NEAR(out.proxy_W.y(), jump_m, 1e-9);
        EXPECT_EQ(out.state, ContactState::contact);
      } else {
        EXPECT_EQ(out.state, ContactState::free);
        EXPECT_TRUE(out.force_N.isZero(0));
      }
    }
  }
}

// The surface sinks below the HIP: nothing pulls the HIP down.
TEST(MlsSurfaceRenderer, ASurfaceThatSinksReleasesTheHip) {
  MlsSurfaceRenderer r = over(scenes::flat_grid(60));
  press(r, 0.001);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, -0.005), 1));
  EXPECT_TRUE(r.step({Vec3(0, -0.001, 0)}, 0.05).force_N.isZero(0));
  EXPECT_EQ(rest(r, {0, -0.001, 0}).proxy_W, Vec3(0, -0.001, 0));
}

TEST(MlsSurfaceRenderer, AFrameWithTheSamePointsChangesNothing) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer a = over(bumps(), p), b = over(bumps(), p);
    for (int tick = 0; tick < 100; ++tick) {
      if (tick % 7 == 3) b.on_frame(scenes::frame(bumps(), 1 + tick));
      const DeviceState device{Vec3(0.0002 * tick, std::max(0.02 - 0.001 * tick, -0.01), 0)};
      const RenderOutput x = a.step(device, 0.001 * tick), y = b.step(device, 0.001 * tick);
      ASSERT_EQ(x.proxy_W, y.proxy_W) << tick;
      ASSERT_EQ(x.steps, y.steps) << tick;
    }
  }
}

TEST(MlsSurfaceRenderer, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud cloud = bumps();
  PointCloud reversed;
  for (std::size_t i = cloud.size(); i-- > 0;) reversed.append(cloud.point(i));
  Settings p;
  p.weight_width_m = 0;  // the spacing must not depend on the order either
  MlsSurfaceRenderer a = over(cloud, p), b = over(reversed, p);
  for (int tick = 0; tick < 100; ++tick) {
    const DeviceState device{Vec3(0.0002 * tick, std::max(0.02 - 0.001 * tick, -0.01), 0)};
    const RenderOutput x = a.step(device, 0.001 * tick), y = b.step(device, 0.001 * tick);
    ASSERT_EQ(x.proxy_W, y.proxy_W) << tick;
    ASSERT_EQ(x.force_N, y.force_N) << tick;
  }
}

TEST(MlsSurfaceRenderer, FramesWithoutPointsEndTheContact) {
  for (const Settings& p : kAll) {
    for (const PointCloud& nothing : {PointCloud{}, scenes::cloud_of({Vec3::Constant(std::nan(""))})}) {
      MlsSurfaceRenderer r = over(scenes::flat_grid(60), p);
      press(r, 0.01);
      r.on_frame(scenes::frame(nothing, 1));
      const RenderOutput out = r.step({Vec3(0, -0.01, 0)}, 0.1);
      EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
      EXPECT_TRUE(out.force_N.isZero(0));
      EXPECT_EQ(out.contact_count, 0);
    }
  }
}

// --- noise, borders, settings ---

// The standard deviation of the height of the surface is 0.2 mm, a twelfth of the limit.
TEST(MlsSurfaceRenderer, HoldsAPressOnANoisyPlane) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PointCloud cloud = scenes::flat_grid(60);
    add_noise(cloud, 0.001, noise_stream(NoiseKey{seed}, NoiseUse::point_position, 0), scenes::kernels());
    MlsSurfaceRenderer r = over(cloud);
    const RenderOutput out = press(r, 0.01);
    EXPECT_GT(out.proxy_W.y(), -0.0025) << seed;
    EXPECT_GT(out.force_N.y(), 4) << seed;
  }
}

TEST(MlsSurfaceRenderer, SlidesOffTheEdge) {
  for (const Settings& p : kAll) {
    MlsSurfaceRenderer r = over(scenes::flat_grid(30), p);  // to x = 21.75 mm
    press(r, 0.003);
    EXPECT_GT(go(r, {0, -0.003, 0}, {0.02, -0.003, 0}, 200).force_N.y(), 1.7);
    const RenderOutput out = go(r, {0.02, -0.003, 0}, {0.03, -0.003, 0}, 100);
    EXPECT_EQ(out.proxy_W, Vec3(0.03, -0.003, 0));
    EXPECT_TRUE(out.force_N.isZero(0));
  }
}

// h is three times the spacing, so R is 7.5 times the spacing.
TEST(MlsSurfaceRenderer, WidthZeroIsThreeSpacings) {
  Settings p;
  p.weight_width_m = 0;
  MlsSurfaceRenderer r = over({}, p);
  rest(r, {0, 0.03, 0});
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.002), 1));  // R = 15 mm, but for the corners
  EXPECT_EQ(rest(r, {0, 0.0155, 0}).contact_count, 0);
  EXPECT_GT(rest(r, {0, 0.0145, 0}).contact_count, 0);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.001), 2));  // later frames do not change it
  EXPECT_GT(rest(r, {0, 0.0145, 0}).contact_count, 0);
}

// (5.8): stiff points to the right, soft ones to the left.
TEST(MlsSurfaceRenderer, PointsGiveTheirStiffness) {
  PointCloud cloud = scenes::flat_grid(60);
  for (const double x : cloud.x) cloud.stiffness_N_per_m.push_back(x > 0 ? 400 : 200);
  for (const double x : {-0.02, 0.02}) {
    MlsSurfaceRenderer r = over(cloud);
    const RenderOutput out = go(r, {x, 0.02, 0}, {x, -0.01, 0});
    EXPECT_NEAR(out.force_N.y(), x > 0 ? 4 : 2, 1e-4);
  }
}

TEST(MlsSurfaceRenderer, ADeviceThatIsNotFiniteGetsNoForceAndTheContactReturns) {
  MlsSurfaceRenderer r = over(scenes::flat_grid(60));
  const RenderOutput before = press(r, 0.02);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const RenderOutput out = r.step({Vec3(0, bad, 0)}, 0.1);
    EXPECT_TRUE(out.force_N.isZero(0));
    EXPECT_EQ(out.proxy_W, before.proxy_W);
  }
  EXPECT_NEAR((r.step({Vec3(0, -0.02, 0)}, 0.101).force_N - before.force_N).norm(), 0, 1e-6);
}

TEST(MlsSurfaceRenderer, RefusesAWidthThatIsNearlyZero) {
  Settings p;
  EXPECT_EQ(validate(p), "");
  p.weight_width_m = 0;
  EXPECT_EQ(validate(p), "");
  p.weight_width_m = 1e-9;
  EXPECT_EQ(validate(p), "weight_width_m: expected 0, or 0.000001 or more");
  p.weight_width_m = 0.01, p.view_direction = Vec3::Zero();
  EXPECT_EQ(validate(p), "view_direction: expected a vector of length 0.001 or more");
}

}  // namespace
}  // namespace remote_touch::mls_surface_renderer_test
