// Exact contacts: a ball on a profile, tools at rest and after a jump, and the limits of pop-through, against
// closed forms, least energies, positions that are tried, and random draws.
#include "analysis/theory/surface_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>

#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/evaluation/figures/pop_through_map.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::surface_contacts_test {
namespace {

constexpr double kRadius = 0.005, kSpacing = 1e-4;
constexpr int kHalf = 300;  // samples on either side of the middle: 3 cm

double place(std::size_t i) {
  return (static_cast<int>(i) - kHalf) * kSpacing;
}

std::vector<double> sampled(const std::function<double(double)>& profile) {
  std::vector<double> heights;
  for (std::size_t i = 0; i <= 2 * kHalf; ++i) heights.push_back(profile(place(i)));
  return heights;
}

std::vector<double> closed(const std::vector<double>& heights) {
  return ball_closing(heights, kSpacing, kRadius);
}

std::vector<double> rough_profile(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> heights;
  for (int i = 0; i <= 2 * kHalf; ++i) heights.push_back(0.01 * (random() / 4294967296.0));
  return heights;
}

// Sums of a height and half a ball, each rounded twice.
constexpr double kRounding = 1e-17;

// A peak is felt as it is: the ball is convex and so is the peak, so that it touches every sample, a radius
// away from the ends of a slope.
TEST(BallClosing, KeepsAFlatSurfaceAndAPeak) {
  for (const double slope : {0.0, 0.5, 1.0, 5.0}) {
    const std::vector<double> peak = sampled([&](double x) { return 0.01 - slope * std::abs(x); });
    const std::vector<double> got = closed(peak);
    EXPECT_NEAR(got[kHalf], 0.01, kRounding);
    const std::size_t ends = slope == 0 ? 0 : 50;
    for (std::size_t i = ends; i + ends < got.size(); ++i)
      EXPECT_NEAR(got[i], peak[i], 10 * kRounding) << slope;
  }
}

// A ball touches both flanks of a V of slope angle a at r sin a, with its centre r / cos a above the vertex.
// Beyond that the ball rolls on the flank itself.
TEST(BallClosing, BallRestsInAV) {
  for (const double angle : {0.1, 0.4, 0.8, 1.1}) {
    const double slope = std::tan(angle), width = kRadius * std::sin(angle);
    const std::vector<double> got = closed(sampled([&](double x) { return slope * std::abs(x); }));
    // The ball sinks between two samples by spacing^2 / 8 times the second derivative of its profile at the
    // contact with the flank.
    const double sag = kSpacing * kSpacing / 8 / (kRadius * std::pow(std::cos(angle), 3));
    EXPECT_NEAR(got[kHalf], kRadius * (1 / std::cos(angle) - 1), sag + kRounding) << angle;
    for (std::size_t i = 100; i <= 500; ++i) {
      const double x = std::abs(place(i));
      const double want =
          x < width ? kRadius / std::cos(angle) - std::sqrt(kRadius * kRadius - x * x) : slope * x;
      EXPECT_NEAR(got[i], want, 2 * sag + kRounding) << angle << " at " << x;
    }
  }
}

TEST(BallClosing, BallLeavesAFilletAtTheFootOfAWall) {
  const double wall = 0.02;
  const std::vector<double> got = closed(sampled([&](double x) { return x < 0 ? 0 : wall; }));
  // The nearest centre touches the wall, or is one sample short of it, because a ball that touches may count
  // as lifted.
  for (std::size_t i = 100; i <= 500; ++i) {
    const double x = place(i);
    if (x >= 0) {
      EXPECT_NEAR(got[i], wall, kRounding);
    }
    const auto fillet = [&](double centre) {
      return x <= centre ? 0
                         : kRadius - std::sqrt(std::max(0.0, kRadius * kRadius - std::pow(x - centre, 2)));
    };
    if (x < 0) {
      EXPECT_GE(got[i], fillet(-kRadius) - kRounding) << x;
    }
    if (x < 0) {
      EXPECT_LE(got[i], fillet(-kRadius - 1.01 * kSpacing) + kRounding) << x;
    }
  }
}

// A gap between two edges, narrower than the ball: the scallop of a sparse grid.
TEST(BallClosing, BallSagsIntoAGap) {
  for (const int half_gap : {3, 20, 49}) {
    const double w = half_gap * kSpacing;
    const std::vector<double> got =
        closed(sampled([&](double x) { return std::abs(x) < w - 0.5 * kSpacing ? -0.03 : 0; }));
    EXPECT_NEAR(got[kHalf], -(kRadius - std::sqrt(kRadius * kRadius - w * w)), 10 * kRounding) << half_gap;
    EXPECT_NEAR(got[kHalf + static_cast<std::size_t>(half_gap)], 0, kRounding);
  }
  // The ball falls into a wider gap.
  const std::vector<double> wide = closed(sampled([](double x) { return std::abs(x) < 0.006 ? -0.03 : 0; }));
  EXPECT_NEAR(wide[kHalf], -0.03, kRounding);
}

// A second closing changes nothing that the ball can feel: exact for samples, up to rounding.
TEST(BallClosing, IsIdempotent) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<double> once = closed(rough_profile(seed)), twice = closed(once);
    for (std::size_t i = 0; i < once.size(); ++i) ASSERT_NEAR(twice[i], once[i], kRounding) << i;
  }
}

