// Energy, stiffness and stability of the architectures in closed loops of a hand, links, a slave and a wall,
// all along one axis. Energies are counted from the signals at the ports, apart from the counters of the
// ends.
#include "core/teleoperation/architecture.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/contact_measures.h"
#include "analysis/trace/force_measures.h"
#include "analysis/trace/trace.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::architecture_test {
namespace {

constexpr double kTick_s = 0.001;

SlaveScene ground() {
  return {[](const Vec3& p, double) { return p.y(); }, [](const Vec3&, double) { return Vec3(0, 1, 0); }};
}

// A hand that moves from `start` to `end`, m above a wall at 0, whose slave meets the wall. The wall may move
// as a sine from wall_from_s on.
struct Plant {
  OperatorSettings hand;
  TeleoperationSettings remote;
  double start = 0.08, end = -0.02, speed = 0.1;
  double wall_m = 0, wall_hz = 0.5, wall_from_s = 1.5;
  double max_force_N = 0;
  NoiseKey key;
};

Plant plant_with(Feedback force, double frequency_hz = 5, double delay_s = 0) {
  Plant p;
  p.remote.feedback.force = force;
  p.remote.slave.natural_frequency_hz = frequency_hz;
  p.remote.commands.channel.delay_s = p.remote.forces.channel.delay_s = delay_s;
  p.remote.hand_mass_kg = p.hand.mass_kg;
  return p;
}

// F acts on the hand at x from this tick to the next one; c, f and y are those at the end of the last tick,
// in which the signals brought entered_J into the channel.
struct Tick {
  double x = 0, F = 0, c = 0, f = 0, y = 0, entered_J = 0;
  ChannelEnergy energy;
  double inside_J() const {
    return energy.hand_in_J - energy.hand_out_J + energy.slave_in_J - energy.slave_out_J;
  }
};

std::vector<Tick> run(const Plant& p, double seconds) {
  const double w = 2 * std::numbers::pi * p.wall_hz, radius_m = p.remote.slave.radius_m;
  const SlaveScene scene{[=](const Vec3& at_W, double t) {
                           const double wall =
                               t < p.wall_from_s ? 0 : p.wall_m * std::sin(w * (t - p.wall_from_s));
                           return at_W.y() - wall + radius_m;
                         },
                         [](const Vec3&, double) { return Vec3(0, 1, 0); }};
  DeviceSettings device;
  device.motors.max_force_N = p.max_force_N;
  SimulatedHand hand(p.hand, device, kTick_s);
  Teleoperation remote(p.remote, p.key, kTick_s, scene);
  std::vector<Tick> ticks;
  Vec3 x_W = Vec3::Zero(), c_W = Vec3::Zero(), exerted_N = Vec3::Zero();
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kTick_s)); ++i) {
    const double t = i * kTick_s;
    const DeviceState at = hand.move({{0, std::max(p.end, p.start - p.speed * t), 0}}, t);
    hand.apply(remote.tick(at, {}, t));
    const SlaveState& slave = remote.state();
    const Vec3 &force_N = slave.force_N, &command_W = slave.command_W;
    const double entered_J = i == 0 ? 0 : force_N.dot(command_W - c_W) - exerted_N.dot(at.position_W - x_W);
    x_W = at.position_W, c_W = command_W, exerted_N = hand.state()->force_N;
    remote.observe_exerted(exerted_N);
    ticks.push_back({x_W.y(), exerted_N.y(), c_W.y(), force_N.y(), slave.position_W.y(), entered_J,
                     slave.energy.value_or(ChannelEnergy{})});
  }
  return ticks;
}

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  double log(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double often(double value) { return uniform(0, 1) < 0.5 ? 0 : value; }

 private:
  std::mt19937 generator_;
};

Plant random_plant(Feedback force, unsigned seed) {
  Random random(seed);
  Plant p = plant_with(force, random.log(1, 20), std::round(random.uniform(0, 200)) * kTick_s);
  p.hand.mass_kg = p.remote.hand_mass_kg = random.uniform(0.1, 1);
  p.hand.stiffness_N_per_m = random.log(50, 1000), p.hand.damping_Ns_per_m = random.log(1, 30);
  SlaveSettings& slave = p.remote.slave;
  slave.mass_kg = random.log(0.5, 5), slave.damping_ratio = random.uniform(0.5, 1.5);
  slave.contact_stiffness_N_per_m = random.log(1e3, 3e4);
  slave.contact_damping_Ns_per_m = random.uniform(0, 20);
  p.start = 0.05, p.end = -random.uniform(0.005, 0.03), p.speed = random.uniform(0.05, 0.3);
  p.wall_m = random.often(random.uniform(0, 0.02)), p.wall_hz = random.uniform(0.2, 1), p.wall_from_s = 1;
  ChannelSettings& link = p.remote.commands.channel;
  link.jitter_s = random.often(std::round(random.uniform(0, 30)) * kTick_s);
  link.loss_probability = random.often(random.uniform(0, 0.5));
  p.remote.forces.channel = link;
  p.max_force_N = 20;
  p.key.seed = seed;
  return p;
}

