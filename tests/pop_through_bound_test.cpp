#include "analysis/pop_through_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace remote_touch {
namespace {

constexpr Lift kLift{0.00499, 30, 0.1, 10};

TEST(Bound, CriticalAccelerationIsThatOfTheText) {
  EXPECT_NEAR(critical_acceleration(kLift), 4.491, 1e-12);             // r_1 f_c^2
  EXPECT_NEAR(highest_velocity(kLift, 3), 0.1 + 9 * 3 / 30.0, 1e-12);  // (4.20)
}

// At the bound, both sides of (4.25) are equal.
TEST(Bound, SolvesTheInequality) {
  for (const double h : {0.0, 0.002, 0.01})
    for (const double e : {0.0, 0.05, 0.5}) {
      const double a = bound_acceleration(kLift, h, e);
      const double right = a / 900 + highest_velocity(kLift, a) / 30 * e;
      EXPECT_NEAR(kLift.r1_m + h, right, 1e-12);
    }
  EXPECT_EQ(bound_acceleration(kLift, -1, 0), 0);
}

TEST(Bound, PrintedFitsAtOneHundredthOfAMetre) {
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

TEST(ScatterBound, WithoutNoiseIsTheBoundWithoutNoise) {
  EXPECT_NEAR(scatter_bound(kLift, {}), critical_acceleration(kLift), 1e-9);
  EXPECT_EQ(survival_probability(kLift, {}, 4.4), 1);
  EXPECT_EQ(survival_probability(kLift, {}, 4.6), 0);
}

// The formula against what it is derived from: draws of independent parts at ten updates.
TEST(ScatterBound, ProbabilityIsThatOfDraws) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const NoiseEffect noise{0.006, 0.002, 0.05, 0.02, 0, 0.07, 0.6};
  for (const double a : {2.0, 3.5, 4.5}) {
    int survived = 0;
    constexpr int kLifts = 20000;
    for (int lift = 0; lift < kLifts; ++lift) {
      double estimate = kLift.start_velocity_m_per_s;
      bool above = true;
      for (int j = 1; j <= 10 && above; ++j) {
        const double velocity = 0.1 + j * a / 30;
        const double before = noise.thickness_m + noise.thickness_sd_m * normal(random);
        const double arriving = noise.thickness_sd_m * normal(random);
        const double upright = 1 - noise.normal_error - noise.normal_error_sd * normal(random);
        const double drawn = estimate + noise.velocity_sd_m_per_s * normal(random);
        above = kLift.r1_m + before - arriving + drawn * upright / 30 - velocity / 30 > 0;
        estimate += noise.gain * (velocity - estimate);
      }
      survived += above ? 1 : 0;
    }
    EXPECT_NEAR(survived / double{kLifts}, survival_probability(kLift, noise, a), 0.015) << a;
  }
}

TEST(ScatterBound, HalfSurviveAtIt) {
  const NoiseEffect noise{0.006, 0.002, 0.05, 0.02, 0, 0.07, 0.6};
  EXPECT_NEAR(survival_probability(kLift, noise, scatter_bound(kLift, noise)), 0.5, 1e-9);
  EXPECT_EQ(scatter_bound(kLift, {-0.01, 0.001, 0, 0, 0, 0, 1}), 0);  // pops through at rest
}

}  // namespace
}  // namespace remote_touch