TEST(BallClosing, IsMirroredAndShiftedWithTheProfile) {
  const std::vector<double> heights = rough_profile(6);
  std::vector<double> mirrored(heights.rbegin(), heights.rend()), shifted(heights.begin() + 5, heights.end());
  const std::vector<double> got = closed(heights), got_mirrored = closed(mirrored),
                            got_shifted = closed(shifted);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got_mirrored[got.size() - 1 - i], got[i]);
  // The heights two radii away from the new end are unchanged.
  for (std::size_t i = 110; i < got_shifted.size(); ++i) ASSERT_EQ(got_shifted[i], got[i + 5]);
}

// Comparison of the closed forms with the least energy that is found by trying poses.

const EvenSpring kSpring{600, 0.03};
constexpr double kTurning = 600 * 0.03 * 0.03;

TEST(ToolRest, ABlockOnALineHasTheLeastEnergy) {
  constexpr double a = 0.02, b = 0.005;
  for (const double angle : {0.05, -0.05, 0.2, 0.5})
    for (const double depth_m : {-0.001, 0.0005, 0.003, 0.01}) {
      const double height_m = a * std::sin(std::abs(angle)) + b * std::cos(angle) - depth_m;
      double least = 1e9, at_y = 0, at_phi = 0;
      for (double phi = -1; phi < 1; phi += 2e-5) {
        const double touching_m = a * std::abs(std::sin(phi)) + b * std::cos(phi);
        const double y = std::max(height_m, touching_m);
        const double energy =
            300 * (y - height_m) * (y - height_m) + 0.5 * kTurning * (phi - angle) * (phi - angle);
        if (energy < least) least = energy, at_y = y, at_phi = phi;
      }
      const RestingWrench wrench = block_on_line(a, b, kSpring, height_m, angle);
      EXPECT_NEAR(wrench.force_N.y(), 600 * (at_y - height_m), 1e-3) << angle << ", " << depth_m;
      EXPECT_NEAR(wrench.torque_Nm, kTurning * (at_phi - angle), 3e-5) << angle << ", " << depth_m;
      EXPECT_EQ(wrench.force_N.x(), 0);
    }
}