struct Balance {
  double lowest_J = 0;
  double below_bound_J = 0;  // largest distance of the energy below the bound
  double miscounted_J = 0;   // largest difference of the counters from the sum over the signals
  bool dissipation_falls = false;
};

// The energy that a port gives out in a tick exceeds what its end allowed by at most the work of the signal
// on the error of the prediction, which is known from the signals: at the hand the error of the motion that F
// was predicted to cause, at the slave the change of the force. The channel of waves has no error at the
// slave, whose drive is not among the signals.
Balance balance_of(const Plant& p, const std::vector<Tick>& ticks) {
  const bool is_wave = p.remote.feedback.force == Feedback::wave;
  const double response = kTick_s * kTick_s / (2 * p.hand.mass_kg);
  const auto force_N = [&](std::size_t i, std::size_t ago) { return i >= ago ? ticks[i - ago].F : 0; };
  const auto moved_m = [&](std::size_t i, std::size_t ago) {
    return i >= ago + 1 ? ticks[i - ago].x - ticks[i - ago - 1].x : 0;
  };
  Balance result;
  double energy_J = 0, bound_J = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const double F = force_N(i, 1), d = moved_m(i, 0);
    const double predicted = 2 * moved_m(i, 1) - moved_m(i, 2) + response * (F - force_N(i, 3));
    const double dc = ticks[i].c - ticks[i - 1].c;
    bound_J += std::max(0.0, F * (d - predicted));
    if (!is_wave) bound_J += std::max(0.0, -(ticks[i].f - ticks[i - 1].f) * dc);
    energy_J = is_wave ? ticks[i].inside_J() : energy_J + ticks[i].entered_J;
    result.lowest_J = std::min(result.lowest_J, energy_J);
    result.below_bound_J = std::max(result.below_bound_J, -bound_J - energy_J);
    result.miscounted_J = std::max(result.miscounted_J, std::abs(ticks[i].inside_J() - energy_J));
    result.dissipation_falls |= ticks[i].energy.dissipated_J < ticks[i - 1].energy.dissipated_J;
  }
  return result;
}

// 500 hands, drives, links and walls, at rest or moving, with jitter and losses, and a device of 20 N.
TEST(Architecture, TheEnergyStaysAboveTheBoundOfItsPredictions) {
  for (const Feedback force : {Feedback::passive_slave_force, Feedback::wave}) {
    int violated = 0;
    double lowest_J = 0;
    for (unsigned seed = 0; seed < 500; ++seed) {
      const Plant p = random_plant(force, seed);
      ASSERT_EQ(validate(p.remote.slave), "") << seed;
      const Balance balance = balance_of(p, run(p, 4));
      EXPECT_LE(balance.miscounted_J, 1e-9) << seed;
      EXPECT_FALSE(balance.dissipation_falls) << seed;
      violated += balance.below_bound_J > 1e-9;
      lowest_J = std::min(lowest_J, balance.lowest_J);
    }
    EXPECT_EQ(violated, 0) << static_cast<int>(force);
    EXPECT_GT(lowest_J, -0.1) << static_cast<int>(force);
  }
}

Trace steer_robot(std::vector<std::string> set) {
  for (const char* setting :
       {"feedback.force=passive-slave-force", "fixtures=[]", "command_link.delay_s=0.025",
        "force_link.delay_s=0.025", "slave.natural_frequency_hz=20", "duration_s=8"})
    set.emplace_back(setting);
  return simulate(Experiment::load("steer-robot", set), {});
}

// A slave of 20 Hz and 25 ms each way over a wall that rises and falls by 2 cm.
TEST(Architecture, PassivityControlKeepsTheEnergyAboveZeroBehindAnyDevice) {
  for (const int limit_N : {0, 3, 5, 20}) {
    const Trace trace = steer_robot({"device.max_force_N=" + std::to_string(limit_N)});
    double energy_J = 0, lowest_J = 0, given_J = 0;
    for (std::size_t i = 1; i < trace.length(); ++i) {
      const double at_hand_J =
          -trace.device_force_N[i - 1].dot(trace.hip_position_m[i] - trace.hip_position_m[i - 1]);
      energy_J += at_hand_J +
                  trace.slave_force_N[i].dot(trace.received_command_m[i] - trace.received_command_m[i - 1]);
      lowest_J = std::min(lowest_J, energy_J), given_J += std::max(0.0, at_hand_J);
      ASSERT_LE(trace.hand_energy_in_J[i], given_J + 1e-12) << "the credit that the hand sends, tick " << i;
    }
    EXPECT_GT(lowest_J, -0.005) << limit_N;
    EXPECT_NEAR(min_channel_energy_J(trace), lowest_J, 1e-9);
    EXPECT_GT(dissipated_energy_J(trace), 0);
    if (limit_N == 0) {
      EXPECT_LT(max_slave_force_N(trace), 70);
    }
  }
}

