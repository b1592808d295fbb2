// The delay at which the force of a slave makes the loop unstable: the simulation against the roots of the
// linear loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/theory/haptic_loops.h"
#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/teleoperation.h"

namespace remote_touch::delay_onset_test {
namespace {

constexpr double kTick_s = 0.001;

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
  const SlaveScene ground{[](const Vec3& p, double) { return p.y(); },
                          [](const Vec3&, double) { return Vec3(0, 1, 0); }};
  Teleoperation remote(s, {}, kTick_s, ground);
  OperatorSettings person;
  person.mass_kg = loop.mass_kg, person.stiffness_N_per_m = loop.stiffness_N_per_m;
  person.damping_Ns_per_m = loop.damping_Ns_per_m;
  OperatorModel hand(person, kTick_s);
  Wrench wrench;
  double low[2] = {1, 1}, high[2] = {-1, -1};
  for (int tick = 0; tick < 30000; ++tick) {
    const double t = tick * kTick_s;
    const double path = std::max(-0.06, 0.006 - 0.02 * t);  // at rest from 3.3 s on
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
}  // namespace remote_touch::delay_onset_test