TEST(ToolRest, ABallInAGrooveHasTheLeastEnergy) {
  constexpr double radius_m = 0.01;
  for (const double slope : {0.2, 0.6, 1.0})
    for (const double x : {-0.012, -0.001, 0.0, 0.004})
      for (const double y : {-0.01, 0.004, 0.03}) {
        double least = 1e9;
        Eigen::Vector2d rest(0, 0);
        for (double px = -0.03; px <= 0.03; px += 1e-5) {
          const double lowest = std::abs(px) * std::tan(slope) + radius_m / std::cos(slope);
          const Eigen::Vector2d p(px, std::max(y, lowest));
          const double squared = (p - Eigen::Vector2d(x, y)).squaredNorm();
          if (squared < least) least = squared, rest = p;
        }
        const RestingWrench wrench = ball_in_groove(radius_m, slope, kSpring, {x, y});
        EXPECT_NEAR((wrench.force_N - 600 * (rest - Eigen::Vector2d(x, y))).norm(), 0, 0.015)
            << slope << ", " << x << ", " << y;
      }
}

TEST(ToolRest, ABarInASlotTurnsUntilItsCornersTouch) {
  const double stop = stop_angle_rad(0.04, 0.005, 0.02);
  EXPECT_NEAR(0.04 * std::sin(stop) + 0.005 * std::cos(stop), 0.02, 1e-15);
  EXPECT_NEAR(stop * 180 / M_PI, 22.62, 0.001);
  EXPECT_EQ(bar_in_slot(0.04, 0.005, 0.02, kSpring, 0.9 * stop).torque_Nm, 0);
  EXPECT_NEAR(bar_in_slot(0.04, 0.005, 0.02, kSpring, -stop - 0.1).torque_Nm, 0.1 * kTurning, 1e-12);
}

// Comparison of the closed forms with heights that are computed position by position, and with random noise.

constexpr double kHalf_m = 0.02, kDegree = 0.017453292519943295;

// Lowest and highest position over the square, found by trying 401 x 401.
UnderPlate tried(const std::function<double(double x, double z)>& height_m) {
  UnderPlate under{-1, -1};
  for (int i = -200; i <= 200; ++i)
    for (int k = -200; k <= 200; ++k) {
      const double height = height_m(i * kHalf_m / 200, k * kHalf_m / 200);
      under.drop_m = std::max(under.drop_m, -height), under.rise_m = std::max(under.rise_m, height);
    }
  return under;
}

// The flanks are lines through the edge, so they stay lines when it turns.
TEST(ToolJump, AnEdgeThatTurnsRisesOnOneSideAndFallsOnTheOther) {
  for (const double slope : {0.0, 15.0, 30.0})
    for (const double turn : {0.0, 10.0, 40.0}) {
      const UnderPlate right = tried(
          [&](double x, double) { return x * std::tan((x > 0 ? turn - slope : turn + slope) * kDegree); });
      const UnderPlate under = under_edge(slope * kDegree, kHalf_m, turn * kDegree);
      EXPECT_NEAR(under.drop_m, right.drop_m, 1e-12) << slope << ", " << turn;
      EXPECT_NEAR(under.rise_m, right.rise_m, 1e-12) << slope << ", " << turn;
    }
}

TEST(ToolJump, ACornerFallsMostTowardsACornerOfThePlate) {
  for (const double slope : {10.0, 45.0, 70.0}) {
    const UnderPlate right = tried([&](double x, double z) {
      double height = 1;
      for (const double face : {90.0, 210.0, 330.0})
        height = std::min(height, -std::tan(slope * kDegree) *
                                      (x * std::cos(face * kDegree) + z * std::sin(face * kDegree)));
      return height;
    });
    EXPECT_NEAR(under_corner(slope * kDegree, kHalf_m).drop_m, right.drop_m, 1e-12) << slope;
  }
}

TEST(ToolJump, ABallFallsUpToTheCornersOfThePlateOrToItsMiddle) {
  for (const double radius_m : {0.03, 0.05, 0.2}) {
    const UnderPlate right =
        tried([&](double x, double z) { return std::sqrt(radius_m * radius_m - x * x - z * z) - radius_m; });
    EXPECT_NEAR(under_ball(radius_m, std::sqrt(2.0) * kHalf_m).drop_m, right.drop_m, 1e-12) << radius_m;
  }
  EXPECT_EQ(under_ball(0.01, 0.02).drop_m, 0.01);
}

