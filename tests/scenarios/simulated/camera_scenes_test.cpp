// Scenes that a camera sees: the beating heart against closed forms of its motion, the tank of valves, and
// its water against formulas.
#include "scenarios/simulated/camera_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "tests/support/scenes.h"

namespace remote_touch::beating_heart_test {
namespace {

constexpr double kBeat_s = 0.8;  // period of 75 beats a minute

BeatingHeart made(const BeatingHeart::Settings& settings = {}) {
  return BeatingHeart(settings, NoiseKey{1}, scenes::kernels());
}
BeatingHeart ideal() {
  BeatingHeart::Settings s;
  s.camera.noise_per_m = 0, s.camera.quantisation_per_m = 0;
  return made(s);
}
double top(const BeatingHeart& heart, double time_s) {
  return heart.surface_height(0, 0, time_s);
}

// Positions on and around the organ.
std::vector<Vec3> places() {
  const PointCloud at = scenes::random_cloud(300, 1, 3);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < at.size(); ++i)
    places.emplace_back(0.08 * at.x[i], 0.03 + 0.05 * at.y[i], 0.06 * at.z[i]);
  return places;
}

TEST(BeatingHeart, EveryBeatIsTheSame) {
  for (const double rate : {75.0, 40.0}) {
    BeatingHeart::Settings s;
    s.rate_per_min = rate;
    const BeatingHeart heart = made(s);
    bool moves = false;
    for (const Vec3& p : places())
      for (const double t : {0.0, 0.11, 0.37, 0.6}) {
        const double now = heart.signed_distance(p, t);
        EXPECT_NEAR(heart.signed_distance(p, t + 60 / rate), now, 1e-15);
        EXPECT_NEAR(heart.signed_distance(p, t + 1000 * 60 / rate), now, 1e-13);
        moves |= std::abs(heart.signed_distance(p, t + 30 / rate) - now) > 0.001;
      }
    EXPECT_TRUE(moves) << "a period of half a beat";
  }
}

// The speed is computed by differences over h. Its largest values are those of a fifth-order step. It changes
// no faster than by the largest acceleration of such a step, 10 / sqrt(3) amplitude / duration^2.
TEST(BeatingHeart, TheTopSinksByTheAmplitudeAndMovesSmoothly) {
  const BeatingHeart heart = made();
  EXPECT_NEAR(top(heart, 0), 0.06, 1e-15);
  EXPECT_NEAR(top(heart, 0.32 * kBeat_s), 0.06 - 0.0065, 1e-15) << "it stays contracted for a moment";
  const double h = 1e-4, contraction_s = 0.3 * kBeat_s, relaxation_s = 0.4 * kBeat_s;
  const auto speed = [&](double t) { return (top(heart, t + h) - top(heart, t - h)) / (2 * h); };
  double max_speed_down = 0, max_speed_up = 0;
  for (double t = -0.1; t < 2 * kBeat_s; t += h) {
    max_speed_down = std::max(max_speed_down, -speed(t)), max_speed_up = std::max(max_speed_up, speed(t));
    const double acceleration = 10 / std::sqrt(3.0) * 0.0065 / (contraction_s * contraction_s);
    ASSERT_LE(std::abs(speed(t + h) - speed(t)), 1.001 * h * acceleration) << t;
  }
  EXPECT_NEAR(max_speed_down, 15.0 / 8 * 0.0065 / contraction_s, 1e-5);
  EXPECT_NEAR(max_speed_up, 15.0 / 8 * 0.0065 / relaxation_s, 1e-5);
}

TEST(BeatingHeart, TheSurfaceIsWhereTheDistanceIsZero) {
  const BeatingHeart heart = made();
  for (const Vec3& p : places())
    for (const double t : {0.0, 0.1, 0.24, 0.5}) {
      const Vec3 on(p.x(), heart.surface_height(p.x(), p.z(), t), p.z());
      EXPECT_NEAR(heart.signed_distance(on, t), 0, 1e-13);
      if (heart.signed_distance(p, t) < 0) {
        EXPECT_LT(p.y(), on.y()) << "inside is below the top";
      }
    }
  EXPECT_NEAR(heart.signed_distance({0, 0.07, 0}, 0), 0.01, 1e-15);
  EXPECT_NEAR(heart.signed_distance({0.3, 0.07, 0}, 0), 0.07, 1e-15) << "over the table";
  EXPECT_NEAR(heart.signed_distance({0.3, -0.02, 0}, 0), -0.02, 1e-15) << "in the table";
}

TEST(BeatingHeart, IdealPointsLieOnTheSurfaceOfTheirTime) {
  const BeatingHeart heart = ideal();
  for (const int frame : {0, 2, 5, 7, 1000}) {
    const PointCloud cloud = heart.cloud(frame);
    const double time = heart.captured_s(frame);
    int on_organ = 0, holes = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool hole = std::isnan(cloud.x[i]), organ = cloud.colour[i] != 0x3A6E78;
      on_organ += organ, holes += hole;
      if (hole || (!organ && i % 7 != 0)) continue;  // a sample is enough for the table
      const Vec3 p = cloud.point(i);
      ASSERT_LT(std::abs(heart.signed_distance(p, time)), 1e-9) << p.transpose();
      ASSERT_EQ(organ, p.y() > 1e-9) << "colour and place agree";
    }
    EXPECT_GT(on_organ, 4000);
    EXPECT_LT(holes, 4000);
  }
}

