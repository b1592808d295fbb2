// Proxies on surfaces that points define: what all of them have in common, and moving least squares against
// closed forms on planes and on a sphere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/rivals/implicit_surface_renderers.h"
#include "core/rivals/mls_surface_renderer.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/core/rivals/moved_hip.h"
#include "tests/support/scenes.h"

namespace remote_touch::surface_renderers_test {
namespace {

using namespace moved_hip;

struct Row {
  std::string name;
  std::function<std::unique_ptr<Renderer>()> make;
  double followed_m, lost_m;  // jumps of the cloud
  bool is_on_plane = true;    // the surface of points in a plane is that plane
  bool has_front = false;     // also a HIP that a frame puts behind the surface is held
  int most_steps = 0;         // the limit of a tick; 0: a path is checked to its end
  double reach_m = 0;         // needed by off_surface
  std::function<double(Neighbourhood& near, const RenderOutput& out)> off_surface = {};
};

Row implicit(SurfaceKind kind, SurfaceWeight weight) {
  ImplicitSurfaceParameters p;
  p.surface = kind, p.weight = weight;
  const PointSurface surface(kind, weight, p.support_radius_m, p.threshold);
  const bool is_surfels = kind == SurfaceKind::surfels;
  return {.name = is_surfels ? "surfels" : "metaballs",
          .make = [p] { return std::make_unique<ImplicitSurfaceRenderer>(p, 1000, scenes::kernels()); },
          .followed_m = 0.003,
          .lost_m = 0.03,
          .is_on_plane = is_surfels,
          .reach_m = p.support_radius_m,
          .off_surface =
              [surface](Neighbourhood& near, const RenderOutput& out) {
                const PointsView points = near.around(out.proxy_W).view();
                return surface.at(points, near.sum_grid(), out.proxy_W, Vec3::UnitY()).distance();
              }};
}

Row oriented_surfels() {
  SurfelParameters p;
  p.friction = 0;
  return {.name = "oriented surfels",
          .make = [p] { return std::make_unique<SurfelRenderer>(p, 1000, scenes::kernels()); },
          .followed_m = 0.003,
          .lost_m = 0.03,
          .has_front = true,
          .most_steps = 70};
}

Row mls(OutsideRule outside, int degree) {
  MlsSurfaceParameters p;
  p.outside = outside, p.degree = degree;
  const MlsProjection surface(p.weight_width_m, degree);
  return {.name = "moving least squares of degree " + std::to_string(degree),
          .make = [p] { return std::make_unique<MlsSurfaceRenderer>(p, 1000, scenes::kernels()); },
          .followed_m = 0.009,  // R is 11.25 mm
          .lost_m = 0.013,
          .has_front = true,
          .most_steps = 22,
          .reach_m = surface.support_radius_m(),
          .off_surface =
              [surface](Neighbourhood& near, const RenderOutput& out) {
                const MlsFoot foot = surface.project(near, out.proxy_W, out.normal_W);
                return foot.found ? (foot.p_W - out.proxy_W).norm() : 1;
              }};
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all{implicit(SurfaceKind::metaballs, SurfaceWeight::wyvill),
                                    implicit(SurfaceKind::metaballs, SurfaceWeight::wendland),
                                    implicit(SurfaceKind::surfels, SurfaceWeight::wyvill),
                                    implicit(SurfaceKind::surfels, SurfaceWeight::wendland),
                                    oriented_surfels(),
                                    mls(OutsideRule::sensor, 1),
                                    mls(OutsideRule::sensor, 2),
                                    mls(OutsideRule::path, 1),
                                    mls(OutsideRule::path, 2)};
  return all;
}

std::unique_ptr<Renderer> over(const Row& row, const PointCloud& cloud) {
  auto renderer = row.make();
  renderer->on_frame(scenes::frame(cloud));
  return renderer;
}

TEST(SurfaceRenderers, APlaneHoldsTheProxyOnItAndTheSpringDoesTheRest) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    if (!row.is_on_plane) continue;
    const RenderOutput out = go(*over(row, scenes::flat_grid(60)), {0, 0.03, 0}, {0.004, -0.03, 0.003});
    EXPECT_NEAR((out.proxy_W - Vec3(0.004, 0, 0.003)).norm(), 0, 2e-7);
    EXPECT_NEAR((out.force_N - Vec3(0, 18, 0)).norm(), 0, 2e-4);
    EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-9);
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_TRUE(out.converged);
  }
}

TEST(SurfaceRenderers, ProxyIsOnTheSurfaceWhileTheHipPressesAndSlides) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    if (!row.off_surface) continue;
    const auto r = over(row, bumps());
    Neighbourhood near = scenes::neighbourhood(make_search(bumps()), row.reach_m);
    go(*r, {-0.02, 0.03, 0}, {-0.02, -0.006, 0});
    for (int tick = 0; tick < 400; ++tick) {
      const RenderOutput out =
          r->step({Vec3(-0.02 + 0.0001 * tick, -0.006, 0.005 * std::sin(0.02 * tick))}, 0.001 * tick);
      ASSERT_EQ(out.state, ContactState::contact) << tick;
      ASSERT_NEAR(row.off_surface(near, out), 0, 1.1e-8) << tick;
      ASSERT_GT(out.force_N.y(), 0) << tick;
    }
  }
}

