// The virtual coupling in closed form, the command to the slave robot, and settings with few steps.
#include "core/dissertation/proxy/proxy_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::proxy_renderer_test {
namespace {

constexpr double kRate = 1000, kStiffness = 600;

VirtualCoupling coupling(double damping = 0, DampingSign sign = DampingSign::plus,
                         VelocityForce velocity = VelocityForce::minus) {
  ProxyParameters p;
  p.damping_Ns_per_m = damping;
  p.damping_sign = sign;
  p.velocity_force = velocity;
  return VirtualCoupling(p, kRate);
}

const double kContactRadius = ProxyParameters{}.contact_radius_m();

Vec3 still(VirtualCoupling& c, const Vec3& u) {
  return c.force(u, 0, Vec3::Zero(), kStiffness);
}

TEST(VirtualCoupling, HasNoForceWithinTheContactRadius) {
  VirtualCoupling c = coupling();
  EXPECT_EQ(still(c, Vec3::Zero()), Vec3(0, 0, 0));
  EXPECT_EQ(still(c, {0, -0.9 * kContactRadius, 0}), Vec3(0, 0, 0));
  EXPECT_EQ(still(c, {kContactRadius, 0, 0}), Vec3(0, 0, 0));
  EXPECT_GT(still(c, {0, -1.001 * kContactRadius, 0}).norm(), 0);
}

TEST(VirtualCoupling, SpringPullsTheHandToTheProxy) {
  const PointCloud directions = scenes::random_cloud(50, 1, 1);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    VirtualCoupling c = coupling();
    const Vec3 to_hip = directions.point(i).normalized();
    for (const double length : {0.0051, 0.01, 0.035, 1.0})
      for (const double k : {100.0, 600.0, 5000.0}) {
        const Vec3 force = c.force(length * to_hip, 0, Vec3::Zero(), k);
        const Vec3 want = -k * (length - kContactRadius) * to_hip;
        EXPECT_LT((force - want).norm(), 1e-15 * k) << length;  // a few roundings of lengths up to 1 m
      }
  }
}

TEST(VirtualCoupling, VelocityTermMovesTheProxyOnBetweenFrames) {
  const Vec3 u(0.001, -0.02, 0.003), v(0, 0.1, 0);
  const double since = 0.02;  // the surface has moved on by 2 mm
  const auto force = [&](VelocityForce sign) {
    VirtualCoupling c = coupling(0, DampingSign::plus, sign);
    return c.force(u, since, v, kStiffness);
  };
  const auto spring = [&](const Vec3& u_hat) {
    return Vec3(-kStiffness * (u_hat.norm() - kContactRadius) * u_hat.normalized());
  };
  EXPECT_LT((force(VelocityForce::minus) - spring({0.001, -0.022, 0.003})).norm(), 1e-13);
  EXPECT_LT((force(VelocityForce::plus) - spring({0.001, -0.018, 0.003})).norm(), 1e-13);
  EXPECT_LT((force(VelocityForce::none) - spring(u)).norm(), 1e-13);
}

// (4.16) uses the difference from the previous tick, even if that tick had no force. The damper therefore
// acts from the first tick of a contact.
TEST(VirtualCoupling, TheDamperKnowsTheDistanceOfATickWithoutForce) {
  const double damping = 5;
  VirtualCoupling c = coupling(damping);
  const auto pull_N = [&](double length_m) { return -still(c, {0, length_m, 0}).y(); };
  const auto expected_N = [&](double length_m, double before_m) {
    return kStiffness * (length_m - kContactRadius) + damping * kRate * (length_m - before_m);
  };
  EXPECT_EQ(pull_N(0.004), 0);
  EXPECT_NEAR(pull_N(0.006), expected_N(0.006, 0.004), 1e-12);
  EXPECT_EQ(pull_N(0.003), 0);
  EXPECT_EQ(pull_N(0.004), 0) << "and adds nothing within the contact radius";
  EXPECT_NEAR(pull_N(0.007), expected_N(0.007, 0.004), 1e-12);
}

// HIP distance 2 cm + 5 mm sin(2 pi t), sampled at the haptic rate.
double distance(double time) {
  return 0.02 + 0.005 * std::sin(6.283185307179586 * time);
}