TEST(BeatingHeart, RestsAtZeroAmplitude) {
  BeatingHeart::Settings s;
  EXPECT_EQ(made().frame_count(), std::numeric_limits<int>::max());
  s.amplitude_m = 0;
  EXPECT_GT(made(s).frame_count(), 1) << "its noise does not";
  s.camera.noise_per_m = 0;
  const BeatingHeart heart = made(s);
  EXPECT_EQ(heart.frame_count(), 1);
  for (const Vec3& p : places())
    EXPECT_EQ(heart.signed_distance(p, 0.3), heart.signed_distance(p, 0)) << p.transpose();
  EXPECT_TRUE(scenes::same_clouds(heart.cloud(0), heart.cloud(9)));
}

}  // namespace
}  // namespace remote_touch::beating_heart_test

namespace remote_touch::valve_tank_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Settings = ValveTank::Settings;

ValveTank made(const Settings& settings = {}, std::uint64_t seed = 1) {
  return ValveTank(settings, NoiseKey{seed}, scenes::kernels());
}
Settings ideal() {
  Settings s;
  s.turbidity_per_m = 0, s.colour_noise = 0, s.dropout_probability = 0;
  s.camera.noise_per_m = 0, s.camera.quantisation_per_m = 0;
  return s;
}
TEST(ValveTank, HasOneFrameIfThereIsNoNoise) {
  EXPECT_EQ(made(ideal()).frame_count(), 1);
  for (double Settings::*varies :
       {&Settings::turbidity_per_m, &Settings::colour_noise, &Settings::dropout_probability}) {
    Settings s = ideal();
    s.*varies = 0.1;
    EXPECT_EQ(made(s).frame_count(), std::numeric_limits<int>::max());
  }
}

TEST(ValveTank, IdealPointsLieOnWhatTheirClassSays) {
  const ValveTank tank = made(ideal());
  const PointCloud cloud = tank.cloud(0);
  const std::vector<Valve> truth = tank.truth();
  ASSERT_EQ(truth.size(), cloud.size());
  int points[3] = {};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p = cloud.point(i);
    ++points[static_cast<std::size_t>(truth[i])];
    const double distance = truth[i] == Valve::none ? p.z() : tank.distance_to_valve(truth[i], p);
    ASSERT_NEAR(distance, 0, 2e-9) << p.transpose();
    ASSERT_NEAR(tank.signed_distance(p, 0), 0, 2e-9) << p.transpose();
    EXPECT_EQ(p.x() < 0, truth[i] == Valve::left || (truth[i] == Valve::none && p.x() < 0));
  }
  EXPECT_GT(points[1], 500);
  EXPECT_GT(points[2], 500);
  EXPECT_GT(points[0], 200000);
}

TEST(ValveTank, DistancesAreOfWallAndValves) {
  const ValveTank tank = made();
  EXPECT_NEAR(tank.signed_distance({0, 0.2, 0.03}, 0), 0.03, 1e-15);
  EXPECT_NEAR(tank.signed_distance({0, 0.2, -0.03}, 0), -0.03, 1e-15) << "in the wall";
  EXPECT_NEAR(tank.signed_distance({0.11, 0, 0.09}, 0), 0.02, 1e-15);
  EXPECT_NEAR(tank.distance_to_valve(Valve::left, {-0.11, 0.062, 0.06}), 0.01, 1e-15);
  EXPECT_NEAR(tank.distance_to_valve(Valve::right, {-0.11 - 0.052 - 0.22, 0, 0.06}), 0.44, 1e-15);
}

