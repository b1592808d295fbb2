// The hand on a simulated device: the closed forms of its motion, the balance of its energies, its settings.
#include "runners/experiment/hand/simulated_hand.h"

#include <gtest/gtest.h>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch::simulated_hand_test {
namespace {

constexpr double kTick_s = 0.001;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// --- the motion of a run's device, by the script alone or by a hand that feels forces ---

DeviceState at(const Vec3& p_W, const Vec3& turn = Vec3::Zero()) {
  return {p_W, rotation(turn)};
}

TEST(SimulatedHand, FollowsTheScriptExactlyIfThereIsNoOperator) {
  SimulatedHand hand({}, {}, kTick_s);
  RenderOutput out;
  out.force_N = {100, 0, 0};
  for (int i = 0; i < 5; ++i) {
    DeviceState path = at({0.1 * i, 0, 0}, {0, 0.2, 0});
    path.buttons = 5;
    const DeviceState d = hand.move(path, i * kTick_s);
    EXPECT_EQ(d.position_W, path.position_W);
    EXPECT_EQ(d.orientation_W.coeffs(), path.orientation_W.coeffs());
    EXPECT_EQ(d.buttons, 5u);
    hand.apply(rendered_wrench(out));
    EXPECT_FALSE(hand.state());
  }
}

// The force of one tick moves the hand in the next, as far as the device has motors.
TEST(SimulatedHand, FeelsWhatTheDeviceExerts) {
  DeviceSettings device;
  device.motors.force_y = device.motors.torque_x = false;
  SimulatedHand hand(OperatorSettings{}, device, kTick_s);
  RenderOutput out;
  out.force_N = {1, 2, 0};
  out.tool.emplace().torque_Nm = {0.1, 0, 0.2};
  hand.move(at({0, 0, 0}), 0);
  EXPECT_EQ(hand.state()->force_N, Vec3::Zero());
  hand.apply(rendered_wrench(out));
  EXPECT_EQ(hand.state()->force_N, Vec3(1, 0, 0));
  EXPECT_EQ(hand.state()->torque_Nm, Vec3(0, 0, 0.2));
  EXPECT_EQ(hand.state()->intended_W, Vec3::Zero());
  const DeviceState next = hand.move(at({0, 0, 0}), kTick_s);
  EXPECT_GT(next.position_W.x(), 0);
  EXPECT_EQ(next.position_W.y(), 0);
  const Vec3 turn = rotation_vector(next.orientation_W);
  EXPECT_EQ(turn.x(), 0);
  EXPECT_GT(turn.z(), 0);
  hand.apply({});  // a renderer of three degrees of freedom has no torque: that of the tick before is cleared
  EXPECT_EQ(hand.state()->torque_Nm, Vec3::Zero());
}

// --- the hand against the closed forms of a mass, a spring and a damper ---

// Undamped frequency, decay and damped frequency of m x'' + c x' + k x = 0.
struct Oscillator {
  explicit Oscillator(double m, double c, double k)
      : decay(c / (2 * m)), omega(std::sqrt(k / m - decay * decay)) {}
  // x / (f / k) for a constant force f that begins at t = 0.
  double after_a_force(double t) const {
    return 1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  }
  // x / v for an intended position that moves at the speed v from t = 0 on. The damper feels that speed, too.
  double after_a_start(double t) const { return t - std::exp(-decay * t) * std::sin(omega * t) / omega; }
  double decay, omega;
};

// Compares the position and the angle about x with those of `expected`, within half a second.
// drive(t) gives the path at t and what the hand felt in the tick before; expected(o, t) the motion of a
// place or an angle that is driven by 0.01 times its stiffness, or by a path of speed 0.1.
template <class Drive, class Expected>
void expect_oscillators(const Drive& drive, const Expected& expected) {
  OperatorSettings s;
  s.rotational_damping_Nms_per_rad = 0.02;
  const Oscillator place(s.mass_kg, s.damping_Ns_per_m, s.stiffness_N_per_m);
  const Oscillator angle(s.inertia_kg_m2, s.rotational_damping_Nms_per_rad,
                         s.rotational_stiffness_Nm_per_rad);
  for (const double tick_s : {0.01, kTick_s, kTick_s / 10}) {
    OperatorModel hand(s, tick_s);
    hand.move({}, 0, {});
    for (int i = 1; i * tick_s < 0.5; ++i) {
      const double t = i * tick_s;
      const std::pair<DeviceState, Wrench> driven = drive(t);
      const DeviceState d = hand.move(driven.first, t, driven.second);
      ASSERT_NEAR(d.position_W.x(), expected(place, t), 2e-14) << t;
      ASSERT_NEAR(rotation_vector(d.orientation_W).x(), expected(angle, t), 2e-14) << t;
    }
  }
}

TEST(OperatorModel, AnswersAForceLikeAnOscillator) {
  expect_oscillators(
      [](double) {
        return std::pair(at({0, 0, 0}), Wrench{{3, 0, 0}, {0.01, 0, 0}});
      },
      [](const Oscillator& o, double t) { return 0.01 * o.after_a_force(t); });
}

// The path starts evenly from rest: the damper feels its speed, the spring its distance. In the end the hand
// is neither late nor early.
TEST(OperatorModel, AnswersAPathThatStartsLikeAnOscillatorOnASled) {
  expect_oscillators(
      [](double t) {
        return std::pair(at({0.1 * t, 0, 0}, {0.1 * t, 0, 0}), Wrench{});
      },
      [](const Oscillator& o, double t) { return 0.1 * o.after_a_start(t); });
}

// The grip is a fraction of the stiffness of the springs.
TEST(OperatorModel, AConstantWrenchHoldsItAsideByWhatTheGripLeavesOfItsSprings) {
  const Vec3 force_N(1.5, -0.5, 2), torque_Nm(0.1, 0.05, -0.1);
  for (const double grip : {1.0, 0.5}) {
    OperatorSettings s;
    s.grip = {0, grip};
    OperatorModel hand(s, kTick_s);
    DeviceState d;
    for (int i = 0; i < 5000; ++i) d = hand.move(at({1, 2, 3}), i * kTick_s, {force_N, torque_Nm});
    EXPECT_LT((d.position_W - Vec3(1, 2, 3) - force_N / (300 * grip)).norm(), 1e-12) << grip;
    EXPECT_LT((rotation_vector(d.orientation_W) - torque_Nm / grip).norm(), 1e-12) << grip;
  }
}

TEST(OperatorModel, TheDeviceLeadsTheHandIfThereIsNoGrip) {
  OperatorSettings s;
  s.grip = {0, 0};
  OperatorModel hand(s, kTick_s);
  DeviceState before, d;
  for (int i = 0; i < 4000; ++i) {
    before = d;
    // The path has no effect.
    d = hand.move(at({std::sin(0.01 * i), 0, 0}, {0, 0, 0.001 * i}), i * kTick_s, {{0, 3, 0}, {0.01, 0, 0}});
  }
  EXPECT_LT(((d.position_W - before.position_W) / kTick_s - Vec3(0, 3 / 15.0, 0)).norm(), 1e-9);
  const Vec3 turning = rotation_vector(d.orientation_W * before.orientation_W.conjugate()) / kTick_s;
  EXPECT_LT((turning - Vec3(0.01 / 0.05, 0, 0)).norm(), 1e-9);
}

// The energies of a tick balance, and the device's work is its wrench times the displacement that a trace
// has.
TEST(OperatorModel, TheWorkOfATickIsGainedOrDissipated) {
  std::mt19937 random(9);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  for (int run = 0; run < 100; ++run) {
    OperatorSettings s;
    s.mass_kg = between(0.02, 2), s.inertia_kg_m2 = between(1e-4, 1e-2);
    s.stiffness_N_per_m = between(0, 2000), s.rotational_stiffness_Nm_per_rad = between(0, 3);
    s.damping_Ns_per_m = between(0, 30), s.rotational_damping_Nms_per_rad = between(0, 0.1);
    s.grip = {0, 1, 0.1, 1, 0.2, run % 2 == 0 ? 0.0 : 0.5};
    OperatorModel hand(s, kTick_s);
    DeviceState path, before = hand.move(path, 0, {});
    for (int i = 1; i < 300; ++i) {
      path.position_W += 1e-3 * direction(random);
      path.orientation_W = rotation(0.01 * direction(random)) * path.orientation_W;
      const Wrench wrench{5 * direction(random), 0.1 * direction(random)};
      const DeviceState d = hand.move(path, i * kTick_s, wrench);
      const StepEnergy e = hand.last_energy();
      const double size = std::abs(e.force_work_J) + std::abs(e.path_work_J) + e.dissipated_J();
      ASSERT_GE(e.dissipated_J(), 0) << run << " " << i;
      ASSERT_LE(std::abs(e.gained_J() + e.dissipated_J() - e.supplied_J()), 1e-9 * size) << run << " " << i;
      const double work_J =
          wrench.force_N.dot(d.position_W - before.position_W) +
          wrench.torque_Nm.dot(rotation_vector(d.orientation_W * before.orientation_W.conjugate()));
      ASSERT_NEAR(e.force_work_J, work_J, 1e-14) << run << " " << i;  // poses are rounded to 1e-16
      before = d;
    }
  }
}

// A step over n missed ticks moves the hand to the position after n ticks of the same force and of an even
// path.
TEST(OperatorModel, MovesOnThroughMissedTicks) {
  const OperatorSettings s;
  const Wrench wrench{{3, -2, 1}, {0, 0, 0.02}};
  const auto path = [](int tick) { return at({1e-4 * tick, 0, 2e-5 * tick}, {0, 0, 1e-3 * tick}); };
  OperatorModel every(s, kTick_s), some(s, kTick_s);
  for (int tick = 0; tick <= 100; ++tick) {
    const DeviceState expected = every.move(path(tick), tick * kTick_s, wrench);
    if (tick % 7 != 0 && tick % 5 != 0) continue;
    const DeviceState d = some.move(path(tick), tick * kTick_s, wrench);
    ASSERT_LT((d.position_W - expected.position_W).norm(), 1e-15) << tick;
    ASSERT_LT(rotation_vector(d.orientation_W * expected.orientation_W.conjugate()).norm(), 1e-14) << tick;
  }
}

// --- settings ---

TEST(OperatorModel, PressesButtonsAtTheGivenTimes) {
  OperatorSettings s;
  s.presses = {0.125, 3, 0.25, 0.25, 0, 0.5, 0.25, 31, 0.5};
  OperatorModel hand(s, kTick_s);
  const double times_s[] = {0, 0.124, 0.125, 0.249, 0.25, 0.374, 0.375, 0.749, 0.75};
  const std::uint32_t buttons[] = {0, 0, 8, 8, 0x80000009, 0x80000009, 0x80000001, 0x80000001, 0};
  for (int i = 0; i < 9; ++i)
    EXPECT_EQ(hand.move(at({0, 0, 0}), times_s[i], {}).buttons, buttons[i]) << times_s[i];
}

TEST(OperatorModel, RefusesImpossibleSettings) {
  const std::pair<void (*)(OperatorSettings&), const char*> rows[] = {
      {[](OperatorSettings& s) { s.stiffness_N_per_m = 100000; }, ""},
      {[](OperatorSettings& s) { s.stiffness_N_per_m = 100001; },
       "stiffness_N_per_m = 100001.000000: expected at most 100000.000000 for this mass"},
      {[](OperatorSettings& s) { s.rotational_stiffness_Nm_per_rad = 100; }, ""},
      {[](OperatorSettings& s) { s.rotational_stiffness_Nm_per_rad = 101; },
       "rotational_stiffness_Nm_per_rad = 101.000000: expected at most 100.000000 for this inertia"},
      {[](OperatorSettings& s) {
         s.grip = {0, 1.5};
       },
       "grip: fraction 1.500000: expected 0 to 1"},
      {[](OperatorSettings& s) {
         s.grip = {1, 0, 0.5, 1};
       },
       "grip: time 0.500000: expected no earlier than the row before"},
      {[](OperatorSettings& s) { s.presses = {0, 0, 1, 1, 32, 1}; },
       "presses: button 32.000000: expected integers 0 to 31"},
      {[](OperatorSettings& s) { s.presses = {0, 0, 1, 1, 1.5, 1}; },
       "presses: button 1.500000: expected integers 0 to 31"},
      {[](OperatorSettings& s) { s.presses = {0, 0, 0.01, 1, 1, 0.009}; },
       "presses: duration 0.009000: expected 0.01 or more"}};
  for (const auto& [change, expected] : rows) {
    OperatorSettings s;
    s.mass_kg = 0.01, s.inertia_kg_m2 = 1e-5;
    change(s);
    EXPECT_EQ(validate(s), expected);
  }
}

}  // namespace
}  // namespace remote_touch::simulated_hand_test