// A renderer that is asked in every fourth tick only feels the same even press. The damper adds 5 Ns/m times
// 0.01 m/s.
TEST(VirtualCoupling, TheRendererCountsTheTicksThatItMissed) {
  ProxyParameters p;
  ProxyRenderer spring = scenes::renderer(p);
  p.damping_Ns_per_m = 5;
  ProxyRenderer every = scenes::renderer(p), fourth = scenes::renderer(p);
  for (ProxyRenderer* each : {&spring, &every, &fourth}) each->on_frame(scenes::frame(scenes::flat_grid(30)));
  for (int tick = 0; tick <= 2000; ++tick) {
    const DeviceState hand{{0, 0.01 - 1e-5 * tick, 0}};
    const auto force_N = [&](ProxyRenderer& r) { return r.step(hand, 0.001 * tick).force_N.norm(); };
    const double without_N = force_N(spring), with_N = force_N(every);
    if (tick % 4 != 0) continue;
    const double seldom_N = force_N(fourth);
    if (tick < 1500) continue;
    ASSERT_NEAR(with_N - without_N, 0.05, 1e-6) << tick;
    ASSERT_NEAR(seldom_N, with_N, p.stiffness_N_per_m * (p.r2_m - p.r1_m)) << tick;  // the shell
  }
}

// Work on the hand over whole cycles: a damper removes energy, and the printed sign adds energy.
TEST(VirtualCoupling, PlusDampsAndMinusAddsEnergy) {
  const auto work = [](DampingSign sign) {
    VirtualCoupling c = coupling(3, sign);
    double sum = 0, force = still(c, {0, distance(0), 0}).y();
    for (int tick = 1; tick <= 3000; ++tick) {
      const double next = still(c, {0, distance(tick / kRate), 0}).y();
      sum += 0.5 * (force + next) * (distance(tick / kRate) - distance((tick - 1) / kRate));
      force = next;
    }
    return sum;
  };
  // Closed form: -k_d times the integral of the squared rate over three cycles.
  const double closed = 3 * 3 * 0.5 * std::pow(0.005 * 6.283185307179586, 2);
  EXPECT_NEAR(work(DampingSign::plus), -closed, 0.01 * closed);
  EXPECT_NEAR(work(DampingSign::minus), closed, 0.01 * closed);
}

TEST(VirtualCoupling, DamperUsesTheDistanceThatGivesTheForce) {
  // The HIP keeps up with the surface: u_hat stays, so there is nothing to damp.
  VirtualCoupling c = coupling(10);
  for (int tick = 0; tick < 5; ++tick) {
    const double since = tick / kRate;
    const Vec3 force = c.force({0, -0.02 + 0.1 * since, 0}, since, {0, 0.1, 0}, kStiffness);
    EXPECT_NEAR(force.y(), kStiffness * (0.02 - kContactRadius), 1e-12) << tick;
  }
}

TEST(VirtualCoupling, FirstForceAndTheFirstAfterReleaseHaveNoDifference) {
  VirtualCoupling damped = coupling(10), spring = coupling(0);
  EXPECT_EQ(still(damped, {0.01, 0, 0}), still(spring, {0.01, 0, 0}));
  EXPECT_NE(still(damped, {0.02, 0, 0}), still(spring, {0.02, 0, 0}));
  damped.release();
  EXPECT_EQ(still(damped, {0.03, 0, 0}), still(spring, {0.03, 0, 0}));
  EXPECT_NE(still(damped, {0.02, 0, 0}), still(spring, {0.02, 0, 0}));
}

// --- the command to the slave robot, 5.2: it follows the proxy, but never into a region ---

PointCloud region(const Vec3& centre, double radius) {
  PointCloud cloud = scenes::cloud_of({centre});
  cloud.fixture_radius_m = {radius};
  return cloud;
}

// Two regions on a line with the proxy, which overlap once they are enlarged by the contact radius. The exit
// from either along this line ends inside the other, so a proxy between them moves to and fro for ever.
PointCloud trap() {
  PointCloud cloud = scenes::cloud_of({{-0.01, 0, 0}, {0.04, 0, 0}});
  cloud.fixture_radius_m = {0.02, 0.022};
  return cloud;
}