TEST(SurfaceRenderers, LeavingAndFramesWithoutPointsEndTheContact) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    for (const PointCloud& nothing : {PointCloud{}, scenes::cloud_of({Vec3::Constant(std::nan(""))})}) {
      const auto r = over(row, bumps());
      EXPECT_GT(press(*r, 0.01).force_N.y(), 1);
      RenderOutput out = go(*r, {0, -0.01, 0}, {0, 0.02, 0});
      EXPECT_EQ(out.proxy_W, Vec3(0, 0.02, 0));
      EXPECT_TRUE(out.force_N.isZero(0));
      EXPECT_EQ(out.state, ContactState::free);
      press(*r, 0.01);
      r->on_frame(scenes::frame(nothing, 1));
      out = r->step({Vec3(0, -0.01, 0)}, 0.1);
      EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
      EXPECT_TRUE(out.force_N.isZero(0));
      EXPECT_EQ(out.contact_count, 0);
    }
  }
}

// The HIP jumps to the far side in one tick. The renderer checks the way there.
TEST(SurfaceRenderers, DoNotJumpThrough) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    const auto r = over(row, scenes::flat_grid(60));
    r->step({Vec3(0, 0.05, 0)}, 0);
    r->step({Vec3(0.001, -0.05, 0)}, 0.001);
    const RenderOutput out = rest(*r, {0.001, -0.05, 0});
    EXPECT_GE(out.proxy_W.y(), -1e-9);
    EXPECT_GE(out.force_N.y(), 29.999);
  }
}

// The hand moves 0.2 m along the plane in one tick, and then through it.
TEST(SurfaceRenderers, ALongPathIsCheckedToItsEndInLaterTicks) {
  const Vec3 from_m(-0.1, 0.009, 0), to_m(0.1, -0.03, 0);
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    if (row.most_steps == 0) continue;
    const auto r = over(row, scenes::flat_grid(200));
    r->step({from_m}, 0);
    const RenderOutput first = r->step({to_m}, 0.001);
    EXPECT_NE(first.proxy_W, to_m);
    EXPECT_LE(first.steps, row.most_steps);
    EXPECT_NEAR(rest(*r, to_m, 200).force_N.y(), 18, 1e-3);
  }
}

// The HIP has not crossed the surface on its way.
TEST(SurfaceRenderers, HoldAHipThatAFramePutBehindTheirFront) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    if (!row.has_front) continue;
    const auto r = over(row, scenes::flat_grid(60, 0.0015, -0.004));
    EXPECT_EQ(rest(*r, Vec3::Zero()).state, ContactState::free);
    r->on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, 0.006), 1));
    const RenderOutput out = rest(*r, Vec3::Zero());
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_NEAR((out.force_N - Vec3(0, 3.6, 0)).norm(), 0, 1e-4);
  }
}

// A jump of the cloud that is shorter than the support radius is followed. After a longer one the contact is
// lost.
TEST(SurfaceRenderers, FollowAJumpOfTheCloudByLessThanTheRadius) {
  for (const Row& row : rows())
    for (const double jump_m : {row.followed_m, row.lost_m}) {
      SCOPED_TRACE(row.name);
      const auto r = over(row, scenes::flat_grid(60));
      const double held_m = press(*r, 0.01).proxy_W.y();
      r->on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, jump_m), 1));
      const RenderOutput out = r->step({Vec3(0, -0.01, 0)}, 0.05);
      EXPECT_EQ(out.state, jump_m == row.lost_m ? ContactState::free : ContactState::contact);
      if (jump_m == row.lost_m)
        EXPECT_TRUE(out.force_N.isZero(0));
      else
        EXPECT_NEAR(out.proxy_W.y(), held_m + jump_m, 1e-7);
    }
}

template <class Made, class Settings>
double force_on_an_image(Settings p) {
  const CameraIntrinsics camera{64, 64, 200, 200, 31.5, 31.5};
  const DepthImage image{64, 64, std::vector<double>(64 * 64, 0.5)};
  p.view_direction = {0, 0, -1};  // opposite direction: must not be used
  Made r = moved_hip::over<Made>(cloud_from_depth(image, camera, RigidTransform::Identity()), p);
  return go(r, {0, 0, 0.47}, {0, 0, 0.505}).force_N.z();
}

TEST(SurfaceRenderers, TheSensorOfAnImageIsItsCamera) {
  EXPECT_NEAR(force_on_an_image<SurfelRenderer>(SurfelParameters()), -600 * 0.005, 1e-4);
  EXPECT_NEAR(force_on_an_image<MlsSurfaceRenderer>(MlsSurfaceParameters()), -600 * 0.005, 1e-4);
}

// --- moving least squares ---

