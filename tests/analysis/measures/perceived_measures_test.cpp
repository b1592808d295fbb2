// Weber fractions, apparent friction and ripple: traces whose values follow from a formula.
#include "analysis/measures/perceived_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::perceived_measures_test {
namespace {

constexpr double kTick_s = 0.001;

// One tick every millisecond, and a new frame every frame_ticks ticks.
Trace pushed(const std::vector<Vec3>& force_N, int frame_ticks) {
  Trace trace;
  for (const Vec3& one : force_N) {
    RenderOutput out;
    out.force_N = one;
    out.frame_index = static_cast<int>(trace.length()) / frame_ticks;
    trace.append(kTick_s * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

template <class Force>
Trace pushed_along(int ticks, Force&& newtons) {
  std::vector<Vec3> force_N;
  for (int i = 0; i < ticks; ++i) force_N.push_back(newtons(i));
  return pushed(force_N, 33);
}

TEST(WeberFraction, IsTheLargestChangeRelativeToTheForceBefore) {
  // Updates at ticks 2 and 4: 4 to 5 N (0.25) and 5 to 4 N (0.2). The largest other change is 4 to 4.4 N
  // (0.1).
  const Trace trace = pushed({{0, 4, 0}, {0, 4, 0}, {0, 5, 0}, {0, 5, 0}, {0, 4, 0}, {0, 4.4, 0}}, 2);
  EXPECT_NEAR(max_relative_jump(trace), 0.25, 1e-15);
  EXPECT_NEAR(max_relative_change(trace), 0.1, 1e-15);
}

// The force grows by 0.5 N in each tick, and by 0.3 N more with the frame at tick 3.
TEST(WeberFraction, OfAJumpIsWithoutTheChangeOfAMovingHand) {
  const std::vector<Vec3> force_N = {{0, 1, 0}, {0, 1.5, 0}, {0, 2, 0}, {0, 2.8, 0}, {0, 3.3, 0}};
  EXPECT_NEAR(max_relative_jump(pushed(force_N, 3)), 0.3 / 2, 1e-12);
  EXPECT_NEAR(max_relative_change(pushed(force_N, 3)), 0.5, 1e-12);
  EXPECT_NEAR(max_relative_jump(pushed({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 2)), 1, 1e-12);  // a force begins
}

TEST(WeberFraction, CountsTheEndOfAForceAndATurnButNotItsBegin) {
  EXPECT_EQ(max_relative_jump(pushed({{0, 3, 0}, {0, 0, 0}, {0, 9, 0}}, 1)), 1);
  EXPECT_NEAR(max_relative_jump(pushed({{2, 0, 0}, {0, 2, 0}}, 1)), std::sqrt(2.0), 1e-15);
}

TEST(WeberFraction, NeedsTheLeastForceBeforeTheChange) {
  EXPECT_TRUE(std::isnan(max_relative_jump(pushed({{0, 0.99 * kMinWeberForce_N, 0}, {0, 5, 0}}, 1))));
  EXPECT_NEAR(max_relative_jump(pushed({{0, kMinWeberForce_N, 0}, {0, 5, 0}}, 1)), 49, 1e-12);
  EXPECT_TRUE(std::isnan(max_relative_jump(pushed({{0, 1, 0}, {0, 2, 0}}, 2))));  // there is no update
  EXPECT_TRUE(std::isnan(max_relative_change(pushed({{0, 1, 0}, {0, 2, 0}}, 1))));
  EXPECT_TRUE(std::isnan(max_relative_jump(Trace())));
}

struct Slide {
  Vec3 hip_W, force_N, normal;
  ContactState state = ContactState::contact;
};

Trace slid(const std::vector<Slide>& ticks) {
  Trace trace;
  for (const Slide& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N, out.state = tick.state;
    DeviceState device;
    device.position_W = tick.hip_W;
    trace.append(kTick_s * static_cast<double>(trace.length()), device, out, {.normal = tick.normal});
  }
  return trace;
}

// Coulomb friction on a leaning plane: the hand wanders along it, and in and out of it.
TEST(ApparentFriction, IsTheCoefficientOfCoulombFriction) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  const Eigen::Quaterniond lean = rotation(Vec3(0.3, -0.7, 0.5));
  for (const double mu : {0.0, 0.15, 0.8, -0.1}) {
    std::vector<Slide> ticks;
    Vec3 hip(0.1, 0, 0.2);
    for (int i = 0; i < 200; ++i) {
      const Vec3 step(1e-4 * gauss(random), 0, 1e-4 * gauss(random));
      hip += step + Vec3(0, 1e-5 * gauss(random), 0);
      const double newtons = 1 + std::abs(gauss(random));
      const Vec3 force_N = newtons * (Vec3::UnitY() - mu * step.normalized());
      ticks.push_back({lean * hip, lean * force_N, lean * Vec3::UnitY()});
    }
    EXPECT_NEAR(apparent_friction(slid(ticks)), mu, 1e-9) << mu;
  }
}

// The force tilts by 0.2 to the left and right of the path in turn: the hand feels no friction.
TEST(ApparentFriction, IsNoneIfTheForceTiltsAcrossOrToBothSides) {
  std::vector<Slide> across, both;
  for (int i = 0; i < 101; ++i) {
    const double side = i % 2 ? 0.2 : -0.2;
    across.push_back({{1e-4 * i, 0, 0}, {0, 1, side}, Vec3::UnitY()});
    both.push_back({{1e-4 * i, 0, 0}, {side, 1, 0}, Vec3::UnitY()});
  }
  EXPECT_NEAR(apparent_friction(slid(across)), 0, 1e-12);
  EXPECT_NEAR(apparent_friction(slid(both)), 0, 1e-12);
}

TEST(ApparentFriction, UsesTicksThatSlideInContact) {
  const Vec3 up = Vec3::UnitY(), unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  const double slow_m = 0.9 * kSliding_m_per_s * kTick_s, fast_m = 1.1 * kSliding_m_per_s * kTick_s;
  const Trace trace = slid({{{0, 0, 0}, {-9, 1, 0}, up},                      // has no tick before it
                            {{slow_m, 0, 0}, {-9, 1, 0}, up},                 // too slow
                            {{slow_m + fast_m, 0, 0}, {-0.5, 1, 0}, up},      // counts
                            {{1, 0, 0}, {-9, 1, 0}, up, ContactState::free},  // free
                            {{2, 0, 0}, {-9, 1, 0}, unknown},                 // unknown normal
                            {{3, 0, 0}, {-9, -1, 0}, up},                     // pulls into the surface
                            {{3, 1, 0}, {-9, 1, 0}, up}});                    // moves along the normal
  EXPECT_NEAR(apparent_friction(trace), 0.5, 1e-15);
  EXPECT_TRUE(std::isnan(apparent_friction(slid({{{0, 0, 0}, {-9, 1, 0}, up}}))));
  EXPECT_TRUE(std::isnan(apparent_friction(Trace())));
}

// The mean of a sine over an odd number of ticks is its middle times sin(n a / 2) / (n sin(a / 2)), with a
// the phase of a tick.
double ripple_factor(double frequency_Hz) {
  const int ticks = 101;
  const double half_phase = M_PI * frequency_Hz * kTick_s;
  return std::abs(1 - std::sin(ticks * half_phase) / (ticks * std::sin(half_phase)));
}

TEST(Ripple, OfASineIsItsRmsTimesTheFactorOfItsFrequency) {
  for (const double frequency_Hz : {2.0, 5.0, 10.0, 25.0, 90.0}) {
    const auto wave = [&](int i) { return std::sin(2 * M_PI * frequency_Hz * kTick_s * i); };
    // 1000 of the 1100 ticks have a whole window: whole periods.
    const Trace trace = pushed_along(1100, [&](int i) { return Vec3(0, 3, 0.5 * wave(i)); });
    const double rms = 0.5 * std::sqrt(0.5) * ripple_factor(frequency_Hz);
    EXPECT_NEAR(force_ripple_N(trace), rms, 1e-11) << frequency_Hz;
  }
}

// The factors of the header.
TEST(Ripple, FactorsOfTheWindow) {
  EXPECT_NEAR(ripple_factor(2), 0.06, 0.01);
  EXPECT_NEAR(ripple_factor(5), 0.36, 0.01);
  EXPECT_NEAR(ripple_factor(7.4), 0.71, 0.02);
  EXPECT_NEAR(ripple_factor(10), 1, 0.02);
  EXPECT_NEAR(ripple_factor(14.3), 1.22, 0.01);
}

TEST(Ripple, IsNoneForAForceThatIsLinearInTime) {
  const Trace trace = pushed_along(400, [](int i) { return Vec3(1 + 0.01 * i, 2, 3 - 0.002 * i); });
  EXPECT_NEAR(force_ripple_N(trace), 0, 1e-12);
  EXPECT_NEAR(relative_ripple(trace), 0, 1e-12);
}

TEST(Ripple, IsRelativeToTheMeanForce) {
  const auto sign = [](int i) { return i % 2 ? 1.0 : -1.0; };
  // A window of 101 ticks has 51 with the sign of its middle, and 50 with the other one.
  const Trace trace = pushed_along(300, [&](int i) { return Vec3(0, 4 + 0.1 * sign(i), 0); });
  const double ripple = 0.1 * (1 - 1.0 / 101);
  EXPECT_NEAR(force_ripple_N(trace), ripple, 1e-12);
  EXPECT_NEAR(relative_ripple(trace), ripple / 4, 1e-12);
}

// Contacts of 90 and 120 ticks: only 20 ticks of the second one have a whole window.
TEST(Ripple, CountsOnlyWindowsInContact) {
  const auto force = [](int i) {
    const bool touches = i < 90 || (i >= 200 && i < 320);
    return touches ? Vec3(0, 2, 0) : Vec3(0, 0, 0);
  };
  EXPECT_EQ(force_ripple_N(pushed_along(400, force)), 0);
  EXPECT_TRUE(std::isnan(force_ripple_N(pushed_along(100, force))));
  EXPECT_TRUE(std::isnan(force_ripple_N(pushed_along(100, [](int) { return Vec3(0, 0, 0); }))));
  EXPECT_FALSE(std::isnan(force_ripple_N(pushed_along(101, [](int) { return Vec3(0, 1, 0); }))));
  EXPECT_TRUE(std::isnan(relative_ripple(pushed_along(99, [](int) { return Vec3(0, 1, 0); }))));
}

TEST(Ripple, IsNanIfTheWindowHasFewerThanThreeTicks) {
  Trace slow;
  for (int i = 0; i < 50; ++i) {
    RenderOutput out;
    out.force_N = Vec3(0, i % 2 ? 1 : 2, 0);
    slow.append(0.06 * i, {}, out, {});
  }
  EXPECT_TRUE(std::isnan(force_ripple_N(slow)));
  EXPECT_TRUE(std::isnan(force_ripple_N(Trace())));
}

TEST(PerceivedMeasures, AreInTheTable) {
  const Trace trace = pushed_along(400, [](int i) { return Vec3(0.1 * (i % 7), 2 + 0.01 * (i % 13), 0); });
  EXPECT_EQ(value_of(measure_named("max_relative_jump"), trace), max_relative_jump(trace));
  EXPECT_EQ(value_of(measure_named("max_relative_change"), trace), max_relative_change(trace));
  EXPECT_EQ(value_of(measure_named("force_ripple"), trace), force_ripple_N(trace));
  EXPECT_EQ(value_of(measure_named("relative_ripple"), trace), relative_ripple(trace));
  EXPECT_TRUE(needs_true_contact(measure_named("apparent_friction")));
}

}  // namespace
}  // namespace remote_touch::perceived_measures_test
