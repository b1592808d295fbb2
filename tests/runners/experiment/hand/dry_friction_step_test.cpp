// A mass with dry friction: closed forms, an oracle that scans the motion in small steps, and the balance of
// energy.
#include "runners/experiment/hand/dry_friction_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/runners/experiment/hand/held_motion_oracle.h"

namespace remote_touch::dry_friction_step_test {
namespace {

using oracle::Real;

HeldForceStep::Start along_x(double apart, double velocity, double path_velocity, double force) {
  return {Vec3(apart, 0, 0), Vec3(velocity, 0, 0), Vec3(path_velocity, 0, 0), Vec3(force, 0, 0)};
}

TEST(DryFriction, OfZeroIsTheStepWithoutFriction) {
  const MassOnSpring system{0.5, 300, 10, 2};
  const auto start = along_x(0.01, -0.2, 0.1, 3);
  const auto with = DryFrictionStep(system, 0, 0.001).motion(start);
  const auto without = HeldForceStep(system, 0.001).motion(start);
  EXPECT_NEAR(with.displacement.x(), without.displacement.x(), 1e-16);
  EXPECT_NEAR(with.velocity.x(), without.velocity.x(), 1e-14);
}

// A mass that only friction stops slides v^2 m / (2 F_c), and then it stays.
TEST(DryFriction, StopsASlidingMass) {
  const MassOnSpring system{0.5, 0, 0, 0};
  const double v = 0.004, friction = 4;  // it stops after m v / F_c = 0.5 ms
  for (const double side : {1.0, -1.0}) {
    const auto motion = DryFrictionStep(system, friction, 0.001).motion(along_x(0, side * v, 0, 0));
    EXPECT_EQ(motion.velocity.x(), 0);
    EXPECT_NEAR(motion.displacement.x(), side * v * v * 0.5 / (2 * friction), 1e-18);
  }
}

TEST(DryFriction, HoldsAMassAgainstAnyForceUpToIts) {
  const DryFrictionStep step({0.5, 1000, 0, 1}, 2, 0.001);
  EXPECT_EQ(step.motion(along_x(0, 0, 0, 2)).displacement.x(), 0);
  EXPECT_EQ(step.motion(along_x(-0.002, 0, 0, 0)).displacement.x(), 0);
  EXPECT_EQ(step.motion(along_x(0.001, 0, 0, 1)).displacement.x(), 0);
  EXPECT_GT(step.motion(along_x(0.001, 0, 0, 1.001)).displacement.x(), 0);
  EXPECT_LT(step.motion(along_x(0, 0, 0, -2.001)).displacement.x(), 0);
}

// A spring that the path stretches at constant speed breaks a mass loose when its force has reached F_c.
TEST(DryFriction, EndsWhenTheSpringPullsHarder) {
  const double k = 1000, speed = 0.1, friction = 2.05;  // F_c / (k p') = 20.5 ms
  const DryFrictionStep step({0.5, k, 0, 0}, friction, 0.001);
  double apart = 0, velocity = 0;
  int ticks = 0;
  for (; velocity == 0 && ticks < 100; ++ticks) {
    const auto motion = step.motion(along_x(apart, velocity, speed, 0));
    apart += speed * 0.001 - motion.displacement.x(), velocity = motion.velocity.x();
  }
  EXPECT_EQ(ticks, 21);
}

// The swings, without damping, of a mass on a spring shrink by 2 F_c / k from side to side, and the mass
// stops where the spring is weaker than friction. Ten swings in one tick.
TEST(DryFriction, ShrinksTheSwingsByTwiceItsWidth) {
  const double mass = 0.02, k = 2000, friction = 0.5;
  const double half_s = std::acos(-1.0) * std::sqrt(mass / k);
  const double first = 0.01;  // -> -0.0095, 0.009, ... : each half swing is 0.0005 shorter
  for (int halves = 1; halves <= 10; ++halves) {
    const auto motion =
        DryFrictionStep({mass, k, 0, 0}, friction, halves * half_s).motion(along_x(-first, 0, 0, 0));
    const double at = (halves % 2 == 0 ? 1 : -1) * (first - halves * 2 * friction / k);
    EXPECT_NEAR(first + motion.displacement.x(), at, 1e-13) << halves;
    EXPECT_NEAR(motion.velocity.x(), 0, 1e-10) << halves;
  }
  // 0.01 - 20 * 0.0005 = 0 is inside the zone of +- 0.00025 in which it rests.
  const auto end = DryFrictionStep({mass, k, 0, 0}, friction, 25 * half_s).motion(along_x(-first, 0, 0, 0));
  EXPECT_EQ(end.velocity.x(), 0);
  EXPECT_LE(std::abs(first + end.displacement.x()), friction / k);
}

struct Case {
  MassOnSpring system;
  double friction, tick_s;
  HeldForceStep::Start start;
};

Case random_case(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  Case c;
  c.system = {std::exp(between(-4, 1)), std::exp(between(0, 9)), between(0, 5), between(0, 5)};
  if (seed % 4 == 0) c.system.stiffness = 0;
  c.friction = std::exp(between(-4, 2)), c.tick_s = seed % 3 == 0 ? 0.01 : 0.001;
  // Speeds that friction stops within a few ticks, so that most ticks have a stop.
  const double v = seed % 5 == 0 ? 0 : between(-2, 2) * c.friction * c.tick_s / c.system.mass;
  c.start = along_x(between(-2, 2) * c.friction / (c.system.stiffness + 1), v, between(-0.3, 0.3),
                    between(-2, 2) * c.friction);
  return c;
}

// The oracle: steps of a 2000th of a tick by matrix exponentials, with the direction of friction chosen at
// each. Its errors are those of a stop inside a step.
oracle::State scanned(const Case& c) {
  const oracle::System system{c.system.mass, c.system.stiffness, c.system.path_damping,
                              c.system.ground_damping};
  const int steps = 2000;
  const Real dt = static_cast<Real>(c.tick_s) / steps, m = c.system.mass, f = c.friction;
  const auto generator = oracle::generator(system);
  const oracle::Matrix step = oracle::exponential_less_one(generator, dt);
  oracle::State state;
  state << -c.start.apart.x(), c.start.velocity.x(), 0, c.start.path_velocity.x(), 0;
  const Real force = c.start.force.x();
  for (int i = 0; i < steps; ++i) {
    state[4] = force / m;
    const Real pull = m * (generator.row(1) * state)(0);
    Real direction = state[1] > 0 ? 1 : state[1] < 0 ? -1 : pull > 0 ? 1 : -1;
    const bool sticks = state[1] == 0 && std::abs(pull) <= f;
    if (sticks) {
      state[2] += state[3] * dt;
      continue;
    }
    state[4] = (force - direction * f) / m;
    const oracle::State next = state + step * state;
    const bool stops = direction * next[1] < 0;
    state = next;
    if (stops) state[1] = 0;
  }
  return state;
}

TEST(DryFriction, AgreesWithAScanInSmallSteps) {
  int stopped = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Case c = random_case(seed);
    const auto motion = DryFrictionStep(c.system, c.friction, c.tick_s).motion(c.start);
    const oracle::State end = scanned(c);
    const double speed = std::abs(c.start.velocity.x()) + 4 * c.friction * c.tick_s / c.system.mass +
                         std::abs(c.start.path_velocity.x());
    const double way = static_cast<double>(end[0]) + c.start.apart.x();
    EXPECT_NEAR(motion.displacement.x(), way, 2e-3 * speed * c.tick_s) << seed;
    EXPECT_NEAR(motion.velocity.x(), static_cast<double>(end[1]), 5e-3 * speed) << seed;
    stopped += motion.velocity.x() == 0;
  }
  EXPECT_GT(stopped, 3);
}

TEST(DryFriction, KeepsTheBalanceOfEnergy) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    const Case c = random_case(seed);
    const DryFrictionStep step(c.system, c.friction, c.tick_s);
    const StepEnergy energy = step.energy(c.start);
    const double turnover =
        std::abs(energy.force_work_J) + std::abs(energy.path_work_J) + energy.dissipated_J();
    ASSERT_NEAR(energy.gained_J() + energy.dissipated_J(), energy.supplied_J(), 1e-9 * turnover + 1e-18)
        << seed;
    ASSERT_GE(energy.dry_friction_J, -1e-18) << seed;
    const double v = step.motion(c.start).velocity.x(), before = c.start.velocity.x();
    ASSERT_NEAR(energy.kinetic_J, c.system.mass / 2 * (v * v - before * before),
                1e-9 * c.system.mass / 2 * (v * v + before * before) + 1e-18)
        << seed;
  }
}

TEST(DryFriction, ActsAlongEachAxisByItself) {
  const DryFrictionStep step({0.5, 200, 1, 1}, 1, 0.001);
  HeldForceStep::Start start{Vec3(0.01, -0.02, 0.001), Vec3(0.1, 0, -0.001), Vec3(0, 0.1, 0.2),
                             Vec3(3, 0, -1)};
  const auto all = step.motion(start);
  for (int i = 0; i < 3; ++i) {
    const auto one =
        step.motion(along_x(start.apart[i], start.velocity[i], start.path_velocity[i], start.force[i]));
    EXPECT_EQ(all.displacement[i], one.displacement.x()) << i;
    EXPECT_EQ(all.velocity[i], one.velocity.x()) << i;
  }
}

}  // namespace
}  // namespace remote_touch::dry_friction_step_test
