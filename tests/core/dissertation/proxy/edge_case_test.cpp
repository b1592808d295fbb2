// Cases in which proxy renderers are known to fail. Each test runs the whole renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

namespace remote_touch::edge_case_test {
namespace {

constexpr double kContactRadius = 0.005, kShell = 1.0001e-5;

// Renders the same HIP for some ticks and returns the last output.
RenderOutput hold(Renderer& renderer, const Vec3& hip, int ticks = 20, double start_s = 0) {
  RenderOutput out;
  for (int tick = 0; tick < ticks; ++tick) out = renderer.step({hip}, start_s + 0.001 * tick);
  return out;
}

TEST(EdgeCase, APointExactlyAtTheProxyDoesNoHarm) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::cloud_of({{0, 0, 0}})));
  const RenderOutput stuck = renderer.step({Vec3::Zero()}, 0);  // starts on the point: no direction is better
  EXPECT_EQ(stuck.status, RenderStatus::degenerate_normal);
  EXPECT_TRUE(stuck.proxy_W.allFinite());
  const RenderOutput out = hold(renderer, Vec3(0, -0.01, 0), 5, 0.001);
  EXPECT_TRUE(out.proxy_W.allFinite());
  EXPECT_GE(out.nearest_distance_m, kContactRadius - kShell);  // the proxy has moved out
}

// Frames without points, before a contact and in it.
TEST(EdgeCase, ACloudWithoutPointsGivesNoForce) {
  PointCloud missing = scenes::flat_grid(30);
  missing.x.assign(missing.size(), std::nan("")), missing.y = missing.x, missing.z = missing.x;
  const Vec3 below(0, -0.01, 0);
  for (const PointCloud& blank : {PointCloud{}, missing}) {
    ProxyRenderer renderer = scenes::renderer();
    for (const int index : {0, 2}) {
      renderer.on_frame(scenes::frame(blank, index));
      const RenderOutput out = hold(renderer, below, 20, 0.033 * index);
      EXPECT_EQ(out.proxy_W, below);
      EXPECT_TRUE(out.force_N.isZero(0));
      EXPECT_TRUE(out.converged);
      hold(renderer, Vec3(0, 0.02, 0), 10, 0.033 * index + 0.02);
      renderer.on_frame(scenes::frame(scenes::flat_grid(40), index + 1));
      EXPECT_GT(hold(renderer, below, 20, 0.033 * index + 0.043).force_N.y(), 1);
    }
  }
}

// A square grid holds a ball as long as half the diagonal of a cell is shorter than the ball's radius. The
// largest spacing is therefore sqrt(2) r_c.
TEST(EdgeCase, SparseGridHoldsUpToItsGeometricLimit) {
  for (const bool holds : {true, false}) {
    const double spacing = (holds ? 1.41 : 1.415) * kContactRadius;
    ProxyRenderer renderer = scenes::renderer();
    renderer.on_frame(
        scenes::frame(scenes::flat_grid(20, spacing)));  // even: the origin is the middle of a cell
    hold(renderer, Vec3(0, 0.02, 0), 1);
    const RenderOutput out = hold(renderer, Vec3(0, -0.02, 0), 200, 0.001);
    EXPECT_EQ(out.proxy_W.y() > 0, holds) << out.proxy_W.transpose();
  }
}

// A proxy is pressed into a crease of two walls with each of the three values of contact_motion. The plane
// of the mean normal lets (4.6) move it into the walls and (4.10) move it out again, so it wanders. The other
// values find the nearest position.

constexpr double kOpenings_deg[] = {40, 50, 60, 70, 80, 90, 100, 120, 140, 160};
constexpr double kXi[] = {0.1, 1.0 / 3};

// Two walls along z that meet at the origin, points 1.5 mm apart.
PointCloud crease(double opening_deg) {
  const double half = 0.5 * opening_deg * 3.14159265358979323846 / 180;
  PointCloud cloud;
  for (int j = -20; j <= 20; ++j)
    for (int i = -20; i <= 20; ++i) {
      const double along = 0.0015 * i;
      cloud.append({along * std::sin(half), std::abs(along) * std::cos(half), 0.0015 * j});
    }
  return cloud;
}

struct Rest {
  double wander_m = 0;  // diagonal of the box of all positions in the last 200 ticks
  Vec3 proxy_W = Vec3::Zero();
};