// Returns the fraction of randomly drawn jumps after which no point is left in the plate.
double lost_fraction(double jump_m, double thickness_m, const std::vector<NoisyPoint>& points,
                     double sigma_m) {
  constexpr int kJumps = 2000;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma_m);
  std::uniform_real_distribution<double> chance(0, 1);
  int lost = 0;
  for (int jump = 0; jump < kJumps; ++jump) {
    double bottom_m = -1;
    bool left = false;
    for (const NoisyPoint& p : points)
      if (chance(random) < p.under_plate_probability)
        bottom_m = std::max(bottom_m, p.height_m + noise(random));
    for (const NoisyPoint& p : points) {
      const double place_m = p.height_m + jump_m + noise(random) - bottom_m;
      left |= chance(random) < p.under_plate_probability && place_m > 0 && place_m < thickness_m;
    }
    lost += left ? 0 : 1;
  }
  return static_cast<double>(lost) / kJumps;
}

// 2000 jumps determine a fraction within 0.04 (3.5 standard errors at one half). The closed form uses the
// median position of the plate, which scatters; this changes the fraction by less than 0.05 here.
TEST(ToolJump, HalfOfAllToolsAreLostAtTheJumpOfNoisyPoints) {
  std::vector<NoisyPoint> plane(400), slope, fading;
  for (int i = 0; i < 400; ++i) {
    slope.push_back({-0.00005 * i, 1});
    fading.push_back({-0.00005 * i, i < 200 ? 1 : 2 - 0.005 * i});
  }
  for (const auto& points : {plane, slope, fading})
    for (const double sigma_m : {0.0005, 0.002}) {
      const double jump_m = noisy_jump_m(0.01, points, sigma_m);
      EXPECT_NEAR(lost_fraction(jump_m, 0.01, points, sigma_m), 0.5, 0.09) << sigma_m;
      EXPECT_LT(lost_fraction(jump_m - 2 * sigma_m, 0.01, points, sigma_m), 0.15) << sigma_m;
      EXPECT_GT(lost_fraction(jump_m + 2 * sigma_m, 0.01, points, sigma_m), 0.85) << sigma_m;
    }
  // The thickness and the drop at little noise.
  EXPECT_NEAR(noisy_jump_m(0.01, {{0}, {-0.002}, {-0.004}, {-0.006}}, 1e-7), 0.016, 1e-6);
}

// --- limits of pop-through ---

constexpr Lift kLift{0.00499, 30, 0.1, 10};

// Both sides of (4.25) are equal at the bound.
TEST(Bound, SolvesTheInequality) {
  for (const double h : {0.0, 0.002, 0.01})
    for (const double e : {0.0, 0.05, 0.5}) {
      const double a = bound_acceleration(kLift, h, e);
      const double right = a / 900 + (0.1 + 9 * a / 30) / 30 * e;
      EXPECT_NEAR(kLift.r1_m + h, right, 1e-12);
    }
  EXPECT_EQ(bound_acceleration(kLift, -1, 0), 0);
  EXPECT_NEAR(critical_acceleration(kLift), 4.491, 1e-12);  // r_1 f_c^2
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
  EXPECT_NEAR(printed_normal_error().digits_band(0.01), 0.205, 1e-9);
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
  // A surface without noise.
  EXPECT_NEAR(scatter_bound(kLift, {}), critical_acceleration(kLift), 1e-9);
  EXPECT_EQ(survival_probability(kLift, {}, 4.4), 1);
  EXPECT_EQ(survival_probability(kLift, {}, 4.6), 0);
  // The limit of the search is first at 44.91 m/s^2. With one update, v_1 - v_0 = a / f_c.
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
  // A single update has no scatter.
  const NoiseEffect single = noise_effect({{lifts[0][20]}}, {20}, 0.00499, 30);
  EXPECT_EQ(single.thickness_m, lifts[0][20].thickness_m);
  for (const double unknown : {single.thickness_sd_m, single.normal_error_sd, single.velocity_sd_m_per_s,
                               single.margin_sd_m, single.gain})
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
}  // namespace remote_touch::surface_contacts_test