// The proxy stays inside under the printed rule.
TEST(SlaveCommand, IsHeldWhileTheProxyIsInsideARegion) {
  ProxyParameters p;
  p.max_exit_steps = 0;
  ProxyRenderer renderer = scenes::renderer(p);
  renderer.on_frame(scenes::frame(PointCloud{}));
  const Vec3 before(0, 0, 0), later(0.001, 0.1, 0);
  EXPECT_EQ(renderer.step({before}, 0).slave_W, before);
  renderer.on_frame(scenes::frame(trap(), 1));
  for (int tick = 1; tick < 50; ++tick) {
    const RenderOutput out = renderer.step({Vec3(0, 0.001 * tick, 0)}, 0.001 * tick);
    ASSERT_EQ(out.state, ContactState::entrenched) << tick;
    ASSERT_NE(out.proxy_W, before);
    ASSERT_EQ(out.slave_W, before) << tick;
  }
  renderer.on_frame(scenes::frame(PointCloud{}, 2));
  const RenderOutput out = renderer.step({later}, 0.051);
  EXPECT_EQ(out.proxy_W, later);
  EXPECT_EQ(out.slave_W, later);
}

// A proxy that ends a tick inside a region may have been outside during the tick. The command is its latest
// position outside. A second renderer with one step a tick computes the positions within a tick of many
// steps.
// A plane that rises evenly, seen 20 ms late. The surface has moved on since it was captured.
TEST(SlaveCommand, MovesOnWithTheSurfaceIfItIsPredicted) {
  ProxyParameters predicted;
  predicted.slave_prediction = true;
  ProxyRenderer renderer = scenes::renderer(predicted), held = scenes::renderer();
  const double speed = 0.06;
  for (int tick = 0; tick < 500; ++tick) {
    const double time_s = 0.001 * tick, captured_s = time_s - 0.02;
    if (tick % 25 == 0) {
      PointCloud cloud = scenes::flat_grid(30);
      for (double& y : cloud.y) y = speed * captured_s;
      for (ProxyRenderer* each : {&renderer, &held})
        each->on_frame({tick / 25, captured_s, time_s, make_search(cloud)});
    }
    const DeviceState hand{{0, std::max(0.02 - 0.0002 * tick, -0.003) + speed * time_s, 0}};
    const RenderOutput ahead = renderer.step(hand, time_s), out = held.step(hand, time_s);
    if (tick < 200) continue;
    ASSERT_EQ(out.state, ContactState::contact) << tick;
    const double age_s = 0.02 + 0.001 * (tick % 25);
    ASSERT_LT((ahead.slave_W - out.slave_W - Vec3(0, age_s * speed, 0)).norm(), 1e-5) << tick;
  }
}

TEST(SlaveCommand, IsTheLatestPositionOutsideWithinATick) {
  ProxyParameters many, one;
  many.velocity_estimate = one.velocity_estimate = false;
  many.steps_per_tick = 7, one.steps_per_tick = 1;
  ProxyRenderer renderer = scenes::renderer(many), single = scenes::renderer(one);
  for (ProxyRenderer* each : {&renderer, &single}) each->on_frame(scenes::frame(scenes::flat_grid(2, 0.002)));
  Vec3 outside = Vec3::Constant(std::nan(""));
  int held = 0, within = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const Vec3 hip(0.004 * std::sin(0.01 * tick), 0.01 - 0.00001 * tick, 0);
    const RenderOutput out = renderer.step({hip}, 0.001 * tick);
    bool passed = false;
    for (int step = 0; step < many.steps_per_tick; ++step) {
      const RenderOutput at = single.step({hip}, 0.001 * tick);
      if (at.state != ContactState::entrenched) outside = at.proxy_W, passed = true;
    }
    ASSERT_EQ(out.slave_W, outside) << tick;
    if (out.state == ContactState::entrenched) ++held, within += passed;
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(within, 10);
}

TEST(SlaveCommand, IsTheHipWhereTheConstraintIsSoft) {
  ProxyParameters soft;
  soft.slave_command = SlaveCommand::hip;
  ProxyRenderer renderer = scenes::renderer(soft), hard = scenes::renderer();
  for (ProxyRenderer* each : {&renderer, &hard}) each->on_frame(scenes::frame(region(Vec3::Zero(), 0.05)));
  for (int tick = 0; tick < 200; ++tick) {
    const Vec3 hip(0.001, 0.1 - 0.0005 * tick, 0);
    const RenderOutput out = renderer.step({hip}, 0.001 * tick), other = hard.step({hip}, 0.001 * tick);
    ASSERT_EQ(out.slave_W, hip) << tick;
    ASSERT_EQ(out.proxy_W, other.proxy_W) << "the hand feels the same";
    ASSERT_EQ(out.force_N, other.force_N);
  }
  renderer.on_frame(scenes::frame(trap(), 1));
  EXPECT_EQ(renderer.step({Vec3::Zero()}, 0.2).slave_W, Vec3(0, 0, 0)) << "inside or not";
}

