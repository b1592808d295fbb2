#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

// Cases in which proxy renderers are known to fail. Each test runs the whole renderer.
namespace remote_touch::edge_case_test {
namespace {

constexpr double kContactRadius = 0.005, kShell = 1.0001e-5;

// Renders the same HIP for some ticks and returns the last output.
RenderOutput hold(Renderer& renderer, const Vec3& hip, int ticks = 20, double start_s = 0) {
  RenderOutput out;
  for (int tick = 0; tick < ticks; ++tick) out = renderer.step({hip}, start_s + 0.001 * tick);
  return out;
}

TEST(EdgeCase, Float32PointsOneMetreAwayAreTouched) {
  PointCloud cloud = scenes::flat_grid(60, 0.0015, 1.0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.x[i] = static_cast<float>(cloud.x[i] + 1), cloud.y[i] = static_cast<float>(cloud.y[i]);
    cloud.z[i] = static_cast<float>(cloud.z[i] + 1);
  }
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(cloud));
  hold(renderer, Vec3(1, 1.02, 1), 1);
  for (int tick = 1; tick < 300; ++tick) {
    const RenderOutput out = renderer.step({Vec3(1 + 1e-4 * tick / 3, 0.99, 1)}, 0.001 * tick);
    ASSERT_NEAR(out.nearest_distance_m, kContactRadius, kShell) << tick;
    ASSERT_GT(out.force_N.y(), 5) << tick;
  }
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

TEST(EdgeCase, SymmetricPointsHaveNoNormal) {
  PointCloud cloud;  // the sum of directions vanishes midway between two points
  cloud.append({0.004, 0, 0}), cloud.append({-0.004, 0, 0});
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(cloud));
  for (int tick = 0; tick < 50; ++tick) {
    const RenderOutput out = renderer.step({Vec3(0, 0.02 - 0.001 * tick, 0)}, 0.001 * tick);
    ASSERT_TRUE(out.proxy_W.allFinite() && out.normal_W.allFinite());
  }
}

TEST(EdgeCase, AHipAtTheProxyGivesNoForce) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(40)));
  const Vec3 touching(0, kContactRadius, 0);
  const RenderOutput out = hold(renderer, touching);
  EXPECT_TRUE(out.proxy_W.allFinite());
  EXPECT_TRUE(out.force_N.isZero(0));
  EXPECT_NEAR((out.proxy_W - touching).norm(), 0, 2e-4);
}

TEST(EdgeCase, AnEmptyCloudGivesNoForce) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(PointCloud{}));
  const RenderOutput out = hold(renderer, Vec3(0.1, -0.2, 0.3));
  EXPECT_EQ(out.proxy_W, Vec3(0.1, -0.2, 0.3));
  EXPECT_TRUE(out.force_N.isZero(0));
  EXPECT_TRUE(out.converged);
}

TEST(EdgeCase, ACloudOfMissingPointsGivesNoForce) {
  PointCloud cloud = scenes::flat_grid(30);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.x[i] = cloud.y[i] = cloud.z[i] = std::nan("");
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(cloud));
  EXPECT_EQ(hold(renderer, Vec3(0, -0.01, 0)).proxy_W, Vec3(0, -0.01, 0));
}

TEST(EdgeCase, TheCloudVanishesUnderTheProxy) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(40)));
  hold(renderer, Vec3(0, 0.02, 0), 1);
  EXPECT_GT(hold(renderer, Vec3(0, -0.01, 0)).force_N.y(), 1);
  renderer.on_frame(scenes::frame(PointCloud{}, 1));
  const RenderOutput out = hold(renderer, Vec3(0, -0.01, 0), 1, 0.034);
  EXPECT_EQ(out.proxy_W, Vec3(0, -0.01, 0));
  EXPECT_TRUE(out.force_N.isZero(0));
}

