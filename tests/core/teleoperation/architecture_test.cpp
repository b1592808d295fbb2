// The passivity controllers of both ports: energies for random signals, and closed forms of what is removed.
#include "core/teleoperation/architecture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace remote_touch::passivity_control_test {
namespace {

constexpr double kTick_s = 0.001;

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Vec3 vector(double largest) {
    return {number(-largest, largest), number(-largest, largest), number(-largest, largest)};
  }
  bool chance(double p) { return number(0, 1) < p; }

 private:
  std::mt19937 generator_;
};

// The newest sample is not always the one that arrives: each waits for a random number of ticks, and some are
// lost.
class RandomLink {
 public:
  RandomLink(int most_ticks, double loss) : most_ticks_(most_ticks), loss_(loss) {}
  std::pair<Vec3, double> pass(const Vec3& value, double in_J, Random& random) {
    sent_.push_back({value, in_J});
    const std::size_t late = static_cast<std::size_t>(random.number(0, most_ticks_));
    if (!random.chance(loss_) && late < sent_.size()) shown_ = sent_[sent_.size() - 1 - late];
    return shown_;
  }

 private:
  const int most_ticks_;
  const double loss_;
  std::vector<std::pair<Vec3, double>> sent_;
  std::pair<Vec3, double> shown_{Vec3::Zero(), 0};
};

struct Lowest {
  double hand_J = 0, slave_J = 0, channel_J = 0;
  double miscounted_J = 0;  // largest difference of the ports from the balance of the signals
  bool dissipation_falls = false;
};

// Random forces and motions that are known before each tick. The energy of the channel is counted from the
// signals at its ports, apart from the controllers.
Lowest lowest_energies(unsigned seed, int most_ticks, double loss, bool is_controlled) {
  Random random(seed);
  RandomLink commands(most_ticks, loss), forces(most_ticks, loss);
  PassivitySettings settings;
  settings.drift_time_s = seed % 2 ? 0.05 : 0;
  ImpedancePassivityController hand(settings, kTick_s);
  AdmittancePassivityController slave(settings, kTick_s);
  Lowest lowest;
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), force = Vec3::Zero(), command = Vec3::Zero();
  double channel_J = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    velocity = 0.98 * velocity + random.vector(0.02);
    force = 0.95 * force + random.vector(1);
    const auto [shown_W, hand_in_J] = commands.pass(position, hand.energy().credit_J(), random);
    const auto [shown_N, slave_in_J] = forces.pass(force, slave.energy().credit_J(), random);
    const Vec3 displacement = kTick_s * velocity;
    const Vec3 next = is_controlled ? slave.command(shown_W, force, hand_in_J) : shown_W;
    const Vec3 felt = is_controlled ? hand.force(shown_N, displacement, slave_in_J) : shown_N;
    channel_J += force.dot(next - command) - felt.dot(displacement);
    const double dissipated_J = hand.energy().dissipated_J + slave.energy().dissipated_J;
    slave.observe(force), hand.observe(displacement, felt);
    command = next, position += displacement;
    lowest.hand_J = std::min(lowest.hand_J, hand.energy().balance_J());
    lowest.slave_J = std::min(lowest.slave_J, slave.energy().balance_J());
    lowest.channel_J = std::min(lowest.channel_J, channel_J);
    const double counted_J =
        hand.energy().in_J - hand.energy().out_J + slave.energy().in_J - slave.energy().out_J;
    lowest.miscounted_J = std::max(lowest.miscounted_J, is_controlled ? std::abs(counted_J - channel_J) : 0);
    lowest.dissipation_falls |= hand.energy().dissipated_J + slave.energy().dissipated_J < dissipated_J;
  }
  return lowest;
}

// The same signals gain energy without control.
TEST(PassivityControl, NoEnergyFallsBelowZeroWhateverTheDelayAndTheLosses) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const int most_ticks : {1, 20, 300})
      for (const double loss : {0.0, 0.5}) {
        const Lowest lowest = lowest_energies(seed, most_ticks, loss, true);
        EXPECT_GE(lowest.hand_J, -1e-12);
        EXPECT_GE(lowest.slave_J, -1e-12);
        EXPECT_GE(lowest.channel_J, -1e-12);
        EXPECT_LE(lowest.miscounted_J, 1e-12);
        EXPECT_FALSE(lowest.dissipation_falls);
      }
    if (seed < 5) {
      EXPECT_LT(lowest_energies(seed, 300, 0, false).channel_J, -1e-3) << seed;
    }
  }
}

TEST(PassivityControl, ChangesNothingWhileTheEnergySuffices) {
  for (const double response : {0.0, 1e-6}) {
    Random random(7);
    ImpedancePassivityController hand({}, kTick_s, response);
    AdmittancePassivityController slave({}, kTick_s, response * 1e9);
    for (int tick = 0; tick < 1000; ++tick) {
      const Vec3 force = random.vector(5), displacement = random.vector(1e-3), position = random.vector(0.01);
      EXPECT_EQ(hand.force(force, displacement, 1e3), force);
      EXPECT_EQ(slave.command(position, force, 1e3), position);
      hand.observe(displacement, force), slave.observe(force);
    }
    EXPECT_EQ(hand.energy().dissipated_J, 0);
    EXPECT_EQ(slave.energy().dissipated_J, 0);
    EXPECT_GT(hand.energy().out_J, 0);
  }
}