TEST(SlaveCommand, IsHeldWhileTheDeviceIsLostOrBeyondAllReason) {
  for (const SlaveCommand command : {SlaveCommand::rendered, SlaveCommand::hip}) {
    ProxyParameters p;
    p.slave_command = command;
    ProxyRenderer renderer = scenes::renderer(p);
    const Vec3 lost(std::nan(""), 0, 0), last(0, 0.07, 0);
    EXPECT_TRUE(renderer.step({lost}, 0).slave_W.array().isNaN().all()) << "no command before the first step";
    EXPECT_EQ(renderer.step({last}, 0.001).slave_W, last) << "without a frame nothing is in the way";
    renderer.on_frame(scenes::frame(region(Vec3::Zero(), 0.05)));
    for (const Vec3& bad : {lost, Vec3(1e7, 0, -1e7), Vec3(1e155, 0, 0), Vec3(1e300, 0, -1e300)}) {
      const RenderOutput out = renderer.step({bad}, 0.002);
      EXPECT_EQ(out.status, RenderStatus::device_not_finite);
      EXPECT_EQ(out.proxy_W, last);
      EXPECT_EQ(out.slave_W, last);
    }
    EXPECT_EQ(renderer.step({Vec3(0, 0.08, 0)}, 0.004).slave_W, Vec3(0, 0.08, 0));
  }
}

// A hand that starts inside a region has no position to command until the proxy is outside. The proxy stays
// inside under the printed rule.
TEST(SlaveCommand, IsNoneUntilTheProxyWasOutside) {
  ProxyParameters p;
  p.max_exit_steps = 0;
  ProxyRenderer renderer = scenes::renderer(p);
  renderer.on_frame(scenes::frame(trap()));
  for (int tick = 0; tick < 5; ++tick)
    EXPECT_TRUE(renderer.step({Vec3(0.013, 0, 0)}, 0.001 * tick).slave_W.array().isNaN().all());
}

// --- few steps, as the description of steps_per_tick recommends ---

ProxyParameters stepping(double gamma, int steps_per_tick) {
  ProxyParameters p;
  p.gamma = gamma, p.steps_per_tick = steps_per_tick;
  return p;
}

// Points 2 mm apart, with normally distributed heights.
PointCloud noisy_plane(double sigma_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> height(0, 1);
  PointCloud cloud;
  for (int i = -50; i <= 50; ++i)
    for (int k = -20; k <= 20; ++k) cloud.append({0.002 * i, sigma_m * height(random), 0.002 * k});
  return cloud;
}

// Returns where the proxy rests after the HIP has come down and slid 5 mm below the plane to x.
Vec3 rest_of(const PointCloud& cloud, const ProxyParameters& parameters, double x) {
  constexpr int kTicks = 100;
  ProxyRenderer renderer = scenes::renderer(parameters);
  renderer.on_frame(scenes::frame(cloud));
  renderer.step({Vec3(x - 0.01, 0.02, 0.0003)}, 0);
  RenderOutput out;
  for (int tick = 0; tick < kTicks + 40; ++tick)
    out = renderer.step({Vec3(x - 0.01 * std::max(0, kTicks - tick) / kTicks, -0.005, 0.0003)}, 0);
  return out.proxy_W;
}

// The rest depends on the way to it by as much as the contact region is thick, 20 um.
TEST(FewSteps, EndWhereAThousandStepsEnd) {
  for (const double sigma_m : {0.0, 0.001}) {
    const PointCloud cloud = noisy_plane(sigma_m);
    for (int i = 0; i < 25; ++i) {
      const double x = -0.05 + 0.0041 * i;
      const Vec3 limit_W = rest_of(cloud, stepping(0.3, 1000), x);
      EXPECT_LT((rest_of(cloud, stepping(0.5, 8), x) - limit_W).norm(), 20e-6) << sigma_m << " m, x = " << x;
      EXPECT_LT((rest_of(cloud, stepping(0.3, 10), x) - limit_W).norm(), 20e-6) << sigma_m << " m, x = " << x;
    }
  }
}

TEST(FewSteps, AreTooFewWhereTheyDoNotArrive) {
  const PointCloud cloud = noisy_plane(0);
  EXPECT_GT((rest_of(cloud, stepping(0.01, 8), 0) - rest_of(cloud, stepping(0.3, 1000), 0)).norm(), 20e-6);
}

}  // namespace
}  // namespace remote_touch::proxy_renderer_test