TEST(EdgeCase, ACloudOfOnePointIsTouched) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::cloud_of({{0, 0, 0}})));
  hold(renderer, Vec3(0.001, 0.02, 0), 1);
  const RenderOutput out = hold(renderer, Vec3(0, -0.01, 0), 100);
  // The proxy stays above the point, in line with the HIP, or slips round the point. It is never nearer than
  // the contact radius.
  EXPECT_GE(out.nearest_distance_m, kContactRadius - kShell);
}

TEST(EdgeCase, AHipThatJumpsAcrossTheCloudIsHeld) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(100)));
  hold(renderer, Vec3(0, 3, 0.0002), 1);
  const RenderOutput below = hold(renderer, Vec3(0, -3, 0.0002), 50, 0.001);  // six metres in a tick
  EXPECT_NEAR(below.proxy_W.y(), kContactRadius, 2e-4);
  const RenderOutput back = hold(renderer, Vec3(0.01, 3, 0), 50, 0.051);
  EXPECT_EQ(back.proxy_W, Vec3(0.01, 3, 0));
}

TEST(EdgeCase, AHipBeyondAllReasonIsRefused) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(100)));
  hold(renderer, Vec3(0, 0.02, 0), 1);
  for (const double far : {1e7, 1e155, 1e300}) {
    const RenderOutput out = renderer.step({Vec3(far, 0, -far)}, 0.002);
    EXPECT_EQ(out.status, RenderStatus::device_not_finite);
    EXPECT_EQ(out.proxy_W, Vec3(0, 0.02, 0));
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

// The steps run in circles on a rough cloud. The step budget ends the tick, and the proxy does not drift
// away.
TEST(EdgeCase, LimitCyclesEndWithTheBudget) {
  PointCloud cloud = scenes::flat_grid(60);
  const PointCloud noise = scenes::random_cloud(static_cast<int>(cloud.size()), 0.008, 5);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] += noise.y[i];
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(cloud));
  hold(renderer, Vec3(0, 0.05, 0), 1);
  int unconverged = 0;
  for (int tick = 1; tick < 200; ++tick) {
    const RenderOutput out = renderer.step({Vec3(1e-4 * tick, -0.02, 0)}, 0.001 * tick);
    unconverged += out.converged ? 0 : 1;
    ASSERT_LE(out.steps, 30);
    ASSERT_GT(out.proxy_W.y(), -0.008) << tick;
    ASSERT_LT(out.proxy_W.norm(), 0.05) << tick;
  }
  EXPECT_GT(unconverged, 0);
}

TEST(EdgeCase, FramesOutOfOrderAreDropped) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(40, 0.0015, 0), 5));
  hold(renderer, Vec3(0, 0.03, 0), 1, 0.17);
  const RenderOutput before = hold(renderer, Vec3(0, -0.01, 0), 30, 0.171);
  renderer.on_frame(scenes::frame(scenes::flat_grid(40, 0.0015, 0.01), 4));  // arrives late
  renderer.on_frame(scenes::frame(scenes::flat_grid(40, 0.0015, 0.01), 5));  // arrives twice
  const RenderOutput out = renderer.step({Vec3(0, -0.01, 0)}, 0.201);
  EXPECT_EQ(out.status, RenderStatus::stale_frame_dropped);
  EXPECT_EQ(out.frame_index, 5);
  EXPECT_EQ(out.proxy_W, before.proxy_W);
  EXPECT_EQ(renderer.step({Vec3(0, -0.01, 0)}, 0.202).status, RenderStatus::ok);
}

