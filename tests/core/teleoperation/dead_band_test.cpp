// The perceptual dead-band: closed forms of the number of packets, and the bound of the shown error.
#include "core/teleoperation/dead_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/geometry/rotation.h"
#include "core/teleoperation/channel.h"

namespace remote_touch::dead_band_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kRounding = 1e-12;

using Signal = std::function<Vec3(int tick)>;

// Returns the ticks at which a packet is sent.
std::vector<int> sent_ticks(const DeadBandSettings& s, int ticks, const Signal& signal) {
  DeadBandSender sender(s);
  std::vector<int> sent;
  for (int k = 0; k < ticks; ++k)
    if (sender.send(signal(k), k * kTick_s)) sent.push_back(k);
  EXPECT_EQ(sender.samples(), static_cast<std::uint64_t>(ticks));
  EXPECT_EQ(sender.packets(), sent.size());
  return sent;
}

std::vector<int> multiples(int step, int end) {
  std::vector<int> list;
  for (int k = 0; k < end; k += step) list.push_back(k);
  return list;
}

// --- settings ---

TEST(DeadBandSettings, RefusesAFractionThatHidesTheEndOfAForce) {
  EXPECT_EQ(validate(DeadBandSettings{}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 0.999}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 1}),
            "weber_fraction = 1.000000: expected less than 1");
  const Signal off = [](int k) { return Vec3(k == 0 ? 2 : 0, 0, 0); };
  EXPECT_EQ(sent_ticks({.weber_fraction = 0.999}, 5, off), (std::vector<int>{0, 1}));
}

TEST(DeadBandSettings, HasARangeForEveryNumber) {
  DeadBandSettings s;
  std::vector<std::string> names;
  for (const Parameter& p : parameters(s)) {
    names.push_back(p.name);
    if (const auto* const* number = std::get_if<double*>(&p.value)) {
      EXPECT_EQ(p.low, **number) << p.name;
      EXPECT_LT(p.low, p.high) << p.name;
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"weber_fraction", "least", "predicts", "longest_silence_s"}));
}

// --- hold ---

TEST(DeadBand, SendsEverySampleByDefault) {
  EXPECT_EQ(sent_ticks({}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
  EXPECT_EQ(sent_ticks({.predicts = true}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
}

TEST(DeadBand, SendsNothingAfterTheFirstSampleOfAConstant) {
  for (const Vec3& value : {Vec3(0, 0, 0), Vec3(1, 2, 3)})
    for (const bool predicts : {false, true}) {
      EXPECT_EQ(sent_ticks({.weber_fraction = 0.1, .predicts = predicts}, 100, [&](int) { return value; }),
                (std::vector<int>{0}));
      EXPECT_EQ(sent_ticks({.least = 0.1, .predicts = predicts}, 100, [&](int) { return value; }),
                (std::vector<int>{0}));
    }
}

// The difference must exceed the threshold: a ramp of one quantum per tick and a threshold of five, all exact
// in binary.
TEST(DeadBand, SendsARampAtEqualSteps) {
  const Signal ramp = [](int k) { return Vec3(0, k * 0x1p-10, 0); };
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10}, 100, ramp), multiples(6, 100));
}

// A Weber fraction gives equal ratios: 1.01^9 < 1.1 < 1.01^10.
TEST(DeadBand, SendsGrowthAtEqualRatios) {
  const Signal growth = [](int k) { return Vec3(0, 0, std::pow(1.01, k)); };
  EXPECT_EQ(sent_ticks({.weber_fraction = 0.1}, 200, growth), multiples(10, 200));
  // Below 3 the least difference of 0.3 decides, above it the fraction.
  int sent = 0;
  for (const int k : sent_ticks({.weber_fraction = 0.1, .least = 0.3}, 200, growth)) {
    if (k > 0) {
      const double from = std::pow(1.01, sent), to = std::pow(1.01, k), before = std::pow(1.01, k - 1);
      EXPECT_GT(to - from, std::max(0.3, 0.1 * from));
      EXPECT_LE(before - from, std::max(0.3, 0.1 * from));
    }
    sent = k;
  }
}

// A vector that turns by 1 degree per tick leaves the ball when its chord 2 sin(a / 2) exceeds the fraction.
TEST(DeadBand, SendsATurningVectorByItsChord) {
  const Signal turning = [](int k) {
    const double angle = k * std::numbers::pi / 180;
    return Vec3(7 * std::cos(angle), 0, 7 * std::sin(angle));
  };
  for (const double fraction : {0.05, 0.1, 0.2}) {
    const double degrees = 2 * std::asin(fraction / 2) * 180 / std::numbers::pi;
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction}, 360, turning),
              multiples(static_cast<int>(std::floor(degrees)) + 1, 360));
  }
}

// --- prediction ---