// The hand comes from above and rests below the crease for 300 ticks.
Rest rest(const ProxyParameters& p, const PointCloud& cloud, const Vec3& hip_W) {
  const Vec3 start_W(0, 0.03, 0);
  ProxyRenderer renderer = scenes::renderer(p);
  renderer.on_frame(scenes::frame(cloud));
  Vec3 low = Vec3::Constant(1), high = -low;
  Rest found;
  for (int tick = 0; tick <= 600; ++tick) {
    const RenderOutput out =
        renderer.step({start_W + std::min(1.0, tick / 300.0) * (hip_W - start_W)}, 0.001 * tick);
    found.proxy_W = out.proxy_W;
    if (tick > 400) low = low.cwiseMin(out.proxy_W), high = high.cwiseMax(out.proxy_W);
  }
  found.wander_m = (high - low).norm();
  return found;
}

template <class Visit>  // visit(opening_deg, xi, cloud, hip_W)
void at_every_crease(const Visit& visit) {
  for (const double opening_deg : kOpenings_deg) {
    const PointCloud cloud = crease(opening_deg);
    for (const double xi : kXi)
      for (const double x : {0.0, 0.002, 0.005, 0.01})
        for (const double z : {0.0, 0.0031}) visit(opening_deg, xi, cloud, Vec3(x, -0.008, z));
  }
}

ProxyParameters parameters(ContactMotion motion, double xi) {
  ProxyParameters p;
  p.contact_motion = motion, p.xi = xi, p.velocity_estimate = false;
  return p;
}

// These limits are stated on the page of experiments.
TEST(Crease, ProxyOnTheMeanPlaneWandersByUpTo3mmBelow100Degrees) {
  double sharp_m = 0, wide_m = 0;
  at_every_crease([&](double opening_deg, double xi, const PointCloud& cloud, const Vec3& hip_W) {
    const double wander_m = rest(parameters(ContactMotion::tangent_plane, xi), cloud, hip_W).wander_m;
    double& max_m = opening_deg < 100 ? sharp_m : wide_m;
    max_m = std::max(max_m, wander_m);
  });
  RecordProperty("max_wander_um", static_cast<int>(1e6 * sharp_m));
  EXPECT_GT(sharp_m, 1e-3) << "the method got better: state it where its limits are listed";
  EXPECT_LT(sharp_m, 3e-3);
  EXPECT_LT(wide_m, 1e-6);
}

// (4.8) accepts a contact as converged at an angle theta of 0.1 degrees: 35 um for a spring of 20 mm.
TEST(Crease, TheRuleForCreasesSettlesNearestToTheHip) {
  at_every_crease([&](double opening_deg, double xi, const PointCloud& cloud, const Vec3& hip_W) {
    const Rest creases = rest(parameters(ContactMotion::creases, xi), cloud, hip_W),
               regions = rest(parameters(ContactMotion::regions, xi), cloud, hip_W);
    EXPECT_LT(creases.wander_m, 1e-6) << opening_deg << " degrees";
    if (opening_deg <= 90) {
      EXPECT_LT((creases.proxy_W - regions.proxy_W).norm(), 1e-4) << opening_deg << " degrees";
    }
  });
}

// A flat grid as dense as in chapter 4 has no crease, so both rules give equal bits.
TEST(Crease, ThereIsNoneOnAFlatGrid) {
  ProxyRenderer plain = scenes::renderer(parameters(ContactMotion::tangent_plane, 0.1)),
                creases = scenes::renderer(parameters(ContactMotion::creases, 0.1));
  for (ProxyRenderer* each : {&plain, &creases}) each->on_frame(scenes::frame(scenes::flat_grid(60)));
  int touching = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const DeviceState device{Vec3(1e-5 * tick - 0.01, 0.01 - 1e-5 * tick, 7e-6 * tick - 0.007)};
    const RenderOutput a = plain.step(device, 0.001 * tick), b = creases.step(device, 0.001 * tick);
    ASSERT_EQ(a.proxy_W, b.proxy_W) << tick;
    ASSERT_EQ(a.force_N, b.force_N) << tick;
    touching += a.state == ContactState::contact;
  }
  EXPECT_GT(touching, 1000);
}

}  // namespace
}  // namespace remote_touch::edge_case_test
