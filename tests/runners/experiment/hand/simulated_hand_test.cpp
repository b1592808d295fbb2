#include "runners/experiment/hand/simulated_hand.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch::device_model_test {
namespace {

// A device that lacks some motors, in any orientation of its handle.

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

TEST(DeviceMotors, ADeviceWithAllOfThemExertsWhatIsCommanded) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Wrench commanded{5 * direction(random), direction(random)};
    const Wrench device_wrench = exerted({}, rotation(3 * direction(random)), commanded);
    EXPECT_EQ(device_wrench.force_N, commanded.force_N);
    EXPECT_LT((device_wrench.torque_Nm - commanded.torque_Nm).norm(), 4e-15);
  }
}

// The torque about the missing axis of the handle is zero and that about the other two is as commanded, in
// every orientation.
TEST(DeviceMotors, TorquesAreRemovedAboutTheHandleAxes) {
  std::mt19937 random(2);
  for (int missing = 0; missing < 3; ++missing) {
    MotorSettings motors;
    (missing == 0 ? motors.torque_x : missing == 1 ? motors.torque_y : motors.torque_z) = false;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Quaterniond handle_W = rotation(3 * direction(random));
      const Wrench commanded{direction(random), direction(random)};
      const Wrench device_wrench = exerted(motors, handle_W, commanded);
      EXPECT_EQ(device_wrench.force_N, commanded.force_N);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 axis_W = handle_W.toRotationMatrix().col(axis);
        EXPECT_NEAR(device_wrench.torque_Nm.dot(axis_W),
                    axis == missing ? 0 : commanded.torque_Nm.dot(axis_W), 4e-15);
      }
    }
  }
}

// The x axis of a handle that is turned by 90 degrees is the y axis of the base.
TEST(DeviceMotors, TheRollOfATurnedHandleIsAnotherAxisOfTheBase) {
  MotorSettings motors;
  motors.torque_x = false;
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Vec3::UnitZ()));
  EXPECT_LT((exerted(motors, quarter, {Vec3::Zero(), {1, 2, 3}}).torque_Nm - Vec3(1, 0, 3)).norm(), 4e-15);
}