// The hand at rest on the wall, and the force of the device over its depth.
double felt_stiffness(const Plant& p) {
  const std::vector<Tick> ticks = run(p, 6);
  double force = 0, depth = 0;
  for (std::size_t i = ticks.size() * 7 / 8; i < ticks.size(); ++i) force += ticks[i].F, depth -= ticks[i].x;
  return force / depth;
}

TEST(Architecture, AWaveIsAsSoftAsItsDelay) {
  for (const double impedance : {20.0, 0.0})
    for (const double delay_s : {0.0, 0.025, 0.1}) {
      Plant p = plant_with(Feedback::wave, 5, delay_s);
      p.remote.feedback.impedance_Ns_per_m = impedance;
      const double still = felt_stiffness_N_per_m(p.remote.slave, p.remote.feedback);
      const double b = wave_impedance_Ns_per_m(p.remote.feedback, p.remote.slave);
      const double expected = 1 / (1 / still + (delay_s + kTick_s) / b);
      EXPECT_NEAR(felt_stiffness(p) / expected, 1, 0.01) << impedance << " " << delay_s;
    }
}

TEST(Architecture, PositionPositionFeelsItsSpringAndTheContact) {
  for (const double frequency_hz : {2.0, 5.0, 20.0}) {
    Plant p = plant_with(Feedback::position_position, frequency_hz, 0.025);
    const double expected = felt_stiffness_N_per_m(p.remote.slave, p.remote.feedback);
    EXPECT_NEAR(felt_stiffness(p) / expected, 1, 0.01) << frequency_hz;
    p.remote.feedback.stiffness_N_per_m = 300;
    EXPECT_NEAR(felt_stiffness(p) / expected, 0.5, 0.01) << frequency_hz;
  }
}

// The slave starts where the hand does, so nothing pulls at the hand before the first packet has arrived.
TEST(Architecture, PositionPositionStartsWithoutAJump) {
  const std::vector<Tick> ticks = run(plant_with(Feedback::position_position, 5, 0.1), 6);
  for (std::size_t i = 1; i < 500; ++i) EXPECT_NEAR(ticks[i].F, ticks[i - 1].F, 0.1) << i;
  for (const Tick& tick : ticks) EXPECT_GT(tick.inside_J(), -1e-6);
}

// Packets that are lost, or come in another order, leave the slave where the hand is.
TEST(Architecture, LostWavesLeaveNoErrorOfThePosition) {
  Plant p = plant_with(Feedback::wave, 5, 0.025);
  p.end = 0.02, p.remote.feedback.impedance_Ns_per_m = 20;
  for (const double loss : {0.0, 0.2, 0.5}) {
    for (LinkSettings* link : {&p.remote.commands, &p.remote.forces})
      link->channel.loss_probability = loss, link->channel.jitter_s = loss > 0 ? 0.02 : 0;
    const Tick last = run(p, 6).back();
    EXPECT_NEAR(last.y, last.x, 1e-3) << loss;
    EXPECT_NEAR(last.F, 0, 0.1) << loss;
  }
}

// A hand that is held still sends back what comes. Once it misses ticks, as it may live: the waves that
// follow pay for it.
TEST(Architecture, WavesOfMissedTicksHaveNoEnergyOfTheirOwn) {
  const Plant p = plant_with(Feedback::wave);
  const Ends ends = make_ends(p.remote.feedback, p.remote.slave, p.hand.mass_kg, kTick_s);
  HandEnd::Arrival arrival;
  arrival.has_come = true;
  Vec3 force_N = Vec3::Zero();
  for (int i = 0; i < 100; ++i) {
    ends.hand->observe({Vec3::Zero(), Vec3::Zero(), force_N, i == 10 ? 20.0 : 1.0});
    arrival.message.wave.add(Vec3(1, 0, 0), kTick_s);
    force_N = ends.hand->force(arrival);
  }
  EXPECT_LE(ends.hand->message().wave.energy_J, arrival.message.wave.energy_J);
}

