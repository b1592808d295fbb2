// A virtual wall on a simulated device with delay, rounded positions and dry friction. Limits of stability
// are those of a linear system; bounds of passivity are those of J. J. Abbott and A. M. Okamura, "Effects of
// position quantization and sampling rate on virtual-wall passivity", IEEE Trans. Robotics 21 (2005).
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>

#include "runners/experiment/hand/simulated_hand.h"
#include "tests/runners/experiment/hand/held_motion_oracle.h"

namespace remote_touch::device_wall_test {
namespace {

constexpr double kTick_s = 0.001;

OperatorSettings free_mass(double mass_kg) {
  OperatorSettings s;
  s.mass_kg = mass_kg, s.stiffness_N_per_m = s.damping_Ns_per_m = 0;
  return s;
}

// --- the limit of stability with a delay ---

// Returns the matrix that maps (x, x', x one tick ago, the forces on their way) to their values one tick
// later, by matrix exponentials of the motion. It shares no code with the device.
Eigen::MatrixXd closed_loop(double stiffness, double wall_damping, double mass, double b, int delay_ticks) {
  const oracle::Matrix step =
      oracle::exponential_less_one(oracle::generator({mass, 0, 0, b}), static_cast<oracle::Real>(kTick_s));
  const int size = 3 + delay_ticks;
  Eigen::MatrixXd next(size, size);
  for (int i = 0; i < size; ++i) {
    Eigen::VectorXd state = Eigen::VectorXd::Unit(size, i);
    const double command = -stiffness * state[0] - wall_damping * (state[0] - state[2]) / kTick_s;
    const double force = delay_ticks == 0 ? command : state[3];
    oracle::State motion;
    motion << state[0], state[1], 0, 0, force / mass;
    motion += step * motion;
    Eigen::VectorXd column(size);
    column << static_cast<double>(motion[0]), static_cast<double>(motion[1]), state[0],
        state.tail(std::max(0, delay_ticks));
    if (delay_ticks > 0) {
      column.segment(3, delay_ticks - 1) = state.segment(4, delay_ticks - 1);
      column[size - 1] = command;
    }
    next.col(i) = column;
  }
  return next;
}

double largest_stable_stiffness(double wall_damping, double mass, double b, int delay_ticks) {
  double low = 0, high = 1e5;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (oracle::spectral_radius(closed_loop(middle, wall_damping, mass, b, delay_ticks)) <= 1 ? low : high) =
        middle;
  }
  return low;
}

double expected_limit(double wall_damping, double b, int delay_ticks) {
  return (b + wall_damping) / (kTick_s / 2 + delay_ticks * kTick_s);
}

TEST(DeviceWall, IsStableUpToTheDampingOverTheDelay) {
  for (const int delay_ticks : {0, 1, 5})
    for (const double b : {0.1, 0.5})
      for (const double share : {0.0, 0.5, -0.5}) {
        const double expected = expected_limit(share * b, b, delay_ticks);
        EXPECT_NEAR(largest_stable_stiffness(share * b, 1, b, delay_ticks), expected, 0.03 * expected)
            << delay_ticks << " " << b << " " << share;
      }
}

// Returns the largest deviation in the last tenth of a motion that begins at 1 mm, as a fraction of it. The
// wall is on both sides, so that the loop is linear.
double final_swing(double stiffness, double wall_damping, double mass, double b, int delay_ticks) {
  DeviceSettings s;
  s.resistance.damping_Ns_per_m = b, s.delay_ticks = delay_ticks, s.contact_damping_Ns_per_m = wall_damping;
  DeviceModel device(s, kTick_s);
  OperatorModel hand(free_mass(mass), kTick_s, s.resistance);
  Wrench wrench;
  double largest = 0;
  const int ticks = 60000;
  for (int tick = 0; tick < ticks; ++tick) {
    const DeviceState at = device.measured(hand.move({{0.001, 0, 0}}, tick * kTick_s, wrench));
    wrench = device.exerted_for({{-stiffness * at.position_W.x(), 0, 0}, Vec3::Zero()});
    if (tick > 0.9 * ticks) largest = std::max(largest, std::abs(at.position_W.x()) / 0.001);
  }
  return largest;
}

TEST(DeviceWall, GrowsAboveTheLimitAndDecaysBelowIt) {
  for (const int delay_ticks : {0, 1, 5})
    for (const double share : {0.0, 0.5, -0.5}) {
      const double b = 0.5, limit = expected_limit(share * b, b, delay_ticks);
      EXPECT_LT(final_swing(0.95 * limit, share * b, 1, b, delay_ticks), 0.9) << delay_ticks << " " << share;
      EXPECT_GT(final_swing(1.05 * limit, share * b, 1, b, delay_ticks), 1.1) << delay_ticks << " " << share;
    }
}

// --- the bound of passivity with rounded positions ---

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
    wrench = device.exerted_for({{x > 0 ? -stiffness * x : 0, 0, 0}, Vec3::Zero()});
    if (tick % 20 == 0) speed = (between(-0.002, 0.003) - path) / (20 * kTick_s);
    path += speed * kTick_s;
  }
  return largest;
}

DeviceSettings encoder(double damping, double friction, double resolution) {
  DeviceSettings s;
  s.resistance.damping_Ns_per_m = damping, s.resistance.friction_N = friction;
  s.position_resolution_m = resolution;
  return s;
}

// K <= min(2 b / T, 2 f_c / D); the limit is 1e-12 J for rounding.
TEST(DeviceWall, IsPassiveWithinTheBoundOfAbbottAndOkamura) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const double b = 0.1 + 0.01 * seed, resolution = 1e-5 * (1 + seed % 5);
    const double stiffness = 2 * b / kTick_s, friction = stiffness * resolution / 2;
    ASSERT_LE(largest_gain_J(stiffness, encoder(b, friction, resolution), seed), 1e-12) << seed;
  }
}

