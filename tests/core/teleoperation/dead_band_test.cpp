// The perceptual dead-band: closed forms of the packets that are sent.
#include "core/teleoperation/dead_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/geometry/rotation.h"

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

// --- silence ---

TEST(DeadBand, BreaksItsSilence) {
  for (const double fraction : {0.05, 0.2})
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction, .longest_silence_s = 0.05}, 1000,
                         [](int) { return Vec3(1, 2, 3); }),
              multiples(50, 1000));
}

}  // namespace
}  // namespace remote_touch::dead_band_test
