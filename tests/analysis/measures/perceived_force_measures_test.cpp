#include "analysis/measures/perceived_force_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::perceived_force_measures_test {
namespace {

// One tick every millisecond, and a new frame every frame_ticks ticks.
Trace trace_of(const std::vector<Vec3>& force_N, int frame_ticks) {
  Trace trace;
  for (const Vec3& one : force_N) {
    RenderOutput out;
    out.force_N = one;
    out.frame_index = static_cast<int>(trace.length()) / frame_ticks;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

template <class Force>
Trace trace_along(int ticks, Force&& newtons) {
  std::vector<Vec3> force_N;
  for (int i = 0; i < ticks; ++i) force_N.push_back({0, newtons(i), 0});
  return trace_of(force_N, 10);
}

TEST(PerceivedForce, AJumpExceedsTheFractionOfTheForceBefore) {
  // Every tick has a frame update. The force changes by 5 % (4 to 4.2), 7.1 % (to 4.5) and -11 % (to 4),
  // ends, and begins again. The pair without any force (0 to 0) does not count.
  const Trace trace =
      trace_of({{0, 4, 0}, {0, 4.2, 0}, {0, 4.5, 0}, {0, 4, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.04), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.06), 0.8);
  EXPECT_EQ(felt_jump_fraction(trace, 0.1), 0.6);
  EXPECT_EQ(felt_jump_fraction(trace, 0.2), 0.4);
  EXPECT_EQ(felt_jump_fraction(trace, 1), 0.2);  // a force that begins is above any fraction
}

TEST(PerceivedForce, HasNoJumpBetweenUpdatesOrWithoutForce) {
  EXPECT_EQ(felt_jump_fraction(trace_of({{0, 1, 0}, {0, 9, 0}, {0, 9, 0}, {0, 1, 0}}, 2), 0.2), 0);
  EXPECT_TRUE(std::isnan(felt_jump_fraction(trace_of({{0, 1, 0}, {0, 9, 0}}, 2), 0.2)));
  EXPECT_TRUE(std::isnan(felt_jump_fraction(trace_of({{0, 0, 0}, {0, 0, 0}}, 1), 0.2)));
  EXPECT_TRUE(std::isnan(felt_jump_fraction(Trace(), 0.2)));
}

// A force that turns by an angle a changes by 2 sin(a / 2) times its magnitude.
TEST(PerceivedForce, AForceThatTurnsChanges) {
  const double angle = 0.15;
  const Trace trace = trace_of({{2, 0, 0}, {2 * std::cos(angle), 2 * std::sin(angle), 0}}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) - 1e-9), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) + 1e-9), 0);
}

// The force is exp(a t). A packet is sent when the force has grown by the factor 1 + d, so every ceil(ln(1 +
// d) / a) ticks.
TEST(PerceivedForce, ExponentialForceSendsPacketsAtEqualTimes) {
  const double per_tick = 0.003;
  const Trace trace = trace_along(1000, [&](int i) { return std::exp(per_tick * i); });
  for (const double weber : {0.05, 0.1, 0.2}) {
    const int between = static_cast<int>(std::ceil(std::log1p(weber) / per_tick));
    EXPECT_NEAR(deadband_packets_per_s(trace, weber), 1 + 999 / between, 1e-9) << weber;
  }
}

// If two forces alternate, every tick is a packet if they differ by more than the fraction, else only the
// first.
TEST(PerceivedForce, AForceThatEndsIsSentOnceAndNoMore) {
  const Trace trace = trace_along(100, [](int i) { return i < 50 ? 1.0 : 0.0; });
  EXPECT_NEAR(deadband_packets_per_s(trace, 0.1), 2 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int) { return 0.0; }), 0.1), 1 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int i) { return i % 2 ? 1.0 : 1.3; }), 0.2),
              100 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int i) { return i % 2 ? 1.0 : 1.3; }), 0.31),
              1 / 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(deadband_packets_per_s(trace_along(1, [](int) { return 1.0; }), 0.1)));
}

TEST(PerceivedForce, MeasuresAreInTheTableAtThreeFractions) {
  const Trace trace = trace_along(200, [](int i) { return 1 + 0.01 * (i / 10) * (i % 20 < 10 ? 1 : -1); });
  const auto value = [&](const std::string& name) { return measure_named(name).compute(trace); };
  for (const int percent : {5, 10, 20}) {
    const std::string end = "_" + std::to_string(percent);
    EXPECT_EQ(value("jump_fraction" + end), felt_jump_fraction(trace, percent / 100.)) << percent;
    EXPECT_EQ(value("packet_rate" + end), deadband_packets_per_s(trace, percent / 100.)) << percent;
  }
  EXPECT_GT(value("jump_fraction_5"), value("jump_fraction_20"));
  EXPECT_GT(value("packet_rate_5"), value("packet_rate_20"));
}

}  // namespace
}  // namespace remote_touch::perceived_force_measures_test
