// The empirical law of pop-through: its fit finds a known law, and its residuals are those by hand.
#include "analysis/theory/pop_through_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::pop_through_law_test {
namespace {

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
}  // namespace remote_touch::pop_through_law_test