TEST(DeviceMotors, ForcesAreRemovedAlongTheBaseAxes) {
  std::mt19937 random(3);
  MotorSettings motors;
  motors.force_x = motors.force_z = false;
  const Wrench device_wrench = exerted(motors, rotation(direction(random)), {{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(device_wrench.force_N, Vec3(0, 2, 0));
  EXPECT_LT((device_wrench.torque_Nm - Vec3(4, 5, 6)).norm(), 1e-14);
  motors.force_y = false;
  EXPECT_EQ(exerted(motors, rotation(direction(random)), {{1, 2, 3}, {0, 0, 0}}).force_N, Vec3::Zero());
}

TEST(DeviceMotors, LongerWrenchesAreCutAndShorterOnesLeft) {
  std::mt19937 random(4);
  MotorSettings motors;
  motors.max_force_N = 3, motors.max_torque_Nm = 0.2;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Quaterniond handle_W = rotation(3 * direction(random));
    const Vec3 f = direction(random), t = direction(random);
    const Wrench cut = exerted(motors, handle_W, {(3.1 + i) * f, (0.21 + i) * t});
    EXPECT_LT((cut.force_N - 3 * f).norm(), 1e-14);
    EXPECT_LT((cut.torque_Nm - 0.2 * t).norm(), 4e-15);
    const Wrench left = exerted(motors, handle_W, {2.9 * f, 0.19 * t});
    EXPECT_EQ(left.force_N, 2.9 * f);
    EXPECT_LT((left.torque_Nm - 0.19 * t).norm(), 4e-15);
  }
}

TEST(DeviceMotors, AZeroIsNoLimit) {
  EXPECT_EQ(exerted({}, Eigen::Quaterniond::Identity(), {{1e6, 0, 0}, {0, 1e6, 0}}).force_N, Vec3(1e6, 0, 0));
  EXPECT_EQ(exerted({}, Eigen::Quaterniond::Identity(), {{1e6, 0, 0}, {0, 1e6, 0}}).torque_Nm,
            Vec3(0, 1e6, 0));
}

// A simulated device: what it measures and exerts.

constexpr double kTick_s = 0.001;

Wrench pull(double x_N) {
  return {{x_N, 0, 0}, Vec3::Zero()};
}

TEST(DeviceModel, WithoutSettingsMeasuresAndExertsExactly) {
  DeviceModel device({}, kTick_s);
  DeviceState hand{{0.123456789, -2, 3}, rotation({0.1, 0.2, 0.3})};
  hand.buttons = 3;
  const DeviceState seen = device.measured(hand);
  EXPECT_EQ(seen.position_W, hand.position_W);
  EXPECT_EQ(seen.orientation_W.coeffs(), hand.orientation_W.coeffs());
  EXPECT_EQ(seen.buttons, 3u);
  const Wrench exerted = device.exerted_for({{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(exerted.force_N, Vec3(1, 2, 3));
  EXPECT_TRUE(exerted.torque_Nm.isApprox(Vec3(4, 5, 6), 1e-15));
}

TEST(DeviceModel, RoundsThePoseToItsResolution) {
  DeviceSettings s;
  s.position_resolution_m = 0.001, s.angle_resolution_deg = 2;
  DeviceModel device(s, kTick_s);
  const DeviceState seen =
      device.measured({{0.00249, -0.00251, 0}, rotation({0, 0.9 * std::numbers::pi / 180, 0.05})});
  EXPECT_NEAR(seen.position_W.x(), 0.002, 1e-15);
  EXPECT_NEAR(seen.position_W.y(), -0.003, 1e-15);
  EXPECT_EQ(seen.position_W.z(), 0);
  const Vec3 turn_deg = rotation_vector(seen.orientation_W) * 180 / std::numbers::pi;  // 0.05 rad = 2.86 deg
  EXPECT_NEAR((turn_deg - Vec3(0, 0, 2)).norm(), 0, 1e-12);
}

TEST(DeviceModel, ExertsACommandAfterItsDelay) {
  for (const int delay : {0, 1, 5}) {
    DeviceSettings s;
    s.delay_ticks = delay;
    DeviceModel device(s, kTick_s);
    for (int tick = 0; tick < 12; ++tick) {
      device.measured({});
      const double expected = tick < delay ? 0 : 1 + tick - delay;
      EXPECT_EQ(device.exerted_for(pull(1 + tick)).force_N.x(), expected) << delay << " " << tick;
    }
  }
}

TEST(DeviceModel, DampsACommandWithAForceOnly) {
  DeviceSettings s;
  s.contact_damping_Ns_per_m = 2, s.velocity_ticks = 3;
  DeviceModel device(s, kTick_s);
  const double positions[] = {0, 0.001, 0.003, 0.006, 0.010};
  const double velocities[] = {0, 1, 1.5, 2, 3};  // over three ticks, over fewer at the begin
  for (int tick = 0; tick < 5; ++tick) {
    device.measured({{positions[tick], 0, 0}});
    EXPECT_NEAR(device.exerted_for(pull(10)).force_N.x(), 10 - 2 * velocities[tick], 1e-12) << tick;
  }
  device.measured({{1, 0, 0}});
  EXPECT_EQ(device.exerted_for({}).force_N, Vec3::Zero());
}

// The motors limit what arrives, not what was commanded.
TEST(DeviceModel, LimitsWhatArrives) {
  DeviceSettings s;
  s.motors.max_force_N = 3, s.motors.force_y = false, s.delay_ticks = 1;
  DeviceModel device(s, kTick_s);
  device.measured({});
  EXPECT_EQ(device.exerted_for({{8, 8, 0}, Vec3::Zero()}).force_N, Vec3::Zero());
  device.measured({});
  EXPECT_NEAR((device.exerted_for({}).force_N - Vec3(3, 0, 0)).norm(), 0, 1e-15);
}

TEST(DeviceSettings, RefuseAVelocityThatNothingUses) {
  DeviceSettings s;
  EXPECT_EQ(validate(s), "");
  s.velocity_ticks = 4;
  EXPECT_NE(validate(s).find("contact_damping_Ns_per_m"), std::string::npos);
  s.contact_damping_Ns_per_m = 1;
  EXPECT_EQ(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::device_model_test

namespace remote_touch::simulated_hand_test {
namespace {

// The motion of a run's device: by the script alone, or by a hand that feels the forces of the device.

constexpr double kTick_s = 0.001;

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
}

// A renderer of three degrees of freedom has no torque, so that of the tick before is cleared.
TEST(SimulatedHand, FeelsNoTorqueWithoutATool) {
  SimulatedHand hand(OperatorSettings{}, {}, kTick_s);
  hand.move(at({0, 0, 0}), 0);
  RenderOutput out;
  out.tool.emplace().torque_Nm = {1, 0, 0};
  hand.apply(rendered_wrench(out));
  EXPECT_EQ(hand.state()->torque_Nm, Vec3(1, 0, 0));
  hand.apply({});
  EXPECT_EQ(hand.state()->torque_Nm, Vec3::Zero());
}

}  // namespace
}  // namespace remote_touch::simulated_hand_test

namespace remote_touch::operator_model_test {
namespace {

// The simulated hand against the closed forms of a mass, a spring and a damper.

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
  // x / (f / k) for a constant force f that begins at t = 0.
  double after_a_force(double t) const {
    return 1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  }
  // x / v for an intended position that moves at the speed v from t = 0 on. The damper feels that speed, too.
  double after_a_start(double t) const { return t - std::exp(-decay * t) * std::sin(omega * t) / omega; }
  double decay, omega;
};

// Returns the largest deviation from `expected` within half a second. drive(t) gives the path at t and what
// the hand felt in the tick before.
template <class Drive, class Expected>
double max_error(const OperatorSettings& s, double tick_s, const Drive& drive, const Expected& expected) {
  OperatorModel hand(s, tick_s);
  hand.move(at({0, 0, 0}), 0, {});
  double error = 0;
  for (int i = 1; i * tick_s < 0.5; ++i) {
    const auto [path, device_wrench] = drive(i * tick_s);
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

TEST(OperatorModel, AFreeHandOnARestingPathDoesNotMove) {
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

// The grip is a fraction of the stiffness of the springs.
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
  const auto drive = [](double) { return Driven{at({0, 0, 0}), {{3, 0, 0}, {0.01, 0, 0}}}; };
  const auto exact = [&](double t) {
    return Pair{0.01 * place.after_a_force(t), 0.01 * angle.after_a_force(t)};
  };
  for (const double tick_s : {0.01, kTick_s, kTick_s / 10})
    EXPECT_LT(max_error(s, tick_s, drive, exact), 1e-14) << tick_s;
}

// The path starts evenly from rest: the damper feels its speed, the spring its distance.
TEST(OperatorModel, AnswersAPathThatStartsLikeAnOscillatorOnASled) {
  OperatorSettings s;
  s.rotational_damping_Nms_per_rad = 0.02;
  const Oscillator place(s.mass_kg, s.damping_Ns_per_m, s.stiffness_N_per_m);
  const Oscillator angle(s.inertia_kg_m2, s.rotational_damping_Nms_per_rad,
                         s.rotational_stiffness_Nm_per_rad);
  const auto drive = [](double t) { return Driven{at({0.1 * t, 0, 0}, {0.2 * t, 0, 0}), {}}; };
  const auto exact = [&](double t) {
    return Pair{0.1 * place.after_a_start(t), 0.2 * angle.after_a_start(t)};
  };
  for (const double tick_s : {0.01, kTick_s, kTick_s / 10})
    EXPECT_LT(max_error(s, tick_s, drive, exact), 2e-14) << tick_s;
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

// The angle after n ticks of a torque is torque / inertia (n tick)^2 / 2; then it grows evenly.
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
      const double angle = 0.02 / s.inertia_kg_m2 * 1e-6 * (n * n / 2.0 + (i - n) * n);
      const Eigen::Quaterniond expected =
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * start.orientation_W;
      ASSERT_NEAR(std::abs(expected.dot(d.orientation_W)), 1, 1e-13) << i;
      ASSERT_EQ(d.position_W, Vec3::Zero());
    }
  }
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
      ASSERT_LE(std::abs(e.gained_J() + e.dissipated_J() - e.supplied_J()), 1e-9 * size) << run << " " << i;
      const double work_J =
          wrench.force_N.dot(d.position_W - before.position_W) +
          wrench.torque_Nm.dot(rotation_vector(d.orientation_W * before.orientation_W.conjugate()));
      ASSERT_NEAR(e.force_work_J, work_J, 1e-14) << run << " " << i;  // poses are rounded to 1e-16
      before = d;
    }
  }
}

TEST(OperatorModel, EnergyNeverGrowsByItself) {
  std::mt19937 random(9);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  for (int run = 0; run < 100; ++run) {
    OperatorSettings s;
    s.mass_kg = between(0.05, 2), s.inertia_kg_m2 = between(1e-4, 1e-2);
    s.stiffness_N_per_m = between(1, 2000), s.rotational_stiffness_Nm_per_rad = between(0.01, 3);
    s.damping_Ns_per_m = s.stiffness_N_per_m * kTick_s * between(0, 20);
    s.rotational_damping_Nms_per_rad = s.rotational_stiffness_Nm_per_rad * kTick_s * between(0, 20);
    const DeviceState path = at(0.1 * direction(random), 0.3 * direction(random));
    OperatorModel hand(s, kTick_s);
    hand.move(path, 0, {});
    for (int i = 1; i < 1000; ++i) {
      hand.move(path, i * kTick_s, i < 20 ? Wrench{{1, 2, 3}, {0.1, 0, -0.1}} : Wrench{});
      if (i < 20) continue;
      ASSERT_GE(hand.last_energy().dissipated_J(), 0) << run << " " << i;
      ASSERT_LE(hand.last_energy().gained_J(), 1e-16) << run << " " << i;
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

TEST(OperatorModel, RefusesImpossibleSettings) {
  OperatorSettings s;
  EXPECT_EQ(validate(s), "");
  s.mass_kg = 0.01, s.stiffness_N_per_m = 100000;
  EXPECT_EQ(validate(s), "");
  s.inertia_kg_m2 = 1e-5, s.rotational_stiffness_Nm_per_rad = 101;
  EXPECT_EQ(validate(s),
            "rotational_stiffness_Nm_per_rad = 101.000000: expected at most 100.000000 for this inertia");
  s.rotational_stiffness_Nm_per_rad = 100;
  EXPECT_EQ(validate(s), "");
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

// The spring is as stiff as allowed at the slowest rate, without a damper: the hand rings, but does not
// diverge.
TEST(OperatorModel, AnAllowedSpringIsStableAtTheSlowestRate) {
  OperatorSettings s;
  s.mass_kg = 0.01, s.stiffness_N_per_m = 100000, s.damping_Ns_per_m = 0;
  ASSERT_EQ(validate(s), "");
  OperatorModel hand(s, 0.01);
  hand.move(at({0, 0, 0}), 0, {});
  for (int i = 1; i < 10000; ++i)
    ASSERT_LT(hand.move(at({0.01, 0, 0}), 0.01 * i, {}).position_W.norm(), 0.0201) << i;
}

// A damper that would stop the mass a thousand times within a tick is stable as well. The hand creeps aside
// as 1 - exp(-k t / c), without a step back.
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
