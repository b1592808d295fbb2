#include "core/rivals/implicit_surface_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rivals/rival_renderer.h"
#include "scenarios/synthetic/resting_clouds.h"
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
