#include "scenarios/camera/water.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
