#include "analysis/theory/surface_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/figures/parts/pop_through_map.h"
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

// Comparison of the closed form with the method's rules, followed frame by frame in one dimension.

constexpr double kR1_m = 0.00499, kR2_m = 0.00501, kR3_m = 0.01;

// A proxy over a plane of points that rises, by the rules of 4.2 alone. Heights are along the plane's normal.
struct Proxy {
  double beside_m, frame_rate_hz;
  double height_m = 0, velocity_m_per_s = 0;
  bool has_normal = false;

  double rest_m() const {
    const double rc_m = 0.5 * (kR1_m + kR2_m);
    return std::sqrt(rc_m * rc_m - beside_m * beside_m);
  }
  double nearest_m(double plane_m) const { return std::hypot(height_m - plane_m, beside_m); }

  // Processes one frame with the hand at height 0. Returns false if the plane has passed the centre.
  bool sees(double plane_m) {
    height_m += velocity_m_per_s / frame_rate_hz;  // (4.3)
    if (height_m < plane_m) return false;
    double step_m = 0;
    if (nearest_m(plane_m) < kR1_m)
      step_m = plane_m + rest_m() - height_m;  // (4.10)
    else if (nearest_m(plane_m) > kR2_m)
      step_m = std::max(0.0, plane_m + rest_m()) - height_m;  // (4.9)
    height_m += step_m;
    const double felt_m = has_normal ? step_m : 0;  // (4.13) uses the normal from before the frame
    velocity_m_per_s = std::max(0.0, velocity_m_per_s + felt_m * frame_rate_hz);
    has_normal = has_normal || nearest_m(plane_m) < kR3_m;
    return true;
  }
};

bool is_lost(double beside_m, double frame_rate_hz, double velocity, double phase) {
  Proxy proxy{beside_m, frame_rate_hz};
  const double moved_m = velocity / frame_rate_hz;
  for (int frame = 0; frame < 40; ++frame)
    if (!proxy.sees(-(30 - frame + phase) * moved_m)) return true;
  return false;
}

double followed(double beside_m, double frame_rate_hz, double velocity, int phases) {
  int lost = 0;
  for (int i = 0; i < phases; ++i)
    lost += is_lost(beside_m, frame_rate_hz, velocity, (i + 0.5) / phases) ? 1 : 0;
  return static_cast<double>(lost) / phases;
}

// The lost phases are one interval, so the number of phases in it differs by less than one.
TEST(FirstTouch, FractionIsThatOfTheRulesFollowedFrameByFrame) {
  constexpr int kPhases = 2000;
  for (const double rate_hz : {15.0, 30.0, 90.0})
    for (const double beside_m : {0.0, 0.00075, 0.0010606601717798212})
      for (double moved_m = 0.0045; moved_m < 0.0105; moved_m += 0.00017) {
        const double velocity = moved_m * rate_hz;
        const FirstTouch touch{kR1_m, kR2_m, beside_m, rate_hz};
        EXPECT_NEAR(lost_at_first_touch(touch, velocity), followed(beside_m, rate_hz, velocity, kPhases),
                    1.0 / kPhases)
            << moved_m << ", " << beside_m << ", " << rate_hz;
      }
}

TEST(FirstTouch, NoneIsLostUpToTheFirstVelocityAndAllFromTwiceTheSecond) {
  const FirstTouch touch{kR1_m, kR2_m, 0.0010606601717798212, 30};
  const double first = max_first_touch_velocity(touch), touched = max_touched_velocity(touch);
  EXPECT_NEAR(first, 0.14628, 5e-6);
  EXPECT_NEAR(touched, 0.14659, 5e-6);
  EXPECT_EQ(lost_at_first_touch(touch, first), 0);
  EXPECT_GT(lost_at_first_touch(touch, 1.001 * first), 0);
  EXPECT_LT(lost_at_first_touch(touch, 1.999 * touched), 1);
  EXPECT_EQ(lost_at_first_touch(touch, 2 * touched), 1);
  EXPECT_EQ(lost_at_first_touch(touch, 1.0), 1);
  for (const double velocity : {0.16, 0.2, 0.28})
    EXPECT_NEAR(lost_at_first_touch(touch, velocity), 2 * (1 - touched / velocity), 1e-12);
}

// The hand has brought the proxy to its rest height over the plane before the frame.
TEST(FirstTouch, AHandThatTouchesBetweenFramesLosesAboveItsOwnVelocity) {
  for (const double beside_m : {0.0, 0.0010606601717798212}) {
    const FirstTouch touch{kR1_m, kR2_m, beside_m, 30};
    for (const double velocity :
         {0.9999 * max_touched_velocity(touch), 1.0001 * max_touched_velocity(touch)}) {
      Proxy proxy{beside_m, 30, 0, 0, true};
      proxy.height_m = -0.1 + proxy.rest_m();
      bool kept = true;
      for (int frame = 1; frame < 10 && kept; ++frame) kept = proxy.sees(-0.1 + frame * velocity / 30);
      EXPECT_EQ(kept, velocity < max_touched_velocity(touch)) << velocity;
    }
  }
}

// The empirical law of pop-through: its fit finds a known law, and its residuals are those by hand.

std::vector<LimitPoint> points_of(const PopThroughLaw& law) {
  std::vector<LimitPoint> points;
  for (const double spacing : {0.2, 0.4, 0.6})
    for (const double noise : {0.1, 0.5, 1.0}) points.push_back({spacing, noise, law.limit(spacing, noise)});
  return points;
}

TEST(PopThroughLaw, IsFoundFromItsOwnLimits) {
  const PopThroughLaw law{1.4, 3.5}, found = fitted_law(points_of(law));
  EXPECT_NEAR(found.gain, 1.4, 1e-12);
  EXPECT_NEAR(found.loss, 3.5, 1e-12);
  EXPECT_NEAR(found.neutral_spacing(), 0.4, 1e-12);
  EXPECT_NEAR(found.limit(0.4, 0.3), found.limit(0.4, 0.9), 1e-12) << "noise changes nothing there";
}

// The proxy touches four points at the corners of a square of side s, in r_c, all at the distance 1.
TEST(PopThroughLaw, RestsInTheMiddleOfFourPointsWithoutNoise) {
  for (const double s : {0.2, 0.6}) {
    const double height = PopThroughLaw{1, 2}.limit(s, 0);
    EXPECT_NEAR(std::hypot(s / 2, s / 2, height), 1, 1e-12);
  }
}

TEST(PopThroughLaw, HasTheResidualOfItsPoints) {
  std::vector<LimitPoint> points = points_of({1, 2});
  for (std::size_t i = 0; i < points.size(); ++i) points[i].limit += i % 2 == 0 ? 0.1 : -0.2;
  const double by_hand = std::sqrt((5 * 0.01 + 4 * 0.04) / 9);
  EXPECT_NEAR(rms_residual({1, 2}, points), by_hand, 1e-12);
  EXPECT_LT(rms_residual(fitted_law(points), points), by_hand) << "the fit is the nearest law";
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
