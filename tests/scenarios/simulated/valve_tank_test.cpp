#include "scenarios/simulated/camera_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "tests/support/scenes.h"

namespace remote_touch::valve_tank_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kCentre(0.02, -0.03, 0.06);
constexpr double kRing_m = 0.045;
const Handwheel kWheel(kCentre, kRing_m);

// Oracle for the parts, tubes about a curve and cylinders: each has an inequality of its own, and samples.
struct Cylinder {
  double radius, low, high;
  bool holds(const Vec3& q) const { return std::hypot(q.x(), q.y()) < radius && q.z() > low && q.z() < high; }
};
const Cylinder kHub{Handwheel::kHubRadius_m, -Handwheel::kHubHalfLength_m, Handwheel::kHubHalfLength_m};
const Cylinder kStem{Handwheel::kStemRadius_m, -kCentre.z(), 0};

Vec3 spoke(int i) {
  const double angle = std::numbers::pi / 2 + i * 2 * std::numbers::pi / 3;
  return {std::cos(angle), std::sin(angle), 0};
}

bool inside_ring(const Vec3& q) {
  const Vec3 middle = kRing_m * Vec3(q.x(), q.y(), 0).normalized();
  return (q - middle).norm() < Handwheel::kTubeRadius_m;
}
bool inside_spoke(const Vec3& q, int i) {
  const double along = std::min(std::max(q.dot(spoke(i)), 0.0), kRing_m);
  return (q - along * spoke(i)).norm() < Handwheel::kSpokeRadius_m;
}
bool inside(const Vec3& p) {
  const Vec3 q = p - kCentre;
  bool any = inside_ring(q) || kHub.holds(q) || kStem.holds(q);
  for (int i = 0; i < 3; ++i) any |= inside_spoke(q, i);
  return any;
}

// Samples of the surfaces of all parts, in rings about 0.7 mm apart. Samples inside another part are left
// out.
class Surface {
 public:
  Surface() {
    constexpr int kAround = 420;
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      add_circle(kRing_m * out, out, Vec3::UnitZ(), Handwheel::kTubeRadius_m, 70);
    }
    for (int i = 0; i < 3; ++i)
      for (double along = 0; along <= kRing_m; along += 0.0005)
        add_circle(along * spoke(i), spoke(i).cross(Vec3::UnitZ()), Vec3::UnitZ(), Handwheel::kSpokeRadius_m,
                   60);
    for (const Cylinder& c : {kHub, kStem}) {
      for (double z = c.low; z <= c.high; z += 0.0005)
        add_circle({0, 0, z}, Vec3::UnitX(), Vec3::UnitY(), c.radius, 120);
      for (double r = 0; r <= c.radius; r += 0.0005) {
        add_circle({0, 0, c.low}, Vec3::UnitX(), Vec3::UnitY(), r, 120, -Vec3::UnitZ());
        add_circle({0, 0, c.high}, Vec3::UnitX(), Vec3::UnitY(), r, 120, Vec3::UnitZ());
      }
    }
  }
  double nearest(const Vec3& p) const {
    double squared = kInfinity;
    for (const Vec3& s : samples_) squared = std::min(squared, (s - p).squaredNorm());
    return std::sqrt(squared);
  }

 private:
  // The normal points away from the middle of the circle, unless it is given.
  void add_circle(const Vec3& middle, const Vec3& one, const Vec3& other, double radius, int count,
                  const Vec3& normal = Vec3::Zero()) {
    for (int j = 0; j < count; ++j) {
      const double angle = 2 * std::numbers::pi * j / count;
      const Vec3 out = std::cos(angle) * one + std::sin(angle) * other;
      const Vec3 p = kCentre + middle + radius * out;
      if (!inside(p + 1e-9 * (normal.isZero() ? out : normal))) samples_.push_back(p);
    }
  }
  std::vector<Vec3> samples_;
};

std::vector<Vec3> places(int count, double half_width, unsigned seed) {
  const PointCloud at = scenes::random_cloud(count, half_width, seed);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < at.size(); ++i) places.push_back(kCentre + at.point(i));
  return places;
}

