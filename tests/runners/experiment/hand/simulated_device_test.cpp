// A simulated device: what its motors exert, what it measures, and the virtual walls on it.
#include "runners/experiment/hand/simulated_hand.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/points/vector.h"

namespace remote_touch::simulated_device_test {
namespace {

constexpr double kTick_s = 0.001;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
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

// --- what the device measures and exerts ---

Wrench pull(double x_N) {
  return {{x_N, 0, 0}, Vec3::Zero()};
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

// --- a virtual wall ---
// Limits of stability are those of a linear system; bounds of passivity are those of J. E. Colgate and G. G.
// Schenkel, J. Robotic Systems 14 (1997), and, for rounded positions, of J. J. Abbott and A. M. Okamura, IEEE
// Trans. Robotics 21 (2005).

// A wall on a device with a damper. Its own damping uses the difference of two ticks for the velocity.
DeviceSettings wall_on_device(double damping, double wall_damping, int delay_ticks = 0) {
  DeviceSettings s;
  s.resistance.damping_Ns_per_m = damping, s.contact_damping_Ns_per_m = wall_damping;
  s.delay_ticks = delay_ticks;
  return s;
}

// Returns the largest deviation in the last tenth of a motion that begins at 1 mm, as a fraction of it. The
// wall is on both sides, so that the loop is linear.
double final_swing(double stiffness, const DeviceSettings& s) {
  OperatorSettings human;
  human.mass_kg = 1, human.stiffness_N_per_m = human.damping_Ns_per_m = 0;
  DeviceModel device(s, kTick_s);
  OperatorModel hand(human, kTick_s, s.resistance);
  Wrench wrench;
  double largest = 0;
  const int ticks = 60000;
  for (int tick = 0; tick < ticks; ++tick) {
    const DeviceState at = device.measured(hand.move({{0.001, 0, 0}}, tick * kTick_s, wrench));
    wrench = device.exerted_for(pull(-stiffness * at.position_W.x()));
    if (tick > 0.9 * ticks) largest = std::max(largest, std::abs(at.position_W.x()) / 0.001);
  }
  return largest;
}

// K* = (b + B) / (T / 2 + delay), for masses whose oscillation is slow beside a tick.
TEST(VirtualWall, GrowsAboveTheDampingOverTheDelayAndDecaysBelowIt) {
  for (const int delay_ticks : {0, 1, 5})
    for (const double share : {0.0, 0.5, -0.5}) {
      const double b = 0.5, limit = (1 + share) * b / (kTick_s / 2 + delay_ticks * kTick_s);
      const DeviceSettings s = wall_on_device(b, share * b, delay_ticks);
      EXPECT_LT(final_swing(0.95 * limit, s), 0.9) << delay_ticks << " " << share;
      EXPECT_GT(final_swing(1.05 * limit, s), 1.1) << delay_ticks << " " << share;
    }
}

// Returns the largest energy that the wall at x > 0 has given to a hand on a device, less what damping and
// friction of the device took, at any time of a motion.
double largest_gain_J(double stiffness, const DeviceSettings& s, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  OperatorSettings human;
  human.mass_kg = std::exp(between(-4, 1)), human.stiffness_N_per_m = std::exp(between(0, 8));
  human.damping_Ns_per_m = between(0, 0.3) * std::sqrt(human.mass_kg * human.stiffness_N_per_m);
  DeviceModel device(s, kTick_s);
  OperatorModel hand(human, kTick_s, s.resistance);
  Wrench wrench;
  double path = -0.001, speed = 0, gain = 0, largest = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const DeviceState at = device.measured(hand.move({{path, 0, 0}}, tick * kTick_s, wrench));
    if (tick > 0) {
      const StepEnergy energy = hand.last_energy();
      // The ground damper is that of the device, because the grip does not change.
      gain += energy.force_work_J - energy.ground_damper_J - energy.dry_friction_J;
      largest = std::max(largest, gain);
    }
    const double x = at.position_W.x();
    wrench = device.exerted_for(pull(x > 0 ? -stiffness * x : 0));
    if (tick % 20 == 0) speed = (between(-0.002, 0.003) - path) / (20 * kTick_s);
    path += speed * kTick_s;
  }
  return largest;
}

DeviceSettings encoder(double damping, double friction, double resolution) {
  DeviceSettings s = wall_on_device(damping, 0);
  s.resistance.friction_N = friction, s.position_resolution_m = resolution;
  return s;
}

// No hand gains energy while b >= K T / 2 + |B|, or, with rounded positions, K <= min(2 b / T, 2 f_c / D).
// The limit is 1e-12 J for rounding.
TEST(VirtualWall, IsPassiveWithinTheBounds) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const double b = 0.1 + 0.01 * seed, resolution = 1e-5 * (1 + seed % 5), stiffness = 2 * b / kTick_s;
    ASSERT_LE(largest_gain_J(stiffness, encoder(b, stiffness * resolution / 2, resolution), seed), 1e-12)
        << seed;
    const double share = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 0.5 : -0.5;
    ASSERT_LE(largest_gain_J((1 - std::abs(share)) * stiffness, wall_on_device(b, share * b), seed), 1e-12)
        << seed;
  }
}