TEST(DeadBand, SendsARampByTwoPacketsIfItPredicts) {
  const Signal ramp = [](int k) { return Vec3(1 + 0.002 * k, -0.001 * k, 3); };
  const DeadBandSettings holds{.weber_fraction = 0.05}, predicts{.weber_fraction = 0.05, .predicts = true};
  EXPECT_EQ(sent_ticks(predicts, 5000, ramp).size(), 2u);
  EXPECT_GT(sent_ticks(holds, 5000, ramp).size(), 20u);
}

TEST(DeadBand, PredictsThroughTheLastTwoPackets) {
  DeadBandSender sender({.least = 0.5, .predicts = true});
  const auto first = sender.send({1, 1, 1}, 2.0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->slope_per_s, Vec3::Zero());
  EXPECT_FALSE(sender.send({1, 1.4, 1}, 2.1));
  const auto second = sender.send({1, 2, 1}, 2.25);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->slope_per_s, Vec3(0, 4, 0));
  EXPECT_EQ(second->sent_s, 2.25);
  EXPECT_EQ(sender.shown(2.5), Vec3(1, 3, 1));
  EXPECT_FALSE(sender.send({1, 3.4, 1}, 2.5));
  EXPECT_TRUE(sender.send({1, 3.6, 1}, 2.5));
  EXPECT_EQ(sender.shown(2.5), Vec3(1, 3.6, 1));
}

TEST(DeadBand, PredictsNothingFromTwoPacketsAtTheSameTime) {
  DeadBandSender sender({.predicts = true});
  sender.send({1, 0, 0}, 1);
  const auto sample = sender.send({2, 0, 0}, 1);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->slope_per_s, Vec3::Zero());
}

// --- a sine against plain loops ---

struct Wave {
  double bias, amplitude, rate_hz;
  double at(int k) const { return bias + amplitude * std::sin(2 * std::numbers::pi * rate_hz * k * kTick_s); }
};

// Counts in one dimension from the list of all values: for each packet it searches the next one.
int searched_packets(const Wave& wave, double fraction, bool predicts, int ticks) {
  std::vector<int> sent{0};
  for (;;) {
    const int last = sent.back();
    double slope_per_tick = 0;
    if (predicts && sent.size() > 1) {
      const int before = sent[sent.size() - 2];
      slope_per_tick = (wave.at(last) - wave.at(before)) / (last - before);
    }
    int next = last + 1;
    for (; next < ticks; ++next) {
      const double shown = wave.at(last) + slope_per_tick * (next - last);
      if (std::fabs(wave.at(next) - shown) > fraction * std::fabs(shown)) break;
    }
    if (next >= ticks) return static_cast<int>(sent.size());
    sent.push_back(next);
  }
}

TEST(DeadBand, SendsASineAsOftenAsASearchFinds) {
  constexpr int kTicks = 10000;
  for (const Wave& wave : {Wave{0, 1, 1}, Wave{3, 1, 2}, Wave{1.5, 1, 0.7}})
    for (const double fraction : {0.05, 0.1, 0.2})
      for (const bool predicts : {false, true}) {
        const DeadBandSettings s{.weber_fraction = fraction, .predicts = predicts};
        const auto sent = sent_ticks(s, kTicks, [&](int k) { return Vec3(0, wave.at(k), 0); });
        const int want = searched_packets(wave, fraction, predicts, kTicks);
        EXPECT_EQ(static_cast<int>(sent.size()), want) << wave.bias << " " << fraction << " " << predicts;
        EXPECT_LT(want, kTicks / 4);
      }
}

// Holding a positive sine needs a packet for each change of the logarithm by ln(1 + k) or
// ln(1 / (1 - k)); both ends of a half wave and the sampling may cost one packet each.
TEST(DeadBand, HoldsAPositiveSineByTheLogarithm) {
  const Wave wave{3, 1, 0.1};
  constexpr int kTicks = 10001;  // one period: from 3 up to 4, down to 2 and up to 3
  const auto sent =
      sent_ticks({.weber_fraction = 0.01}, kTicks, [&](int k) { return Vec3(wave.at(k), 0, 0); });
  const double up = std::log(4.0 / 3) + std::log(3.0 / 2), down = std::log(4.0 / 2);
  const double want = up / std::log(1.01) + down / -std::log(0.99);
  EXPECT_NEAR(static_cast<double>(sent.size()), want, 5);
}

// --- what is shown ---

// A force that wanders, and stops at times.
std::vector<Vec3> wandering(int ticks) {
  std::vector<Vec3> values;
  Vec3 value(1, 0, 0), speed = Vec3::Zero();
  for (int k = 0; k < ticks; ++k) {
    const auto u = uniforms(noise_stream({}, NoiseUse::motion, 0), static_cast<std::uint32_t>(k));
    speed = 0.99 * speed + 0.5 * Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
    if (k % 1000 < 800) value += kTick_s * speed * 10;
    values.push_back(k % 3000 < 100 ? Vec3(Vec3::Zero()) : value);
  }
  return values;
}