TEST(Handwheel, TheDistanceOutsideIsThatToTheNearestSample) {
  const Surface surface;
  int outside = 0;
  for (const Vec3& p : places(500, 0.08, 1)) {
    const double distance = kWheel.signed_distance(p), nearest = surface.nearest(p);
    ASSERT_EQ(distance < 0, inside(p)) << p.transpose();
    if (distance < 0) {
      EXPECT_GE(nearest, -distance - 1e-12) << "inside, the depth is at least the returned one";
      continue;
    }
    ++outside;
    EXPECT_LE(distance, nearest + 1e-12) << p.transpose();
    EXPECT_GE(distance, nearest - 0.0007) << p.transpose();
  }
  EXPECT_GT(outside, 300);
}

TEST(Handwheel, HasTheKnownDistances) {
  const auto at = [&](double x, double y, double z) {
    return kWheel.signed_distance(kCentre + Vec3(x, y, z));
  };
  EXPECT_NEAR(at(0, 0, 0.03), 0.02, 1e-15) << "before the hub";
  EXPECT_NEAR(at(0, 0.062, 0), 0.010, 1e-15) << "above the ring";
  EXPECT_NEAR(at(0.045, 0, 0.017), 0.010, 1e-15) << "before the ring";
  EXPECT_NEAR(at(0, 0.025, 0.0145), 0.010, 1e-15) << "before the upper spoke";
  EXPECT_NEAR(at(0, -0.025, 0), 0.013, 1e-15) << "between two spokes, above the ring";
  EXPECT_NEAR(at(0.018, 0, -0.040), 0.010, 1e-15) << "beside the stem";
  EXPECT_NEAR(at(0.014, 0, 0.014), 0.005, 1e-15) << "off the hub's edge";
  EXPECT_NEAR(at(0.045, 0, 0), -0.007, 1e-15) << "in the middle of the tube";
}

// Compares cast(), from cameras all around, with a march of small steps to the first position inside.
TEST(Handwheel, RaysHitItWhereAMarchDoes) {
  const std::vector<Vec3> origins = places(400, 0.5, 2), targets = places(400, 0.07, 3);
  int hits = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (inside(origins[i])) continue;
    const Vec3 ray = (0.1 + 0.01 * static_cast<double>(i)) * (targets[i] - origins[i]).normalized();
    const double t = kWheel.cast(origins[i], ray), step = 1e-4 / ray.norm();
    double found = kInfinity;
    for (double s = 0; s * ray.norm() < 1.5 && std::isinf(found); s += step)
      if (inside(origins[i] + s * ray)) {
        double low = s - step, high = s;
        for (int k = 0; k < 50; ++k)
          (inside(origins[i] + (low + high) / 2 * ray) ? high : low) = (low + high) / 2;
        found = high;
      }
    if (std::isinf(found) && !std::isinf(t)) {
      // The march can step over slivers. The hit of cast() must still be on the surface.
      EXPECT_LE(std::abs(kWheel.signed_distance(origins[i] + t * ray)), 1e-9);
      continue;
    }
    ASSERT_EQ(std::isinf(t), std::isinf(found)) << i;
    if (std::isinf(t)) continue;
    ++hits;
    EXPECT_LE(std::abs(kWheel.signed_distance(origins[i] + t * ray)), 1e-9) << i;
    EXPECT_LE(t * ray.norm(), found * ray.norm() + 1e-9) << i;
    // If cast() hits earlier, the march has stepped over a sliver within the last 10 mm.
    EXPECT_GE(t * ray.norm(), found * ray.norm() - 0.01) << i;
  }
  EXPECT_GT(hits, 80);
}

// cast() and signed_distance() agree: no ray hits the surface before it has travelled the distance.
TEST(Handwheel, NoRayMeetsItBeforeTheDistance) {
  const std::vector<Vec3> directions = places(20, 1, 4);
  for (const Vec3& p : places(200, 0.1, 5)) {
    const double distance = kWheel.signed_distance(p);
    for (const Vec3& displacement : directions)
      EXPECT_GE(kWheel.cast(p, displacement.normalized()), std::max(0.0, distance - 1e-8)) << p.transpose();
  }
}

