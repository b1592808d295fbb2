#include "analysis/theory/surface_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/evaluation/figures/pop_through_map.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::pop_through_limits_test {
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
}  // namespace remote_touch::pop_through_limits_test

namespace remote_touch::lift_updates_test {
namespace {

std::vector<LiftUpdate> lift(const std::vector<std::string>& overrides) {
  return lift_updates(simulate(Experiment::load("fig4.12", overrides)), Vec3(0, 1, 0), 0.00499, 30);
}

// Everything is known without noise: v_j from the definition of the lift, v_hat_j = v_{j-1}, n_hat = n, and
// the proxy rests on the four points around it, whose square of 1.5 mm has the half diagonal 0.75 sqrt(2) mm.
// A tick ends when a step changes no bit, so all of it holds within rounding.
TEST(LiftUpdates, AreExactWithoutNoise) {
  const auto updates = lift({"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=3"});
  ASSERT_EQ(updates.size(), 25u);
  for (const LiftUpdate& update : updates) {
    const int accelerated = std::max(0, update.frame - 15);
    EXPECT_NEAR(update.velocity_m_per_s, 0.1 + 3 * accelerated / 30.0, 1e-9) << update.frame;
    if (update.frame <= 16) continue;
    EXPECT_NEAR(update.estimate_m_per_s, 0.1 + 3 * (accelerated - 1) / 30.0, 1e-9) << update.frame;
    EXPECT_NEAR(update.frame_correction_m, update.estimate_m_per_s / 30, 1e-12);
    EXPECT_NEAR(update.normal_error, 0, 1e-12);
    const double height_m = std::sqrt(kContactRadius_m * kContactRadius_m - 2 * 0.00075 * 0.00075);
    EXPECT_NEAR(update.thickness_m, height_m - 0.00499, 1e-12);
    EXPECT_TRUE(update.above_before && update.above_after);
    EXPECT_NEAR(update.margin_m(0.00499, 30), height_m - 3 / 900.0, 1e-11);
  }
}

// The margin is the height of the corrected proxy over the new plane, by the definition of its terms.
TEST(LiftUpdates, MarginIsTheHeightOverTheNewPlane) {
  const Trace trace = simulate(Experiment::load("fig4.12", {"scenario.acceleration_m_per_s2=4"}));
  std::size_t next = 0;
  const auto updates = lift_updates(trace, Vec3(0, 1, 0), 0.00499, 30);
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!trace.frame_update(i)) continue;
    const double plane = trace.proxy_position_m[i].y() - trace.signed_distance_m[i];
    EXPECT_NEAR(updates.at(next).margin_m(0.00499, 30),
                trace.proxy_position_m[i - 1].y() + trace.frame_correction_m[i].y() - plane, 1e-12);
    ++next;
  }
  EXPECT_EQ(next, updates.size());
  EXPECT_EQ(updates.back().above_after, popped_through(trace) == 0);
}

TEST(LiftUpdates, CriterionPredictsPopThroughWithoutNoise) {
  const auto updates = lift({"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=5"});
  int pops = 0;
  for (const LiftUpdate& update : updates) {
    if (update.frame <= 15 || !update.above_before) continue;
    EXPECT_EQ(update.margin_m(0.00499, 30) > 0, update.above_after) << update.frame;
    pops += update.above_after ? 0 : 1;
  }
  EXPECT_EQ(pops, 1);
}

// An autoregressive velocity error of known gain, and thickness and normal error of known moments.
TEST(LiftNoise, FindsTheMomentsOfSyntheticLifts) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<std::vector<LiftUpdate>> lifts;
  for (int i = 0; i < 400; ++i) {
    double error = 0.1 * normal(random);
    auto& updates = lifts.emplace_back();
    for (int frame = 1; frame <= 60; ++frame) {
      LiftUpdate update;
      update.frame = frame;
      update.velocity_m_per_s = 0.1;
      update.estimate_m_per_s = 0.1 + 0.05 + error;
      update.thickness_m = 0.004 + 0.001 * normal(random);
      update.normal_error = 0.2 + 0.03 * normal(random);
      update.above_before = frame <= 50;
      if (frame > 50 || frame <= 20) update.thickness_m = 1e9;  // must not count
      updates.push_back(update);
      error = (1 - 0.3) * error + 0.1 * std::sqrt(1 - 0.7 * 0.7) * normal(random);
    }
  }
  const NoiseEffect effect = noise_effect(lifts, {20}, 0.00499, 30);
  EXPECT_NEAR(effect.thickness_m, 0.004, 5e-5);
  EXPECT_NEAR(effect.thickness_sd_m, 0.001, 3e-5);
  EXPECT_NEAR(effect.normal_error, 0.2, 2e-3);
  EXPECT_NEAR(effect.normal_error_sd, 0.03, 1e-3);
  EXPECT_NEAR(effect.velocity_bias_m_per_s, 0.05, 0.005);
  EXPECT_NEAR(effect.velocity_sd_m_per_s, 0.1, 0.004);
  EXPECT_NEAR(effect.gain, 0.3, 0.03);
  EXPECT_NEAR(effect.margin_sd_m, 0.001, 3e-5);  // frame_correction_m is 0 here: only the thickness scatters
  EXPECT_NEAR(lift_means(lifts.front(), {20}).thickness_m, 0.004, 1e-3);
  EXPECT_TRUE(std::isnan(lift_means(lifts.front(), {50}).thickness_m));
}

TEST(NoiseEffect, HasNoScatterOfASingleUpdate) {
  LiftUpdate update;
  update.frame = 30, update.above_before = true, update.thickness_m = 0.004;
  const NoiseEffect effect = noise_effect({{update}}, {20}, 0.00499, 30);
  EXPECT_EQ(effect.thickness_m, 0.004);
  for (const double unknown : {effect.thickness_sd_m, effect.normal_error_sd, effect.velocity_sd_m_per_s,
                               effect.margin_sd_m, effect.gain})
    EXPECT_TRUE(std::isnan(unknown));
}

// The figures on lifts state the experiment's numbers; they must be those of the experiment.
TEST(LiftUpdates, FiguresStateTheNumbersOfTheirExperiment) {
  const std::string json = Experiment::load("fig4.12").to_json();
  const auto holds = [&](const std::string& part) { return json.find(part) != std::string::npos; };
  EXPECT_TRUE(holds("\"r1_m\":0.00499,") && holds("\"r2_m\":0.00501,")) << json;
  EXPECT_EQ(kLift.r1_m, 0.00499);
  EXPECT_EQ(kContactRadius_m, 0.005);
  EXPECT_TRUE(holds("\"frame_rate_hz\":30.0,") && kLift.frame_rate_hz == 30) << json;
  EXPECT_TRUE(holds("\"start_velocity_m_per_s\":0.1,") && kLift.start_velocity_m_per_s == 0.1) << json;
  EXPECT_TRUE(holds("\"acceleration_s\":0.3333333333333333,") && kLift.updates == 10) << json;
  EXPECT_TRUE(holds("\"rise_s\":0.5,") && kRiseFrames == 15) << json;
}

}  // namespace
}  // namespace remote_touch::lift_updates_test