// Rounding without friction gives energy, however much the device damps.
TEST(VirtualWall, GivesEnergyOutsideTheBounds) {
  int rounded = 0, stiff = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    rounded += largest_gain_J(1000, encoder(0.5, 0, 1e-3), seed) > 1e-9;
    stiff += largest_gain_J(1000, wall_on_device(0.1, 0), seed) > 1e-9;
  }
  EXPECT_GT(rounded, 25);
  EXPECT_GT(stiff, 25);
}

// --- finding B1: what a step that conserves energy under a held force hides ---

// A push of ten ticks sets a hand in motion towards a wall of 600 N/m at x >= 0. The hand comes back.
TEST(VirtualWall, AHandWithoutDampingLeavesItFasterThanItCame) {
  OperatorSettings s;
  s.mass_kg = 0.5, s.stiffness_N_per_m = s.damping_Ns_per_m = 0;
  OperatorModel hand(s, kTick_s);
  double x = hand.move({Vec3(-0.01, 0, 0)}, 0, {}).position_W.x(), before = x;
  double speed_in = 0, work_J = 0, gained_J = 0;
  for (int tick = 1; x > -0.011; ++tick) {
    ASSERT_LT(tick, 2000);
    Wrench wrench;
    wrench.force_N.x() = x > 0 ? -600 * x : tick <= 10 ? 5 : 0;
    before = x, x = hand.move({}, tick * kTick_s, wrench).position_W.x();
    if (before <= 0 && x > 0) speed_in = (x - before) / kTick_s;
    if (before > 0) {
      work_J += wrench.force_N.x() * (x - before);
      gained_J += hand.last_energy().kinetic_J;
    }
  }
  const double speed_out = (x - before) / kTick_s;
  // exp(pi / 2 T sqrt(K / m)) to first order; the phases of entering and leaving add up to K T^2 / m =
  // 0.0012.
  EXPECT_NEAR(std::pow(speed_out / speed_in, 2), 1.056, 0.0025);
  EXPECT_NEAR(gained_J, work_J, 1e-9 * std::abs(work_J));
  EXPECT_NEAR(gained_J, 0.25 * (speed_out * speed_out - speed_in * speed_in), 1e-12);
}

// 0.05 kg with 2 N s/m at 10 kN/m: the largest eigenvalue of the step of a tick is 1.029.
TEST(VirtualWall, AStiffWallMakesALightHandUnstable) {
  OperatorSettings s;
  s.mass_kg = 0.05, s.damping_Ns_per_m = 2, s.grip = {0, 0};
  OperatorModel hand(s, kTick_s);
  double x = hand.move({Vec3(1e-6, 0, 0)}, 0, {}).position_W.x();
  double largest = 0;
  for (int tick = 1; tick <= 500; ++tick) {
    x = hand.move({}, tick * kTick_s, {{-10000 * x, 0, 0}, Vec3::Zero()}).position_W.x();
    if (tick > 450) largest = std::max(largest, std::abs(x));
  }
  EXPECT_GT(largest, 1e-6 * std::pow(1.028, 450));
  EXPECT_LT(largest, 1e-6 * std::pow(1.030, 500));
}

}  // namespace
}  // namespace remote_touch::simulated_device_test
