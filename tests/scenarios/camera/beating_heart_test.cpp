#include "scenarios/camera/beating_heart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

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

TEST(BeatingHeart, TheTopSinksByTheAmplitudeInEveryBeat) {
  for (const double amplitude : {0.0, 0.0065, 0.015}) {
    BeatingHeart::Settings s;
    s.amplitude_m = amplitude;
    const BeatingHeart heart = made(s);
    double low = 1, high = 0;
    for (double t = 0; t < kBeat_s; t += 0.001)
      low = std::min(low, top(heart, t)), high = std::max(high, top(heart, t));
    EXPECT_NEAR(high, 0.06, 1e-15);
    EXPECT_NEAR(low, 0.06 - amplitude, 1e-15);
  }
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
TEST(BeatingHeart, TheTopMovesSmoothly) {
  const BeatingHeart heart = made();
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

TEST(BeatingHeart, TheAtriumLeads) {
  const BeatingHeart heart = made();
  const auto lowest_at = [&](double x, double z) {
    double at = 0;
    for (double t = 0; t < kBeat_s; t += 0.001)
      if (heart.surface_height(x, z, t) < heart.surface_height(x, z, at) - 1e-12) at = t;
    return at;
  };
  EXPECT_NEAR(lowest_at(0, 0), 0.3 * kBeat_s, 0.01);
  EXPECT_NEAR(lowest_at(-0.046, -0.004), 0.12 * kBeat_s, 0.01);
}

TEST(BeatingHeart, TruthIsContinuousInTimeAndSpace) {
  const BeatingHeart heart = made();
  const double h = 1e-5;
  // A semi-axis of 40 mm shrinks by 6.5 / 32 of its length in a contraction. Its largest speed is 15 / 8 of
  // the mean.
  const double max_speed = 15.0 / 8 * 0.040 * 0.0065 / 0.032 / (0.3 * kBeat_s);
  for (const Vec3& p : places())
    for (double t = 0; t < kBeat_s; t += 0.0307) {
      const double d = heart.signed_distance(p, t);
      EXPECT_LE(std::abs(heart.signed_distance(p, t + h) - d), 1.001 * max_speed * h);
      EXPECT_LE(std::abs(heart.signed_distance(p + Vec3(h, -h, h), t) - d), 1.001 * std::sqrt(3.0) * h);
      if (d < 0) {
        EXPECT_LT(p.y(), heart.surface_height(p.x(), p.z(), t)) << "inside is below the top";
      }
    }
}

TEST(BeatingHeart, TheSurfaceIsWhereTheDistanceIsZero) {
  const BeatingHeart heart = made();
  for (const Vec3& p : places())
    for (const double t : {0.0, 0.1, 0.24, 0.5}) {
      const Vec3 on(p.x(), heart.surface_height(p.x(), p.z(), t), p.z());
      EXPECT_NEAR(heart.signed_distance(on, t), 0, 1e-13);
    }
  EXPECT_NEAR(heart.signed_distance({0, 0.07, 0}, 0), 0.01, 1e-15);
  EXPECT_NEAR(heart.signed_distance({0.3, 0.07, 0}, 0), 0.07, 1e-15) << "over the table";
  EXPECT_NEAR(heart.signed_distance({0.3, -0.02, 0}, 0), -0.02, 1e-15) << "in the table";
}

// A proxy that is pressed rests where the surface curves away from it on all sides.
TEST(BeatingHeart, IsConvexAroundItsTop) {
  const BeatingHeart heart = made();
  const double h = 0.001;
  for (const double t : {0.0, 0.12, 0.24, 0.4, 0.6})
    for (double x = -0.02; x <= 0.02; x += 0.002)
      for (double z = -0.02; z <= 0.02; z += 0.002) {
        if (x * x + z * z > 0.02 * 0.02) continue;
        const auto y = [&](double i, double k) { return heart.surface_height(x + i * h, z + k * h, t); };
        EXPECT_LT(y(1, 0) + y(-1, 0), 2 * y(0, 0)) << x << " " << z << " " << t;
        EXPECT_LT(y(0, 1) + y(0, -1), 2 * y(0, 0)) << x << " " << z << " " << t;
      }
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

TEST(BeatingHeart, TheLobesAreRedAndTheTableIsNot) {
  std::set<std::uint32_t> reds;
  for (const std::uint32_t colour : made().cloud(4).colour) {
    const int r = colour >> 16, g = colour >> 8 & 255, b = colour & 255;
    if (r <= b) continue;
    reds.insert(colour);
    ASSERT_GE(g, b);  // hue = 60 (g - b) / (r - b) degrees
    EXPECT_LE(60 * (g - b), 15 * (r - b));
    EXPECT_GT(r, 2 * b) << "saturated";
  }
  EXPECT_EQ(reds.size(), 3u);
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
