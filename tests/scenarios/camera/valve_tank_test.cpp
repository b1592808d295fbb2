#include "scenarios/camera/valve_tank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/geometry/colour.h"
#include "tests/support/scenes.h"

namespace remote_touch::valve_tank_test {
namespace {

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
double fraction_without_depth(const PointCloud& cloud) {
  double count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) count += cloud.is_measured(i) ? 0 : 1;
  return count / static_cast<double>(cloud.size());
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

// Light and shade change the lightness, not the hue; 8 bits round it.
TEST(ValveTank, ClearWaterShowsTheHuesOfThePaint) {
  const ValveTank tank = made(ideal());
  const PointCloud cloud = tank.cloud(0);
  const std::vector<Valve> truth = tank.truth();
  const double hues_deg[] = {195, 0, 46};
  double min[3] = {1, 1, 1}, max[3] = {};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto k = static_cast<std::size_t>(truth[i]);
    const HueSaturationLightness colour = hue_saturation_lightness(cloud.colour[i]);
    ASSERT_NEAR(std::remainder(colour.hue_deg - hues_deg[k], 360), 0, 1.5) << i;
    min[k] = std::min(min[k], colour.lightness), max[k] = std::max(max[k], colour.lightness);
  }
  for (const int valve : {1, 2}) {
    EXPECT_GT(max[valve], 0.43);
    EXPECT_LT(min[valve], 0.5 * max[valve]);
  }
}

TEST(ValveTank, OnlyTheVeilIsSeenInVeryTurbidWater) {
  Settings s = ideal();
  s.turbidity_per_m = 20;
  for (const std::uint32_t colour : made(s).cloud(0).colour) ASSERT_EQ(colour, 0x0D1F1Cu);
}

TEST(ValveTank, PixelsWithoutDepthKeepTheirColour) {
  Settings all = ideal(), none = ideal();
  all.dropout_probability = 1;
  const PointCloud blind = made(all).cloud(0), seeing = made(none).cloud(0);
  EXPECT_EQ(fraction_without_depth(blind), 1);
  EXPECT_EQ(blind.colour, seeing.colour);
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

TEST(ValveTank, TurbidWaterLosesDepthAndMakesItNoisy) {
  double last_lost = -1, last_error_m = 0;
  for (const double turbidity : {0.0, 0.6, 3.0}) {
    Settings s;
    s.turbidity_per_m = turbidity, s.camera.quantisation_per_m = 0;
    const ValveTank tank = made(s);
    const PointCloud cloud = tank.cloud(0);
    double squares = 0, count = 0;
    const std::vector<Valve> truth = tank.truth();
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (truth[i] == Valve::none && cloud.is_measured(i)) squares += cloud.z[i] * cloud.z[i], ++count;
    EXPECT_GT(fraction_without_depth(cloud), last_lost + 0.02);
    EXPECT_GT(std::sqrt(squares / count), 1.3 * last_error_m);
    last_lost = fraction_without_depth(cloud), last_error_m = std::sqrt(squares / count);
  }
  EXPECT_NEAR(last_lost, 1 - 0.98 * std::exp(-0.25 * 3 * 0.98), 0.03) << "most of the wall is 1 m away";
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

TEST(ValveTank, RefusesAValveInTheWallAndACameraBehindIt) {
  Settings s;
  EXPECT_EQ(validate(s), "");
  s.left_valve_position_m.z() = 0.01;
  EXPECT_NE(validate(s), "");
  s = {};
  s.camera.camera_position_m.z() = 0;
  EXPECT_NE(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::valve_tank_test
