// The perceptual dead-band: the packets that are sent, against a search in the list of all values, and the
// error of what the receiver shows, with losses, delays and turning tools.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "core/points/noise.h"
#include "core/points/vector.h"
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

TEST(DeadBandSettings, RefusesAFractionThatHidesTheEndOfAForce) {
  EXPECT_EQ(validate(DeadBandSettings{}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 0.999}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 1}),
            "weber_fraction = 1.000000: expected less than 1");
}

// The difference must exceed the threshold: a ramp of one quantum per tick and a threshold of five, all exact
// in binary.
TEST(DeadBand, SendsEverySampleByDefaultAndARampAtEqualSteps) {
  const Signal ramp = [](int k) { return Vec3(0, k * 0x1p-10, 0); };
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10}, 100, ramp), multiples(6, 100));
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10, .predicts = true}, 100, ramp), (std::vector<int>{0, 6}));
  for (const bool predicts : {false, true})
    EXPECT_EQ(sent_ticks({.predicts = predicts}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
}

// For each packet the next one is searched.
std::vector<int> searched_ticks(const DeadBandSettings& s, int ticks, const Signal& signal) {
  std::vector<int> sent{0};
  for (int k = 1; k < ticks; ++k) {
    const int last = sent.back();
    Vec3 shown = signal(last);
    if (s.predicts && sent.size() > 1) {
      const int before = sent[sent.size() - 2];
      shown += double(k - last) / (last - before) * (signal(last) - signal(before));
    }
    if ((signal(k) - shown).norm() > std::max(s.weber_fraction * shown.norm(), s.least)) sent.push_back(k);
  }
  return sent;
}

// Sines, a constant, a force that ends, growth at equal ratios, and a vector that turns by a degree a tick.
TEST(DeadBand, SendsWhatASearchFinds) {
  const auto wave = [](double bias, double rate_hz) {
    return [=](int k) { return Vec3(0, bias + std::sin(2 * std::numbers::pi * rate_hz * k * kTick_s), 0); };
  };
  const std::vector<Signal> signals{wave(0, 1),
                                    wave(3, 2),
                                    wave(1.5, 0.7),
                                    [](int) { return Vec3(1, 2, 3); },
                                    [](int k) { return Vec3(k == 0 ? 2 : 0, 0, 0); },
                                    [](int k) { return Vec3(0, 0, std::pow(1.01, k % 100)); },
                                    [](int k) {
                                      const double angle = k * std::numbers::pi / 180;
                                      return Vec3(3 * std::cos(angle), 0, 3 * std::sin(angle));
                                    }};
  constexpr int kTicks = 3000;
  for (std::size_t i = 0; i < signals.size(); ++i)
    for (const double fraction : {0.0, 0.05, 0.2, 0.999})
      for (const double least : {0.0, 0.3})
        for (const bool predicts : {false, true}) {
          if (fraction == 0 && least == 0) continue;
          const DeadBandSettings s{.weber_fraction = fraction, .least = least, .predicts = predicts};
          const std::vector<int> sent = sent_ticks(s, kTicks, signals[i]);
          EXPECT_EQ(sent, searched_ticks(s, kTicks, signals[i])) << i << " " << fraction << " " << least;
          EXPECT_LT(sent.size(), kTicks / 2u) << i << " " << fraction << " " << least;
        }
}

TEST(DeadBand, PredictsThroughTheLastTwoPackets) {
  DeadBandSender sender({.least = 0.5, .predicts = true});
  EXPECT_EQ(sender.shown(1), std::nullopt);
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

TEST(DeadBand, BreaksItsSilence) {
  for (const double fraction : {0.05, 0.2})
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction, .longest_silence_s = 0.05}, 1000,
                         [](int) { return Vec3(1, 2, 3); }),
              multiples(50, 1000));
}

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

// After a constant delay the receiver shows what the sender showed then, and the dead-band bounds its error.
TEST(DeadBandReceiver, ShowsTheDelayedPoseOfTheSender) {
  constexpr double kReach_m = 0.08;
  const std::vector<TestPose> poses = wandering_poses(5000);
  for (const int delay : {0, 150})
    for (const bool predicts : {false, true}) {
      const DeadBandSettings s{.weber_fraction = 0.1, .least = 0.002, .predicts = predicts};
      DeadBandSender sender(s, kReach_m);
      DeadBandReceiver receiver;
      Channel<DeadBandSample> channel({.delay_s = delay * kTick_s}, {}, NoiseUse::force_channel);
      std::vector<TestPose> shown;
      for (int k = 0; k < 5000; ++k) {
        const double time_s = k * kTick_s;
        if (const auto sample = sender.send(poses[k].position, time_s, poses[k].orientation))
          channel.send(time_s, *sample);
        shown.push_back({sender.shown(time_s).value(), sender.shown_orientation(time_s).value()});
        if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
        ASSERT_EQ(receiver.shown(time_s).has_value(), k >= delay);
        ASSERT_EQ(receiver.shown_orientation(time_s).has_value(), k >= delay);
        if (k < delay) continue;
        const Vec3 at = receiver.shown(time_s).value();
        const Eigen::Quaterniond turned = receiver.shown_orientation(time_s).value();
        const TestPose &then = shown[k - delay], &was = poses[k - delay];
        ASSERT_NEAR((at - then.position).norm(), 0, kRounding) << k;
        ASSERT_NEAR((turned.coeffs() - then.orientation.coeffs()).norm(), 0, kRounding) << k;
        const double error_m =
            (at - was.position).norm() + kReach_m * turned.angularDistance(was.orientation);
        ASSERT_LE(error_m, std::max(0.1 * at.norm(), 0.002) + 1e-9) << k;
      }
      EXPECT_LT(sender.packets(), sender.samples() / 2);
    }
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
