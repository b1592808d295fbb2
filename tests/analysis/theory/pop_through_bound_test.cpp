#include "analysis/theory/pop_through_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <random>

namespace remote_touch::pop_through_bound_test {
namespace {

constexpr Lift kLift{0.00499, 30, 0.1, 10};

TEST(Bound, CriticalAccelerationIsThatOfTheText) {
  EXPECT_NEAR(critical_acceleration(kLift), 4.491, 1e-12);  // r_1 f_c^2
}

// Both sides of (4.25) are equal at the bound.
TEST(Bound, SolvesTheInequality) {
  for (const double h : {0.0, 0.002, 0.01})
    for (const double e : {0.0, 0.05, 0.5}) {
      const double a = bound_acceleration(kLift, h, e);
      const double right = a / 900 + (0.1 + 9 * a / 30) / 30 * e;
      EXPECT_NEAR(kLift.r1_m + h, right, 1e-12);
    }
  EXPECT_EQ(bound_acceleration(kLift, -1, 0), 0);
}

TEST(Bound, PrintedFitsHaveKnownValuesAtOneCentimetre) {
  EXPECT_NEAR(printed_thickness().at(0.01), 0.0101, 5e-5);
  EXPECT_NEAR(printed_normal_error().at(0.01), 0.26, 1e-9);
  EXPECT_NEAR(printed_normal_error().digits_band(0.01), 0.205, 1e-9);
}

// The printed bound in units of r_c, at noise in units of r_c.
TEST(Bound, PrintedBoundAsPlotted) {
  for (const auto& [noise, expected] :
       {std::pair(0.08, 922), {0.68, 1218}, {1.08, 1134}, {1.48, 1060}, {1.88, 882}, {2.48, 256}}) {
    const double sigma = noise * 0.005;
    EXPECT_NEAR(
        bound_acceleration(kLift, printed_thickness().at(sigma), printed_normal_error().at(sigma)) / 0.005,
        expected, 1);
  }
}

TEST(ScatterBound, EqualsTheCriticalAccelerationAtZeroNoise) {
  EXPECT_NEAR(scatter_bound(kLift, {}), critical_acceleration(kLift), 1e-9);
  EXPECT_EQ(survival_probability(kLift, {}, 4.4), 1);
  EXPECT_EQ(survival_probability(kLift, {}, 4.6), 0);
}

constexpr NoiseEffect kNoise{0.006, 0.002, 0.05, 0.02, 0.09, 0.07, 0.0035, 0.6};

// Comparison of the formula with what it is derived from: random draws at ten updates, with a given scatter
// of the margin at rest.
TEST(ScatterBound, ProbabilityIsThatOfDraws) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double a : {2.0, 3.5, 4.5}) {
    int survived = 0;
    constexpr int kLifts = 20000;
    for (int lift = 0; lift < kLifts; ++lift) {
      double estimate = kLift.start_velocity_m_per_s;
      bool above = true;
      for (int j = 1; j <= 10 && above; ++j) {
        const double velocity = 0.1 + j * a / 30;
        const double more_normal_error =
            std::sqrt(estimate * estimate - 0.1 * 0.1) * kNoise.normal_error_sd * normal(random);
        const double margin = kLift.r1_m + kNoise.thickness_m + kNoise.margin_sd_m * normal(random) +
                              (estimate * (1 - kNoise.normal_error) + more_normal_error - velocity) / 30;
        above = margin > kNoise.thickness_sd_m * normal(random);  // scatter of the new frame
        estimate += kNoise.gain * (velocity - estimate);
      }
      survived += above ? 1 : 0;
    }
    EXPECT_NEAR(survived / double{kLifts}, survival_probability(kLift, kNoise, a), 0.015) << a;
  }
}

TEST(ScatterBound, HalfSurviveAtIt) {
  EXPECT_NEAR(survival_probability(kLift, kNoise, scatter_bound(kLift, kNoise)), 0.5, 1e-9);
  NoiseEffect sunk;
  sunk.thickness_m = -0.01, sunk.margin_sd_m = 0.001;
  EXPECT_EQ(scatter_bound(kLift, sunk), 0);  // pops through at rest
}

// The limit of the search is first at 44.91 m/s^2. With one update, v_1 - v_0 = a / f_c.
TEST(ScatterBound, IsFoundAlsoFarAboveTheCriticalAcceleration) {
  NoiseEffect thick;
  thick.thickness_m = 0.1;
  EXPECT_NEAR(scatter_bound({0.00499, 30, 0.1, 1}, thick), (0.00499 + 0.1) * 900, 1e-9);
}

TEST(ScatterBound, IsNanIfTheNoiseIsNotKnown) {
  for (double NoiseEffect::*part :
       {&NoiseEffect::thickness_m, &NoiseEffect::margin_sd_m, &NoiseEffect::gain}) {
    NoiseEffect unknown = kNoise;
    unknown.*part = std::nan("");
    EXPECT_TRUE(std::isnan(survival_probability(kLift, unknown, 1)));
    EXPECT_TRUE(std::isnan(scatter_bound(kLift, unknown)));
  }
}

}  // namespace
}  // namespace remote_touch::pop_through_bound_test
