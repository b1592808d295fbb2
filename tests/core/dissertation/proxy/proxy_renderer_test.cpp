#include "core/dissertation/proxy/proxy_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
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

TEST(VirtualCoupling, DamperAddsNothingWithinTheContactRadius) {
  VirtualCoupling c = coupling(5);
  still(c, {0, 0, 0});
  EXPECT_EQ(still(c, {0, -0.004, 0}), Vec3(0, 0, 0));
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

// The purpose of (4.15): the force immediately before a frame equals the force immediately after it, when the
// proxy has been moved along with the surface.
TEST(VirtualCoupling, MinusMakesTheForceContinuousAtAFrame) {
  const double speed = 0.1, interval = 1.0 / 30;
  const Vec3 before(0, -0.03, 0), v(0, speed, 0), after = before - speed * interval * Vec3::UnitY();
  const auto jump = [&](VelocityForce sign) {
    VirtualCoupling c = coupling(0, DampingSign::plus, sign);
    const double old_force = c.force(before, interval, v, kStiffness).y();
    return c.force(after, 0, v, kStiffness).y() - old_force;
  };
  EXPECT_NEAR(jump(VelocityForce::minus), 0, 1e-13);
  EXPECT_NEAR(jump(VelocityForce::none), kStiffness * speed * interval, 1e-12);
  EXPECT_NEAR(jump(VelocityForce::plus), 2 * kStiffness * speed * interval, 1e-12);
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
  EXPECT_NEAR(pull_N(0.007), expected_N(0.007, 0.003), 1e-12);
}

// The rate after n missed ticks is the difference divided by all of them. Otherwise it would be n times too
// large.
TEST(VirtualCoupling, TheDamperSpreadsADifferenceOverMissedTicks) {
  const double damping = 5;
  for (const double ticks : {1.0, 2.0, 40.0}) {
    VirtualCoupling c = coupling(damping);
    still(c, {0, -0.010, 0});
    const Vec3 force = c.force({0, -0.011, 0}, 0, Vec3::Zero(), kStiffness, ticks);
    EXPECT_NEAR(force.y(), kStiffness * (0.011 - kContactRadius) + damping * 0.001 * kRate / ticks, 1e-11);
  }
}

// HIP distance 2 cm + 5 mm sin(2 pi t), sampled at the haptic rate.
double distance(double time) {
  return 0.02 + 0.005 * std::sin(6.283185307179586 * time);
}

TEST(VirtualCoupling, DamperFollowsTheRateOfTheDistance) {
  const double damping = 3;
  for (const DampingSign sign : {DampingSign::plus, DampingSign::minus}) {
    VirtualCoupling c = coupling(damping, sign);
    const double s = sign == DampingSign::plus ? 1 : -1;
    for (int tick = 0; tick < 1000; ++tick) {
      const double length = distance(tick / kRate);
      const double difference = tick == 0 ? 0 : (length - distance((tick - 1) / kRate)) * kRate;
      const Vec3 got = still(c, {0, 0, length});
      const double spring = kStiffness * (length - kContactRadius);
      // The difference carries 1e-17 / 1 ms of rounding, times the damping.
      ASSERT_NEAR(got.z(), -(spring + s * damping * difference), 1e-12) << tick;
      // The one-sided difference lags half a tick: off by at most |distance''| / 2 / rate.
      const double rate = 0.005 * 6.283185307179586 * std::cos(6.283185307179586 * tick / kRate);
      if (tick > 0) {
        ASSERT_NEAR(got.z(), -(spring + s * damping * rate), damping * 0.2 / 2 / kRate + 1e-12);
      }
    }
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

}  // namespace
}  // namespace remote_touch::proxy_renderer_test