// Some ticks are missed, so that the slave moves through them at once. Only a slave that sends its force may
// have a tool.
TEST(Architecture, AllocatesNothingInATick) {
  for (const auto& [force, has_tool] : {std::pair(Feedback::slave_force, false),
                                        {Feedback::slave_force, true},
                                        {Feedback::passive_slave_force, false},
                                        {Feedback::position_position, false},
                                        {Feedback::wave, false}}) {
    TeleoperationSettings s = plant_with(force, 5, 0.02).remote;
    if (has_tool) s.tool = SlaveTool{{{0.03, -0.01, 0}}, {1e-4}, 0.02, 0.04};
    Teleoperation remote(s, {}, kTick_s, ground());
    const auto move = [&](int i) { remote.tick({{0, 0.02 - 1e-4 * i, 0}}, {}, i * kTick_s); };
    for (int i = 0; i < 100; ++i) move(i);
    const std::size_t before = allocation_count();
    for (int i = 100; i < 300; ++i)
      if (i % 100 < 90) move(i);
    EXPECT_EQ(allocation_count(), before) << static_cast<int>(force) << " " << has_tool;
    EXPECT_GT(remote.state().peak_force_N, 0.1) << static_cast<int>(force);
  }
}

// The delay at which the force of a slave makes the loop unstable: the simulation against the roots of the
// linear loop.

// The force is the mean of a tick (one hold) and held for a tick (one), and the command moves the slave
// linearly over the next tick (two).
constexpr int kHolds = 4;

// Returns the ratio of the swings of the hand in two successive windows, with a round trip of so many ticks.
// The hand presses, so that the contact stays closed while the swing is small.
double growth(const PositionForceLoop& loop, int round_trip_ticks) {
  TeleoperationSettings s;
  s.slave.mass_kg = loop.slave_mass_kg, s.slave.natural_frequency_hz = loop.slave_natural_frequency_hz;
  s.slave.damping_ratio = loop.slave_damping_ratio;
  s.slave.contact_stiffness_N_per_m = loop.environment_stiffness_N_per_m;
  s.slave.contact_damping_Ns_per_m = loop.environment_damping_Ns_per_m;
  s.commands.channel.delay_s = round_trip_ticks / 2 * kTick_s;
  s.forces.channel.delay_s = (round_trip_ticks - round_trip_ticks / 2) * kTick_s;
  s.feedback.force = Feedback::slave_force, s.feedback.gain = loop.feedback_gain;
  Teleoperation remote(s, {}, kTick_s, ground());
  OperatorSettings person;
  person.mass_kg = loop.mass_kg, person.stiffness_N_per_m = loop.stiffness_N_per_m;
  person.damping_Ns_per_m = loop.damping_Ns_per_m;
  OperatorModel hand(person, kTick_s);
  Wrench wrench;
  double low[2] = {1, 1}, high[2] = {-1, -1};
  for (int tick = 0; tick < 30000; ++tick) {
    const double t = tick * kTick_s;
    const double path = std::max(-0.06, 0.006 - 0.02 * t);  // the hand rests from 3.3 s on
    const DeviceState device = hand.move({{0, path, 0}}, t, wrench);
    wrench = remote.tick(device, {}, t);
    const int window = tick >= 6000 && tick < 12000 ? 0 : tick >= 12000 && tick < 18000 ? 1 : -1;
    if (window < 0) continue;
    low[window] = std::min(low[window], device.position_W.y());
    high[window] = std::max(high[window], device.position_W.y());
  }
  return (high[1] - low[1]) / (high[0] - low[0]);
}

struct Case {
  double gain, environment_N_per_m, damping_Ns_per_m;
};

TEST(DelayOnset, IsThatOfTheLinearLoopWithin5Percent) {
  for (const Case& c : {Case{0.1, 3000, 8}, Case{0.2, 1000, 8}, Case{0.4, 3000, 40}}) {
    PositionForceLoop loop;
    loop.stiffness_N_per_m = 300, loop.damping_Ns_per_m = c.damping_Ns_per_m;
    loop.environment_stiffness_N_per_m = c.environment_N_per_m, loop.feedback_gain = c.gain;
    const double onset_s = delay_onset(loop).round_trip_s - held_round_trip(0, kTick_s, kHolds);
    ASSERT_GT(onset_s, 0.04) << c.gain;
    const int below = static_cast<int>(std::floor(0.95 * onset_s / kTick_s));
    const int above = static_cast<int>(std::ceil(1.05 * onset_s / kTick_s));
    EXPECT_LT(growth(loop, below), 1) << c.gain << " " << onset_s;
    EXPECT_GT(growth(loop, above), 1) << c.gain << " " << onset_s;
  }
}

}  // namespace
}  // namespace remote_touch::architecture_test