TEST(DeadBand, BoundsTheErrorAtTheSender) {
  const std::vector<Vec3> force = wandering(20000);
  for (const double fraction : {0.0, 0.05, 0.2})
    for (const double least : {0.0, 0.1})
      for (const bool predicts : {false, true}) {
        DeadBandSender sender({fraction, least, predicts});
        for (int k = 0; k < 20000; ++k) {
          const bool is_sent = sender.send(force[k], k * kTick_s).has_value();
          const Vec3 shown = sender.shown(k * kTick_s).value();
          ASSERT_LE((force[k] - shown).norm(), std::max(fraction * shown.norm(), least)) << k;
          ASSERT_TRUE(!is_sent || shown == force[k]) << k;
        }
        EXPECT_TRUE(fraction == 0 || sender.packets() < sender.samples() / 2) << sender.packets();
      }
}

TEST(DeadBandReceiver, ShowsNothingBeforeTheFirstSample) {
  EXPECT_EQ(DeadBandReceiver().shown(1), std::nullopt);
  EXPECT_EQ(DeadBandSender({}).shown(1), std::nullopt);
}

TEST(DeadBandReceiver, ShowsTheValueOfTheSenderWithoutADelay) {
  const std::vector<Vec3> force = wandering(5000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.weber_fraction = 0.1, .predicts = predicts});
    DeadBandReceiver receiver;
    Channel<DeadBandSample> channel({}, {}, NoiseUse::force_channel);
    for (int k = 0; k < 5000; ++k) {
      const double time_s = k * kTick_s;
      if (const auto sample = sender.send(force[k], time_s)) channel.send(time_s, *sample);
      if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
      ASSERT_EQ(receiver.shown(time_s), sender.shown(time_s)) << k;
    }
  }
}

// After a constant delay the receiver shows what the sender showed then, and the dead-band bounds its error.
TEST(DeadBandReceiver, ShowsTheDelayedValueOfTheSender) {
  constexpr int kDelay = 150;
  const std::vector<Vec3> force = wandering(5000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.weber_fraction = 0.1, .predicts = predicts});
    DeadBandReceiver receiver;
    Channel<DeadBandSample> channel({.delay_s = kDelay * kTick_s}, {}, NoiseUse::force_channel);
    std::vector<Vec3> shown;
    for (int k = 0; k < 5000; ++k) {
      const double time_s = k * kTick_s;
      if (const auto sample = sender.send(force[k], time_s)) channel.send(time_s, *sample);
      shown.push_back(sender.shown(time_s).value());
      if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
      ASSERT_EQ(receiver.shown(time_s).has_value(), k >= kDelay);
      if (k < kDelay) continue;
      const Vec3 got = receiver.shown(time_s).value();
      ASSERT_NEAR((got - shown[k - kDelay]).norm(), 0, kRounding) << k;
      ASSERT_LE((got - force[k - kDelay]).norm(), 0.1 * got.norm() + kRounding);
    }
  }
}

// A lost packet has no effect after the next one has arrived.
TEST(DeadBandReceiver, NeedsNoEarlierPacket) {
  DeadBandSender sender({.weber_fraction = 0.05, .predicts = true});
  DeadBandReceiver complete, lossy;
  int packets = 0;
  for (int k = 0; k < 2000; ++k) {
    const double time_s = k * kTick_s;
    const auto sample = sender.send({2 + std::sin(5 * time_s), 0, 0}, time_s);
    if (!sample) continue;
    complete.receive(*sample, time_s);
    if (packets++ % 2 == 0) continue;
    lossy.receive(*sample, time_s);
    EXPECT_EQ(lossy.shown(time_s + 0.01), complete.shown(time_s + 0.01));
  }
  EXPECT_GT(packets, 4);
}

// --- poses ---

struct TestPose {
  Vec3 position;
  Eigen::Quaterniond orientation;
};

// A tool that wanders and turns; at times it only turns.
std::vector<TestPose> wandering_poses(int ticks) {
  const std::vector<Vec3> position = wandering(ticks);
  std::vector<TestPose> poses;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Vec3 turn = Vec3::Zero();
  for (int k = 0; k < ticks; ++k) {
    const auto u = uniforms(noise_stream({}, NoiseUse::motion, 1), static_cast<std::uint32_t>(k));
    turn = 0.99 * turn + 1e-4 * Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
    q = (rotation(turn) * q).normalized();
    poses.push_back({0.1 * position[k % 2000 < 1000 ? k : k - k % 1000], q});
  }
  return poses;
}