// A sensor repeats a frame bit for bit, or drops it: the cloud seems to stop, and then to jump by two steps.
TEST(EdgeCase, RepeatedAndDroppedFramesKeepASteadyRise) {
  for (const bool dropped : {false, true}) {
    ProxyRenderer renderer = scenes::renderer();
    for (int tick = 0; tick < 600; ++tick) {
      const int frame = tick / 33;
      if (tick % 33 == 0 && !(dropped && frame == 10)) {
        const double height = 0.001 * (frame == 10 ? 9 : frame) - 0.004;
        renderer.on_frame(
            {frame, frame / 30.0, frame / 30.0, make_search(scenes::flat_grid(40, 0.0015, height))});
      }
      const double surface = 0.001 * frame - 0.004;
      const RenderOutput out = renderer.step({Vec3(0, tick < 200 ? 0.002 : surface - 0.01, 0)}, 0.001 * tick);
      ASSERT_GT(out.proxy_W.y(), surface - 0.002) << tick;
      if (tick > 560) {
        ASSERT_NEAR(out.surface_velocity_m_per_s, 0.03, 1e-3);
      }
    }
  }
}

TEST(EdgeCase, TheFrameRateChanges) {
  ProxyRenderer renderer = scenes::renderer();
  double captured = 0;
  for (int frame = 0; frame < 40; ++frame) {
    captured += frame < 20 ? 1.0 / 30 : 1.0 / 15;
    renderer.on_frame(
        {frame, captured, captured, make_search(scenes::flat_grid(40, 0.0015, 0.05 * captured - 0.02))});
    const double hip = 0.05 * captured - (frame < 12 ? 0 : 0.03);
    const RenderOutput out = hold(renderer, Vec3(0, hip, 0), 33, captured);
    if (frame > 14) {
      EXPECT_NEAR(out.surface_velocity_m_per_s, 0.05, 1e-3) << frame;
      EXPECT_GT(out.proxy_W.y(), 0.05 * captured - 0.02) << frame;
    }
  }
}

// A sheet one point thick can be touched from both sides; the proxy stays on the side it came from.
TEST(EdgeCase, AThinSheetHoldsFromBothSides) {
  for (const double side : {1.0, -1.0}) {
    ProxyRenderer renderer = scenes::renderer();
    renderer.on_frame(scenes::frame(scenes::flat_grid(60)));
    hold(renderer, Vec3(0, side * 0.02, 0), 1);
    for (int tick = 1; tick < 200; ++tick) {
      const RenderOutput out = renderer.step({Vec3(1e-4 * tick, -side * 0.02, 0)}, 0.001 * tick);
      ASSERT_NEAR(side * out.proxy_W.y(), kContactRadius, 2e-4) << tick;
      ASSERT_GT(side * out.force_N.y(), 5) << tick;
    }
  }
}

// Chapter 5 with the same proxy: the region around a single point of r_f = 0.1 m is never entered, Fig 5.5.
TEST(EdgeCase, AFixtureRadiusKeepsTheProxyOut) {
  PointCloud cloud = scenes::cloud_of({{0, 0, 0}});
  cloud.fixture_radius_m = {0.1};
  cloud.stiffness_N_per_m = {250};
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(cloud));
  hold(renderer, Vec3(0.01, 0.2, 0), 1);
  double nearest = 1, strongest = 0;
  for (int tick = 1; tick < 1000; ++tick) {
    const double angle = 0.002 * tick;
    const RenderOutput out =
        renderer.step({Vec3(0.08 * std::sin(angle), 0.08 * std::cos(angle), 0)}, 0.001 * tick);
    nearest = std::min(nearest, out.proxy_W.norm());
    if (out.force_N.norm() > 0)
      strongest =
          out.force_N.norm() /
          ((Vec3(0.08 * std::sin(angle), 0.08 * std::cos(angle), 0) - out.proxy_W).norm() - kContactRadius);
  }
  EXPECT_NEAR(nearest, 0.105, 2e-5);
  EXPECT_NEAR(strongest, 250, 1);  // the point's own stiffness
}

}  // namespace
}  // namespace remote_touch::edge_case_test

// A proxy is pressed into a crease of two walls with each of the three values of contact_motion. The plane
// of the mean normal lets (4.6) move it into the walls and (4.10) move it out again, so it wanders. The other
// values find the nearest position.
namespace remote_touch::crease_test {
namespace {

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
}  // namespace remote_touch::crease_test