// alpha = missing / (|v|^2 T) and beta = missing / (|f|^2 T), with 1 mJ left of 3 mJ.
TEST(PassivityControl, RemovesWhatIsMissing) {
  ImpedancePassivityController hand({}, kTick_s);
  const Vec3 displacement(1e-3, 0, 0);
  const Vec3 felt = hand.force({3, 4, 0}, displacement, 1e-3);
  EXPECT_NEAR((felt - Vec3(1, 4, 0)).norm(), 0, 1e-12);
  hand.observe(displacement, felt);
  EXPECT_NEAR(hand.energy().balance_J(), 0, 1e-15);
  EXPECT_NEAR(hand.energy().out_J, 1e-3, 1e-15);
  EXPECT_NEAR(hand.energy().dissipated_J, 2e-3, 1e-15);

  AdmittancePassivityController slave({}, kTick_s);
  slave.command(Vec3::Zero(), Vec3::Zero(), 0), slave.observe(Vec3::Zero());
  const Vec3 command = slave.command({3e-3, 4e-3, 0}, {-1, 0, 0}, 1e-3);
  EXPECT_NEAR((command - Vec3(1e-3, 4e-3, 0)).norm(), 0, 1e-15);
  slave.observe({-1, 0, 0});
  EXPECT_NEAR(slave.energy().balance_J(), 0, 1e-15);
  EXPECT_NEAR((slave.drift_m() - Vec3(-2e-3, 0, 0)).norm(), 0, 1e-15);
}

TEST(PassivityControl, AWrongPredictionLeavesABoundedDebtThatIsRepaid) {
  ImpedancePassivityController hand({}, kTick_s);
  const Vec3 expected(1e-4, 0, 0), displacement(2e-4, 0, 0);
  // The expectation is no motion.
  hand.observe(displacement, hand.force({5, 1, 0}, Vec3::Zero(), 0));
  EXPECT_NEAR(hand.energy().balance_J(), -1e-3, 1e-15);
  for (int tick = 0; tick < 2000 && hand.energy().balance_J() < -1e-9; ++tick) {
    const Vec3 felt = hand.force(Vec3::Zero(), expected, 0);
    EXPECT_LE(felt.norm(), 100 * 0.1 + 1e-12);  // the largest damping at 0.1 m/s
    hand.observe(expected, felt);
  }
  EXPECT_GT(hand.energy().balance_J(), -1e-9);
}

TEST(PassivityControl, AnEnergyThatArrivesLateChangesNothing) {
  PortEnergy energy;
  energy.receive(2), energy.receive(1);
  EXPECT_EQ(energy.received_J, 2);
}

// A mass under a constant force and the force of the port, in closed form.
double lowest_balance_of_a_mass(double response, bool uses_response) {
  constexpr double mass_kg = 0.5;
  Random random(3);
  ImpedancePassivityController hand({}, kTick_s, uses_response ? response : 0);
  MotionPrediction prediction(uses_response ? response : 0);
  const Vec3 other(1, -2, 0.5);
  Vec3 velocity = Vec3::Zero();
  double lowest = 0, far_in_J = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const Vec3 delayed = random.vector(tick < 2 ? 0 : 10);  // two ticks for the prediction to begin
    far_in_J += random.chance(0.1) ? random.number(0, 1e-5) : 0;
    const Vec3 expected = uses_response ? prediction.free_displacement() : Vec3(kTick_s * velocity);
    const Vec3 force = hand.force(delayed, expected, far_in_J);
    const Vec3 displacement = kTick_s * velocity + response * (force + other);
    velocity += kTick_s / mass_kg * (force + other);
    hand.observe(displacement, force), prediction.observe(displacement, force);
    lowest = std::min(lowest, hand.energy().balance_J());
  }
  return lowest;
}

TEST(PassivityControl, WithItsResponseAMassNeverOwesEnergy) {
  const double response = kTick_s * kTick_s / (2 * 0.5);
  EXPECT_GE(lowest_balance_of_a_mass(response, true), -1e-12);
  EXPECT_LT(lowest_balance_of_a_mass(response, false), -1e-6);
}

TEST(PassivityControl, NoAllowedSignalIsNearer) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double response = 1e-6 * random.number(0.1, 10), energy_J = random.number(0, 2e-4);
    const Vec3 free = random.vector(1e-4), delayed = random.vector(20);
    ImpedancePassivityController hand({}, kTick_s, response);
    const Vec3 felt = hand.force(delayed, free, energy_J);
    const auto out_J = [&](const Vec3& f) { return f.dot(free + response * f); };
    EXPECT_LE(out_J(felt), energy_J + 1e-15);
    for (int j = 0; j < 200; ++j) {
      const Vec3 tried = j % 2 ? Vec3(felt + random.vector(0.1)) : random.vector(20);
      if (out_J(tried) > energy_J) continue;
      EXPECT_GE((tried - delayed).norm(), (felt - delayed).norm() - 1e-9);
    }
  }
}

TEST(PassivityControl, TheDriftReturnsOnlyIfTheEnergySuffices) {
  // The energy for a fifth of the first step back lets a port without a response go that far.
  for (const double energy_J : {0.0, 1e-5, 1.0})
    for (const double response : {0.0, 10.0}) {
      PassivitySettings settings;
      settings.drift_time_s = 0.02;
      AdmittancePassivityController slave(settings, kTick_s, response);
      const Vec3 force(-1, 0, 0), target(1e-3, 0, 0);
      slave.command(Vec3::Zero(), force, 0), slave.observe(force);
      slave.command(target, force, 0), slave.observe(force);
      EXPECT_NEAR(slave.drift_m().x(), -1e-3, 1e-12);
      for (int tick = 0; tick < 200; ++tick) slave.command(target, force, energy_J), slave.observe(force);
      const double first_m = response == 0 ? std::min(energy_J, 1e-5) : 0.0;
      EXPECT_NEAR(slave.drift_m().x(), energy_J == 1 ? 0 : first_m - 1e-3, 1e-6);
    }
}

}  // namespace
}  // namespace remote_touch::passivity_control_test