TEST(ValveTank, PixelsWithoutDepthKeepTheirColour) {
  Settings all = ideal();
  all.dropout_probability = 1;
  const PointCloud blind = made(all).cloud(0);
  for (std::size_t i = 0; i < blind.size(); ++i) ASSERT_FALSE(blind.is_measured(i));
  EXPECT_EQ(blind.colour, made(ideal()).cloud(0).colour);
}

TEST(ValveTank, ColourNoiseHasItsDeviation) {
  Settings s = ideal();
  const std::vector<std::uint32_t> still = made(s).cloud(0).colour;
  s.colour_noise = 6;
  const std::vector<std::uint32_t> noisy = made(s).cloud(0).colour;
  EXPECT_NE(noisy, made(s).cloud(1).colour);
  EXPECT_NE(noisy, made(s, 2).cloud(0).colour);
  for (const int shift : {16, 8, 0}) {
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < still.size(); ++i) {
      const double value = still[i] >> shift & 0xFF;
      if (value < 40 || value > 215) continue;  // cut off at 0 and 255
      const double off = (noisy[i] >> shift & 0xFF) - value;
      sum += off, squares += off * off, ++count;
    }
    EXPECT_NEAR(sum / count, 0, 0.1);
    EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(36 + 1.0 / 12), 0.1);  // rounding adds 1 / 12
  }
}

// A fixture by colour must work at the defaults: both rules find their valve and little else.
TEST(ValveTank, HueFindsTheValves) {
  const ValveTank tank = made();
  const PointCloud cloud = tank.cloud(0);
  const std::vector<Valve> truth = tank.truth();
  for (const Valve valve : {Valve::left, Valve::right}) {
    HueRange::Settings s;
    if (valve == Valve::right) s.from_deg = 40, s.to_deg = 70;
    const std::vector<double> weights = HueRange(s).weights(cloud);
    double found = 0, right = 0, there = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      found += weights[i], right += truth[i] == valve ? weights[i] : 0;
      there += truth[i] == valve && cloud.is_measured(i);
    }
    EXPECT_GT(right, 0.9 * there);
    EXPECT_GT(right, 0.9 * found);
  }
}

TEST(Water, DecayIsTheExponential) {
  EXPECT_EQ(decay(0), 1);
  for (double x = 1e-12; x < 64; x = 1.01 * x + 1e-6) {
    EXPECT_NEAR(decay(x) / std::exp(-x), 1, 1e-12) << x;
    EXPECT_LE(decay(1.001 * x + 1e-9), decay(x)) << x;
  }
  EXPECT_EQ(decay(64), 0);
  EXPECT_EQ(decay(kInfinity), 0);
}

// Each channel of a colour decays by itself towards the veil; depths are lost and get noisy.
TEST(Water, ChangesWhatIsSeenByItsFormulas) {
  for (const double turbidity : {0.0, 0.5, 0.8, 1000.0})
    for (const double distance : {0.0, 0.5, 2.0, 100.0, kInfinity}) {
      const Water water(turbidity);
      const double depth = turbidity == 0 ? 0 : turbidity * std::min(distance, 1e6);
      for (const std::uint32_t rgb : {0x000000u, 0xFFFFFFu, 0x12AB00u}) {
        const std::array<double, 3> seen = water.seen(rgb, distance);
        for (std::size_t i = 0; i < 3; ++i) {
          const double own = rgb >> (16 - 8 * i) & 0xFF, through = std::exp(-Water::kAttenuation[i] * depth);
          EXPECT_NEAR(seen[i], own * through + Water::kVeil[i] * (1 - through), 1e-9) << depth;
        }
      }
      for (const double lost : {0.0, 0.02, 1.0})
        EXPECT_NEAR(water.lost(lost, distance), 1 - (1 - lost) * std::exp(-0.25 * depth), 1e-12);
      EXPECT_NEAR(water.depth_noise_factor(distance), 1 + depth, 1e-15 * (1 + depth));
    }
  EXPECT_EQ(Water(0).seen(0x12AB00, kInfinity), (std::array<double, 3>{0x12, 0xAB, 0})) << "clear";
  EXPECT_LT(Water(0.5).seen(0xFFFFFF, 2)[0], Water(0.5).seen(0xFFFFFF, 2)[2]) << "red is lost first";
}

}  // namespace
}  // namespace remote_touch::valve_tank_test