TEST(Handwheel, ARayFromInsideHitsAtOnceAndARayAwayMisses) {
  EXPECT_EQ(kWheel.cast(kCentre, {0, 0, 1}), 0);
  EXPECT_EQ(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, 1}), kInfinity);
  EXPECT_NEAR(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, -1}), 0.19, 1e-9);
  EXPECT_NEAR(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, -0.5}), 0.38, 2e-9) << "t counts in rays";
}

TEST(Handwheel, NormalsPointAwayFromTheSurface) {
  const auto at = [&](double x, double y, double z) { return kWheel.normal(kCentre + Vec3(x, y, z)); };
  EXPECT_NEAR((at(0, 0, 0.010) - Vec3(0, 0, 1)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.052, 0, 0) - Vec3(1, 0, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.038, 0, 0) - Vec3(-1, 0, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.008, 0, -0.040) - Vec3(1, 0, 0)).norm(), 0, 1e-8);
}

TEST(Handwheel, ALargerRingIsStillOnItsSpokes) {
  const Handwheel wheel({0, 0, 0.1}, 0.12);
  EXPECT_NEAR(wheel.signed_distance({0, 0.137, 0.1}), 0.010, 1e-15);
  EXPECT_NEAR(wheel.signed_distance({0, 0.09, 0.1}), -0.0045, 1e-15);
  EXPECT_FALSE(std::isinf(wheel.cast({0.12, 0, 1}, {0, 0, -1}))) << "the ball that holds it grew with it";
}

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

namespace remote_touch::water_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Water, DecayIsTheExponential) {
  EXPECT_EQ(decay(0), 1);
  for (double x = 1e-12; x < 64; x = 1.01 * x + 1e-6) {
    EXPECT_NEAR(decay(x) / std::exp(-x), 1, 1e-12) << x;
    EXPECT_LE(decay(1.001 * x + 1e-9), decay(x)) << x;
  }
  EXPECT_EQ(decay(64), 0);
  EXPECT_EQ(decay(kInfinity), 0);
}

TEST(Water, ClearWaterChangesNothing) {
  const Water clear(0);
  for (const double distance : {0.0, 0.5, 100.0, kInfinity}) {
    EXPECT_EQ(clear.seen(0x12AB00, distance), (std::array<double, 3>{0x12, 0xAB, 0}));
    EXPECT_EQ(clear.depth_noise_factor(distance), 1);
    EXPECT_NEAR(clear.lost(0.02, distance), 0.02, 1e-15);
  }
  EXPECT_EQ(clear.lost(0, 1), 0);
}

TEST(Water, FarAwayThereIsOnlyTheVeil) {
  for (const std::uint32_t rgb : {0x000000u, 0xFFFFFFu, 0xFF0000u})
    for (const auto& [turbidity, distance] : {std::pair(1000.0, 1.0), std::pair(0.5, kInfinity)}) {
      const auto seen = Water(turbidity).seen(rgb, distance);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], Water::kVeil[i], 1e-12);
    }
  EXPECT_NEAR(Water(0.5).lost(0.02, kInfinity), 1, 1e-12);
}

// A white card at 2 m in water of 0.5 per metre: beta d is 1, so the exponents are the factors of the
// channels.
TEST(Water, RedIsLostFirst) {
  const auto seen = Water(0.5).seen(0xFFFFFF, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    const double through = std::exp(-Water::kAttenuation[i]);
    EXPECT_NEAR(seen[i], 255 * through + Water::kVeil[i] * (1 - through), 1e-9);
  }
  EXPECT_LT(seen[0], seen[1]);
  EXPECT_LT(seen[1], seen[2]);
}

TEST(Water, DepthGetsWorseWithTurbidityAndDistance) {
  EXPECT_NEAR(Water(0.8).lost(0.1, 0.5), 1 - 0.9 * std::exp(-0.25 * 0.4), 1e-12);
  EXPECT_NEAR(Water(0.8).depth_noise_factor(0.5), 1.4, 1e-15);
  EXPECT_LT(Water(0.8).lost(0.1, 0.5), Water(0.9).lost(0.1, 0.5));
  EXPECT_LT(Water(0.8).lost(0.1, 0.5), Water(0.8).lost(0.1, 0.6));
  EXPECT_EQ(Water(0.8).lost(1, 0.5), 1) << "never a probability above 1";
}

}  // namespace
}  // namespace remote_touch::water_test
