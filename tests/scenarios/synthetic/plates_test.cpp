// Tests the points of plates that are seen from above against their expected positions.
#include "scenarios/synthetic/plates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace remote_touch::plates_test {
namespace {

// A table at rest, and a plate of 3 x 4 cm, 5 cm above it, that passes from x = -0.06 m on at 0.3 m/s.
Plates::Settings passing() {
  Plates::Settings s;
  s.grid = {61, 41, 0.002, 0, 0};
  s.plates = {0,     0,    0, 0.2,  0.2,  0,   0, 0,   0,  // the table
              -0.06, 0.05, 0, 0.03, 0.04, 0.3, 0, 0.1, 0.5};
  return s;
}

Plates made(const Plates::Settings& s) {
  return Plates(s, NoiseKey{3, 1, 2}, scenes::kernels());
}

TEST(Plates, ARaySeesTheHighestPlateAtItsNode) {
  const Plates plates = made(passing());
  for (const int frame : {0, 3, 9, 20}) {
    const double x = -0.06 + 0.3 * std::clamp(frame / 30.0 - 0.1, 0.0, 0.4);
    const PointCloud cloud = plates.cloud(frame);
    ASSERT_EQ(cloud.size(), 61u * 41u);
    EXPECT_EQ(cloud.columns(), 61);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_NEAR(cloud.x[i], (static_cast<double>(i % 61) - 30) * 0.002, 1e-15) << "rays stand still";
      const double beside = std::abs(cloud.x[i] - x) - 0.015, ahead = std::abs(cloud.z[i]) - 0.02;
      if (std::abs(beside) > 1e-9 && std::abs(ahead) > 1e-9) {
        EXPECT_EQ(cloud.y[i], beside < 0 && ahead < 0 ? 0.05 : 0) << frame << " " << cloud.x[i];
      }
    }
  }
}

TEST(Plates, PlatesTooNearToTheCameraOnlyHide) {
  Plates::Settings s = passing();
  s.max_height_m = 0.04;
  const PointCloud all = made(passing()).cloud(9), less = made(s).cloud(9);
  int hidden = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(less.is_measured(i), all.y[i] == 0);
    hidden += less.is_measured(i) ? 0 : 1;
  }
  EXPECT_GT(hidden, 200);
}

TEST(Plates, GapsBetweenPlatesHaveNoPoints) {
  Plates::Settings s = passing();
  s.plates = {-0.05, 0, 0, 0.1, 0.2, -0.1, 0, 0, 0.2, 0.05, 0, 0, 0.1, 0.2, 0.1, 0, 0, 0.2};
  const PointCloud cloud = made(s).cloud(6);  // 0.2 s: a gap of 4 cm
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(std::abs(cloud.x[i]) - 0.02) > 1e-9) {
      EXPECT_EQ(cloud.is_measured(i), std::abs(cloud.x[i]) > 0.02);
    }
  }
}

TEST(Plates, TheFirstPlateIsTheTruth) {
  Plates::Settings s = passing();
  s.plates = {0, 0.01, 0, 0.1, 0.1, 0.2, 0.3, 0, 10, 0, 0.05, 0, 0.1, 0.1, 0, 0, 0, 0};
  const Vec3 p(0.01, 0.04, 0.02);
  EXPECT_NEAR(made(s).signed_distance(p, 0), 0.03, 1e-15);
  EXPECT_NEAR(made(s).signed_distance(p, 0.09), 0.03 - 0.3 * 2 / 30, 1e-15) << "the frame of 1/15 s";
  EXPECT_NEAR(made(s).surface_height(0, 0, 0.09), 0.01 + 0.3 * 0.09, 1e-15);
  s.truth = SurfaceTime::moving;
  EXPECT_NEAR(made(s).signed_distance(p, 0.09), 0.03 - 0.3 * 0.09, 1e-15);
  EXPECT_NEAR(made(s).signed_distance({0.05 + 0.018 + 0.3, 0.01 + 0.027 + 0.4, 0}, 0.09), 0.5, 1e-12)
      << "beyond the border, to the border";
  EXPECT_TRUE(std::isnan(made(s).signed_distance({0.05 + 0.018 + 0.3, 0.01 + 0.027 - 0.4, 0}, 0.09)))
      << "below its plane, beside it";
}

TEST(Plates, HaveFramesForAsLongAsSomethingChanges) {
  EXPECT_EQ(made(passing()).frame_count(), 16) << "0.5 s is frame 15";
  Plates::Settings s = passing();
  s.noise_sigma_m = 0.001;
  EXPECT_EQ(made(s).frame_count(), std::numeric_limits<int>::max());
  EXPECT_NE(made(s).cloud(20).y[0], made(s).cloud(21).y[0]);
  EXPECT_EQ(made(Plates::Settings{}).frame_count(), 1);
}

TEST(Plates, RefuseSizesOfZero) {
  Plates::Settings s;
  s.plates = {0, 0, 0, 0.2, 0, 0, 0, 0, 0};
  EXPECT_NE(validate(s).find("row 1"), std::string::npos);
  s.plates.clear();
  EXPECT_FALSE(validate(s).empty());
}

}  // namespace
}  // namespace remote_touch::plates_test