// Rounding without friction gives energy, however much the device damps.
TEST(DeviceWall, GivesEnergyWithoutFrictionIfPositionsAreRounded) {
  int active = 0;
  for (unsigned seed = 0; seed < 50; ++seed)
    active += largest_gain_J(1000, encoder(0.5, 0, 1e-3), seed) > 1e-9;
  EXPECT_GT(active, 25);
}

// A virtual wall, F = -(K x + B x') with the difference of two ticks for x', held for a tick, and a mass with
// a damper b: the oldest results on sampled walls. The limit of stability is that of a linear system, the
// bound of passivity that of J. E. Colgate and G. G. Schenkel, J. Robotic Systems 14 (1997).

struct Wall {
  double stiffness_N_per_m = 0, damping_Ns_per_m = 0;  // K, B
  double force_N(double x_m, double before_m) const {
    return -stiffness_N_per_m * x_m - damping_Ns_per_m * (x_m - before_m) / kTick_s;
  }
};

// Returns the matrix that maps (x, x', x one tick ago) to their values one tick later.
Eigen::Matrix3d closed_loop(const Wall& wall, double mass_kg, double damping_Ns_per_m) {
  const HeldForceStep step({mass_kg, 0, 0, damping_Ns_per_m}, kTick_s);
  Eigen::Matrix3d next;
  for (int i = 0; i < 3; ++i) {
    const Vec3 state = Vec3::Unit(i);
    HeldForceStep::Start start;
    start.velocity.x() = state.y();
    start.force.x() = wall.force_N(state.x(), state.z());
    const HeldForceStep::Motion motion = step.motion(start);
    next.col(i) = Vec3(state.x() + motion.displacement.x(), motion.velocity.x(), state.x());
  }
  return next;
}

double largest_stable_stiffness(double mass_kg, double damping_Ns_per_m, double wall_damping_Ns_per_m) {
  double low = 0, high = 1e6;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const auto loop = closed_loop({middle, wall_damping_Ns_per_m}, mass_kg, damping_Ns_per_m);
    (oracle::spectral_radius(loop) <= 1 ? low : high) = middle;
  }
  return low;
}

// K* = (b + B) / (T / 2), for masses whose oscillation is slow beside a tick. The limit of the exact system
// differs by terms of the order of b T / m and K T^2 / m, here at most 0.003.
TEST(VirtualWall, IsStableUpToTwiceTheDampingPerTick) {
  for (const double b : {0.1, 0.5})
    for (const double mass_kg : {0.5, 2.0})
      for (const double share : {0.0, 0.5, -0.5}) {
        const double expected = 2 * (b + share * b) / kTick_s;
        EXPECT_NEAR(largest_stable_stiffness(mass_kg, b, share * b), expected, 0.03 * expected)
            << b << " " << mass_kg << " " << share;
      }
}

TEST(VirtualWall, TheExampleOfALightDeviceIsStableUpTo300NewtonPerMetre) {
  EXPECT_NEAR(largest_stable_stiffness(0.5, 0.1, 0.05), 300, 9);
}

// Returns the largest energy that the wall has given to a hand on a device with the damper b, less what this
// damper took, at any time of a motion. The wall is at x > 0, and the motion begins outside it.
double largest_gain_J(const Wall& wall, double b, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  const double mass_kg = std::exp(between(-4, 1)), stiffness = std::exp(between(0, 8));
  const HeldForceStep step({mass_kg, stiffness, between(0, 0.3) * std::sqrt(mass_kg * stiffness), b},
                           kTick_s);
  double x = -0.01, before = x, path = x, gain = 0, largest = 0;
  HeldForceStep::Start start;
  for (int tick = 0; tick < 3000; ++tick) {
    if (tick % 20 == 0) start.path_velocity.x() = (between(-0.02, 0.03) - path) / (20 * kTick_s);
    start.apart.x() = path - x;
    start.force.x() = x > 0 ? wall.force_N(x, before) : 0;
    const StepEnergy energy = step.energy(start);
    gain += energy.force_work_J - energy.ground_damper_J;
    largest = std::max(largest, gain);
    const HeldForceStep::Motion motion = step.motion(start);
    before = x, x += motion.displacement.x(), start.velocity = motion.velocity;
    path += start.path_velocity.x() * kTick_s;
  }
  return largest;
}

// No hand gains energy while b >= K T / 2 + |B|; the limit is 1e-12 J for rounding.
TEST(VirtualWall, IsPassiveWithinTheBoundOfColgateAndSchenkel) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const double b = 0.1 + 0.01 * seed, share = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 0.5 : -0.5;
    const Wall wall{2 * (1 - std::abs(share)) * b / kTick_s, share * b};
    ASSERT_LE(largest_gain_J(wall, b, seed), 1e-12) << seed;
  }
}

TEST(VirtualWall, GivesEnergyOutsideTheBound) {
  int active = 0;
  for (unsigned seed = 0; seed < 50; ++seed) active += largest_gain_J({1000, 0}, 0.1, seed) > 1e-6;
  EXPECT_GT(active, 25);
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

// 0.05 kg with 2 N s/m at 10 kN/m.
TEST(VirtualWall, AStiffWallMakesALightHandUnstable) {
  EXPECT_NEAR(oracle::spectral_radius(closed_loop({10000, 0}, 0.05, 2)), 1.029, 5e-4);
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
}

}  // namespace
}  // namespace remote_touch::device_wall_test