MlsSurfaceRenderer mls_over(const PointCloud& cloud, const MlsSurfaceParameters& p = {}) {
  return moved_hip::over<MlsSurfaceRenderer>(cloud, p);
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

// The contact point is the position on the sphere nearest to the HIP. The polynomial of degree 2 is wrong by
// less than h^4 / (4 rho^3) = 1.6 um there.
TEST(MlsSurfaceRenderer, ASphereIsHeldAtItsNearestPoint) {
  MlsSurfaceRenderer r = mls_over(dome());
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
  MlsSurfaceRenderer r = mls_over(dome());
  for (int tick = 0; tick < 400; ++tick) {
    const double height = kRadius_m + 0.0001 - 1e-6 * tick;
    const double force = r.step({Vec3(0, height, 0)}, 0.001 * tick).force_N.norm();
    EXPECT_NEAR(force, 600 * std::max(0.0, kRadius_m - height), 600 * 3e-6) << tick;
  }
}

TEST(MlsSurfaceRenderer, EveryTickMakesProgressWithTheFewestSteps) {
  MlsSurfaceParameters p;
  p.steps_per_tick = 4;
  MlsSurfaceRenderer r = mls_over(scenes::flat_grid(60), p);
  for (int tick = 0; tick < 60; ++tick) EXPECT_LE(r.step({Vec3(0, 0.02 - 0.0005 * tick, 0)}, 0).steps, 6);
  EXPECT_NEAR((rest(r, {0.01, -0.01, 0}, 100).proxy_W - Vec3(0.01, 0, 0)).norm(), 0, 2e-7);
}

// The rule of the sensor draws a HIP behind the sheet to the front. The rule of the path gives the sheet two
// sides.
TEST(MlsSurfaceRenderer, TheRuleOfTheOutsideDecidesAtTheBackOfASheet) {
  MlsSurfaceParameters path, seen_from_below;
  path.outside = OutsideRule::path;
  seen_from_below.view_direction = Vec3::UnitY();
  const auto force_at = [](double height_m, const MlsSurfaceParameters& p) {
    MlsSurfaceRenderer r = mls_over(scenes::flat_grid(60), p);
    return go(r, {0, -0.02, 0}, {0, height_m, 0}).force_N.y();
  };
  EXPECT_NEAR(force_at(-0.003, {}), 600 * 0.003, 1e-4);
  EXPECT_EQ(force_at(0.002, {}), 0) << "it is in front";
  EXPECT_EQ(force_at(-0.003, path), 0);
  EXPECT_NEAR(force_at(0.002, path), -600 * 0.002, 1e-4);
  EXPECT_EQ(force_at(-0.003, seen_from_below), 0);
}

// The surface sinks below the HIP: nothing pulls the HIP down.
TEST(MlsSurfaceRenderer, ASurfaceThatSinksReleasesTheHip) {
  MlsSurfaceRenderer r = mls_over(scenes::flat_grid(60));
  press(r, 0.001);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.0015, -0.005), 1));
  EXPECT_TRUE(r.step({Vec3(0, -0.001, 0)}, 0.05).force_N.isZero(0));
  EXPECT_EQ(rest(r, {0, -0.001, 0}).proxy_W, Vec3(0, -0.001, 0));
}

// The standard deviation of the height of the surface is 0.2 mm, a twelfth of the limit.
TEST(MlsSurfaceRenderer, HoldsAPressOnANoisyPlane) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PointCloud cloud = scenes::flat_grid(60);
    add_noise(cloud, 0.001, noise_stream(NoiseKey{seed}, NoiseUse::point_position, 0), scenes::kernels());
    MlsSurfaceRenderer r = mls_over(cloud);
    const RenderOutput out = press(r, 0.01);
    EXPECT_GT(out.proxy_W.y(), -0.0025) << seed;
    EXPECT_GT(out.force_N.y(), 4) << seed;
  }
}

TEST(MlsSurfaceRenderer, SlidesOffTheEdge) {
  MlsSurfaceRenderer r = mls_over(scenes::flat_grid(30));  // its edge is at x = 21.75 mm
  press(r, 0.003);
  EXPECT_GT(go(r, {0, -0.003, 0}, {0.02, -0.003, 0}, 200).force_N.y(), 1.7);
  const RenderOutput out = go(r, {0.02, -0.003, 0}, {0.03, -0.003, 0}, 100);
  EXPECT_EQ(out.proxy_W, Vec3(0.03, -0.003, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
}

// h is three times the spacing, so R is 7.5 times the spacing.
TEST(MlsSurfaceRenderer, WidthZeroIsThreeSpacings) {
  MlsSurfaceParameters p;
  p.weight_width_m = 0;
  MlsSurfaceRenderer r = mls_over({}, p);
  rest(r, {0, 0.03, 0});
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.002), 1));  // R = 15 mm, but for the corners
  EXPECT_EQ(rest(r, {0, 0.0155, 0}).contact_count, 0);
  EXPECT_GT(rest(r, {0, 0.0145, 0}).contact_count, 0);
  r.on_frame(scenes::frame(scenes::flat_grid(60, 0.001), 2));  // later frames do not change it
  EXPECT_GT(rest(r, {0, 0.0145, 0}).contact_count, 0);
}

}  // namespace
}  // namespace remote_touch::surface_renderers_test
