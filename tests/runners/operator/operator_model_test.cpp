// The simulated hand against the closed forms of a mass, a spring and a damper.
#include "runners/operator/operator_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/geometry/rotation.h"

namespace remote_touch::operator_model_test {
namespace {

constexpr double kTick_s = 0.001;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

DeviceState at(const Vec3& p_W, const Vec3& turn = Vec3::Zero()) {
  return {p_W, rotation(turn)};
}

// Undamped frequency, decay and damped frequency of m x'' + c x' + k x = 0.
struct Oscillator {
  explicit Oscillator(double m, double c, double k)
      : decay(c / (2 * m)), omega(std::sqrt(k / m - decay * decay)) {}
  // x / (f / k) for a force f from 0 on.
  double after_a_force(double t) const {
    return 1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  }
  // x / y for an intended place that is y from 0 on, which the damper feels too.
  double after_a_jump(double t) const {
    return 1 - std::exp(-decay * t) * (std::cos(omega * t) - decay / omega * std::sin(omega * t));
  }
  double decay, omega;
};

// The largest distance from `expected` over half a second; drive(t) is the path and what the hand feels from
// t on.
template <class Drive, class Expected>
double max_error(const OperatorSettings& s, double tick_s, const Drive& drive, const Expected& expected) {
  OperatorModel hand(s, tick_s);
  hand.move(at({0, 0, 0}), 0, {});
  double error = 0;
  for (int i = 1; i * tick_s < 0.5; ++i) {
    const auto [path, device_wrench] = drive();
    const DeviceState d = hand.move(path, i * tick_s, device_wrench);
    const double angle = rotation_vector(d.orientation_W).x();
    error = std::max({error, std::abs(d.position_W.x() - expected(i * tick_s).first),
                      std::abs(angle - expected(i * tick_s).second)});
  }
  return error;
}

using Driven = std::pair<DeviceState, Wrench>;
using Pair = std::pair<double, double>;

// --- at rest ---

TEST(OperatorModel, AFreeHandOnARestingPathStaysWhereItIs) {
  std::mt19937 random(1);
  for (int run = 0; run < 50; ++run) {
    const DeviceState rest = at(10 * direction(random), 3 * direction(random));
    OperatorModel hand({}, kTick_s);
    for (int i = 0; i < 300; ++i) {
      const DeviceState d = hand.move(rest, i * kTick_s, {});
      ASSERT_EQ(d.position_W, rest.position_W) << i;
      ASSERT_EQ(d.orientation_W.coeffs(), rest.orientation_W.coeffs()) << i;
    }
  }
}

TEST(OperatorModel, AConstantWrenchHoldsItAside) {
  OperatorSettings s;
  OperatorModel hand(s, kTick_s);
  const Vec3 force_N(1.5, -0.5, 2), torque_Nm(0.1, 0.2, -0.3);
  DeviceState d;
  for (int i = 0; i < 5000; ++i) d = hand.move(at({1, 2, 3}), i * kTick_s, {force_N, torque_Nm});
  EXPECT_LT((d.position_W - Vec3(1, 2, 3) - force_N / 300).norm(), 1e-12);
  EXPECT_LT((rotation_vector(d.orientation_W) - torque_Nm / 1).norm(), 1e-12);
}

// The grip is a share of the springs.
TEST(OperatorModel, HalfAGripGivesWayTwiceAsFar) {
  OperatorSettings s;
  s.grip = {0, 0.5};
  OperatorModel hand(s, kTick_s);
  DeviceState d;
  for (int i = 0; i < 5000; ++i) d = hand.move(at({0, 0, 0}), i * kTick_s, {{1.5, 0, 0}, {0, 0, 0.1}});
  EXPECT_LT((d.position_W - Vec3(0.01, 0, 0)).norm(), 1e-12);
  EXPECT_LT((rotation_vector(d.orientation_W) - Vec3(0, 0, 0.2)).norm(), 1e-12);
}

// --- in motion ---

TEST(OperatorModel, AnswersAForceLikeAnOscillator) {
  OperatorSettings s;
  s.rotational_damping_Nms_per_rad = 0.02;
  const Oscillator place(s.mass_kg, s.damping_Ns_per_m, s.stiffness_N_per_m);
  const Oscillator angle(s.inertia_kg_m2, s.rotational_damping_Nms_per_rad,
                         s.rotational_stiffness_Nm_per_rad);
  const auto drive = [] { return Driven{at({0, 0, 0}), {{3, 0, 0}, {0.01, 0, 0}}}; };
  const auto exact = [&](double t) {
    return Pair{0.01 * place.after_a_force(t), 0.01 * angle.after_a_force(t)};
  };
  const double coarse = max_error(s, kTick_s, drive, exact);
  const double fine = max_error(s, kTick_s / 10, drive, exact);
  EXPECT_LT(coarse, 4e-4);
  EXPECT_NEAR(coarse / fine, 10, 2) << "of first order in the tick";
}

TEST(OperatorModel, AnswersAJumpOfThePathLikeAnOscillatorOnASled) {
  OperatorSettings s;
  s.rotational_damping_Nms_per_rad = 0.02;
  const Oscillator place(s.mass_kg, s.damping_Ns_per_m, s.stiffness_N_per_m);
  const Oscillator angle(s.inertia_kg_m2, s.rotational_damping_Nms_per_rad,
                         s.rotational_stiffness_Nm_per_rad);
  const auto drive = [] { return Driven{at({0.01, 0, 0}, {0.01, 0, 0}), {}}; };
  const auto exact = [&](double t) {
    return Pair{0.01 * place.after_a_jump(t), 0.01 * angle.after_a_jump(t)};
  };
  const double coarse = max_error(s, kTick_s, drive, exact);
  const double fine = max_error(s, kTick_s / 10, drive, exact);
  EXPECT_LT(coarse, 8e-4);
  EXPECT_NEAR(coarse / fine, 10, 2);
}

// Springs and damper that move with the path exert nothing, so the hand is neither late nor early.
TEST(OperatorModel, FollowsAnEvenMotionWithoutLag) {
  OperatorModel hand({}, kTick_s);
  for (int i = 0; i < 5000; ++i) {
    const DeviceState path = at({1e-4 * i, 0, 2e-4 * i}, {0, 5e-4 * i, 0});
    const DeviceState d = hand.move(path, i * kTick_s, {});
    if (i < 3000) continue;
    ASSERT_LT((d.position_W - path.position_W).norm(), 1e-12) << i;
    ASSERT_LT(d.orientation_W.angularDistance(path.orientation_W), 1e-7) << i;
  }
}

TEST(OperatorModel, WithoutAGripTheDeviceLeadsTheHand) {
  OperatorSettings s;
  s.grip = {0, 0};
  OperatorModel hand(s, kTick_s);
  DeviceState before, d;
  for (int i = 0; i < 4000; ++i) {
    before = d;
    // Wherever the path goes.
    d = hand.move(at({std::sin(0.01 * i), 0, 0}, {0, 0, 0.001 * i}), i * kTick_s, {{0, 3, 0}, {0.01, 0, 0}});
  }
  EXPECT_LT(((d.position_W - before.position_W) / kTick_s - Vec3(0, 3 / 15.0, 0)).norm(), 1e-9);
  const Vec3 turning = rotation_vector(d.orientation_W * before.orientation_W.conjugate()) / kTick_s;
  EXPECT_LT((turning - Vec3(0.01 / 0.05, 0, 0)).norm(), 1e-9);
}

// After n ticks of a torque the angle is torque / inertia tick^2 n (n + 1) / 2, and then it grows evenly.
TEST(OperatorModel, AFreeTurnKeepsItsAxisAndItsSpeed) {
  std::mt19937 random(6);
  OperatorSettings s;
  s.rotational_stiffness_Nm_per_rad = s.rotational_damping_Nms_per_rad = 0;
  for (int run = 0; run < 10; ++run) {
    const Vec3 axis = direction(random);
    const DeviceState start = at({0, 0, 0}, 2 * direction(random));
    OperatorModel hand(s, kTick_s);
    hand.move(start, 0, {});
    for (int i = 1; i <= 2000; ++i) {
      const DeviceState d =
          hand.move(start, i * kTick_s, {Vec3::Zero(), i <= 100 ? Vec3(0.02 * axis) : Vec3(Vec3::Zero())});
      const int n = std::min(i, 100);
      const double angle = 0.02 / s.inertia_kg_m2 * 1e-6 * (n * (n + 1) / 2 + (i - n) * n);
      const Eigen::Quaterniond expected =
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * start.orientation_W;
      ASSERT_NEAR(std::abs(expected.dot(d.orientation_W)), 1, 1e-13) << i;
      ASSERT_EQ(d.position_W, Vec3::Zero());
    }
  }
}

// With a damper of at least k tick / 2, less than which a step of this kind can add for a moment.
TEST(OperatorModel, EnergyNeverGrowsByItself) {
  std::mt19937 random(9);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  for (int run = 0; run < 100; ++run) {
    OperatorSettings s;
    s.mass_kg = between(0.05, 2), s.inertia_kg_m2 = between(1e-4, 1e-2);
    s.stiffness_N_per_m = between(1, 2000), s.rotational_stiffness_Nm_per_rad = between(0.01, 3);
    s.damping_Ns_per_m = s.stiffness_N_per_m * kTick_s * between(0.5, 20);
    s.rotational_damping_Nms_per_rad = s.rotational_stiffness_Nm_per_rad * kTick_s * between(0.5, 20);
    const Vec3 axis = direction(random);
    const DeviceState path = at(0.1 * direction(random), 0.3 * axis);
    OperatorModel hand(s, kTick_s);
    DeviceState before = hand.move(at({0, 0, 0}), 0, {});
    double last = 1e9;
    for (int i = 1; i < 1000; ++i) {
      const DeviceState d = hand.move(path, i * kTick_s, {});
      const Vec3 v = (d.position_W - before.position_W) / kTick_s;
      const Vec3 w = rotation_vector(d.orientation_W * before.orientation_W.conjugate()) / kTick_s;
      const double angle = d.orientation_W.angularDistance(path.orientation_W);
      const double energy = 0.5 * (s.mass_kg * v.squaredNorm() + s.inertia_kg_m2 * w.squaredNorm() +
                                   s.stiffness_N_per_m * (d.position_W - path.position_W).squaredNorm() +
                                   s.rotational_stiffness_Nm_per_rad * angle * angle);
      ASSERT_LE(energy, last * (1 + 1e-9) + 1e-13) << run << " " << i;
      last = energy, before = d;
    }
  }
}

// --- settings ---

TEST(OperatorModel, PressesButtonsWhenItIsToldTo) {
  OperatorSettings s;
  s.presses = {0.125, 3, 0.25, 0.25, 0, 0.5, 0.25, 31, 0.5};
  OperatorModel hand(s, kTick_s);
  const std::pair<double, std::uint32_t> expected[] = {{0, 0},
                                                       {0.124, 0},
                                                       {0.125, 8},
                                                       {0.249, 8},
                                                       {0.25, 0x80000009},
                                                       {0.374, 0x80000009},
                                                       {0.375, 0x80000001},
                                                       {0.749, 0x80000001},
                                                       {0.75, 0}};
  for (const auto& [time_s, buttons] : expected)
    EXPECT_EQ(hand.move(at({0, 0, 0}), time_s, {}).buttons, buttons) << time_s;
}

TEST(OperatorModel, RefusesWhatCannotBe) {
  OperatorSettings s;
  EXPECT_EQ(validate(s), "");
  s.mass_kg = 0.01, s.stiffness_N_per_m = 400;
  EXPECT_EQ(validate(s), "stiffness_N_per_m = 400.000000: expected below 400.000000 for this mass");
  s.stiffness_N_per_m = 399;
  EXPECT_EQ(validate(s), "");
  s.rotational_stiffness_Nm_per_rad = 40;
  EXPECT_EQ(validate(s),
            "rotational_stiffness_Nm_per_rad = 40.000000: expected below 40.000000 for this inertia");
  s = {};
  s.grip = {0, 1.5};
  EXPECT_EQ(validate(s), "grip: fraction 1.500000: expected 0 to 1");
  s.grip = {1, 0, 0.5, 1};
  EXPECT_EQ(validate(s), "grip: time 0.500000: expected no earlier than the row before");
  s = {};
  for (const double button : {32.0, 1.5}) {
    s.presses = {0, 0, 1, 1, button, 1};
    EXPECT_EQ(validate(s), "presses: button " + std::to_string(button) + ": expected integers 0 to 31");
  }
  s.presses = {0, 0, 0.01, 1, 1, 0.009};
  EXPECT_EQ(validate(s), "presses: duration 0.009000: expected 0.01 or more");
}

// As stiff as it may be at the slowest rate, without a damper: it rings, and does not run away.
TEST(OperatorModel, AnAllowedSpringIsStableAtTheSlowestRate) {
  OperatorSettings s;
  s.mass_kg = 0.05, s.stiffness_N_per_m = 1999, s.damping_Ns_per_m = 0;
  ASSERT_EQ(validate(s), "");
  OperatorModel hand(s, 0.01);
  hand.move(at({0, 0, 0}), 0, {});
  for (int i = 1; i < 10000; ++i)
    ASSERT_LT(hand.move(at({0.01, 0, 0}), 0.01 * i, {}).position_W.norm(), 1) << i;
}

// And a damper that would stop the mass a thousand times within a tick: the hand creeps aside as the spring
// lets it, 1 - exp(-k t / c), without a step back.
TEST(OperatorModel, EveryAllowedDamperIsStable) {
  OperatorSettings s;
  s.mass_kg = 0.01, s.stiffness_N_per_m = 100, s.damping_Ns_per_m = 1000;
  ASSERT_EQ(validate(s), "");
  OperatorModel hand(s, 0.01);
  hand.move(at({0, 0, 0}), 0, {});
  double before = 0;
  for (int i = 1; i < 3000; ++i) {
    const double x = hand.move(at({0, 0, 0}), 0.01 * i, {{1, 0, 0}, Vec3::Zero()}).position_W.x();
    ASSERT_GT(x, before) << i;
    ASSERT_NEAR(x, 0.01 * (1 - std::exp(-0.1 * 0.01 * i)), 1e-5) << i;
    before = x;
  }
}

}  // namespace
}  // namespace remote_touch::operator_model_test