// The oracle moves the points of a tool by both poses. The reach is the distance of the farthest one.
TEST(DeadBand, BoundsTheErrorAtEveryPointOfATool) {
  const std::vector<Vec3> points{{0.08, 0, 0}, {0, -0.06, 0.01}, {-0.02, 0.03, -0.07}, {0, 0, 0.05}};
  const std::vector<TestPose> poses = wandering_poses(20000);
  for (const double least_m : {0.0005, 0.005})
    for (const bool predicts : {false, true}) {
      DeadBandSender sender({.least = least_m, .predicts = predicts}, 0.08);
      DeadBandReceiver receiver;
      double largest_m = 0;
      for (int k = 0; k < 20000; ++k) {
        const TestPose& pose = poses[k];
        const double time_s = k * kTick_s;
        if (const auto sample = sender.send(pose.position, time_s, pose.orientation))
          receiver.receive(*sample, time_s);
        const Vec3 at = receiver.shown(time_s).value();
        const Eigen::Quaterniond turned = receiver.shown_orientation(time_s).value();
        for (const Vec3& p : points)
          largest_m = std::max(largest_m, (at + turned * p - pose.position - pose.orientation * p).norm());
      }
      EXPECT_LE(largest_m, least_m + kRounding);
      EXPECT_GT(largest_m, 0.5 * least_m);  // the bound is not far above
      EXPECT_LT(sender.packets(), sender.samples() / 2) << least_m << predicts;
    }
}

// 1 mrad in a tick moves the farthest point by 0.1 mm.
TEST(DeadBand, SendsARotationAloneByTheArcOfTheFarthestPoint) {
  const auto sent = [](double reach_m, bool predicts) {
    DeadBandSender sender({.least = 5.5e-4, .predicts = predicts}, reach_m);
    std::vector<int> ticks;
    for (int k = 0; k < 100; ++k)
      if (sender.send({1, 2, 3}, k * kTick_s, rotation({0, 1e-3 * k, 0}))) ticks.push_back(k);
    return ticks;
  };
  EXPECT_EQ(sent(0.1, false), multiples(6, 100));
  EXPECT_EQ(sent(0.1, true), (std::vector<int>{0, 6}));
  EXPECT_EQ(sent(0, false), (std::vector<int>{0}));
}

TEST(DeadBandReceiver, ShowsTheOrientationOfTheSender) {
  const std::vector<TestPose> poses = wandering_poses(3000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.least = 0.002, .predicts = predicts}, 0.08);
    DeadBandReceiver receiver;
    EXPECT_EQ(sender.shown_orientation(0).has_value(), false);
    EXPECT_EQ(receiver.shown_orientation(0).has_value(), false);
    for (int k = 0; k < 3000; ++k) {
      const double time_s = k * kTick_s;
      const auto sample = sender.send(poses[k].position, time_s, poses[k].orientation);
      if (sample) receiver.receive(*sample, time_s);
      ASSERT_TRUE(!sample || sample->orientation_W.coeffs() == poses[k].orientation.coeffs()) << k;
      const Eigen::Quaterniond got = receiver.shown_orientation(time_s).value();
      ASSERT_EQ(got.coeffs(), sender.shown_orientation(time_s).value().coeffs()) << k;
      ASSERT_NEAR(got.norm(), 1, kRounding);
    }
  }
}

// --- silence ---

TEST(DeadBand, BreaksItsSilence) {
  for (const double fraction : {0.05, 0.2})
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction, .longest_silence_s = 0.05}, 1000,
                         [](int) { return Vec3(1, 2, 3); }),
              multiples(50, 1000));
}

// The packet that ends a ramp is lost. The prediction then goes on, until the silence is broken.
TEST(DeadBand, BoundsTheEffectOfALossByItsSilence) {
  for (const double silence_s : {0.0, 0.1}) {
    DeadBandSender sender({.weber_fraction = 0.05, .predicts = true, .longest_silence_s = silence_s});
    DeadBandReceiver receiver;
    double shown = 0, sent_after = 0;
    for (int k = 0; k < 1000; ++k) {
      const double time_s = k * kTick_s;
      const auto sample = sender.send({std::min(1 + 0.01 * k, 5.0), 0, 0}, time_s);
      const bool is_lost = k > 400 && sent_after < 2;  // the value that ends the ramp, and its slope
      if (sample && k > 400) ++sent_after;
      if (sample && !is_lost) receiver.receive(*sample, time_s);
      shown = receiver.shown(time_s).value().x();
    }
    if (silence_s > 0)
      EXPECT_NEAR(shown, 5, 0.05 * 5);
    else
      EXPECT_GT(shown, 10) << "no packet follows";
  }
}

}  // namespace
}  // namespace remote_touch::dead_band_test
