#include "analysis/theory/ball_closing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace remote_touch::ball_closing_test {
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

TEST(BallClosing, KeepsAFlatSurface) {
  for (const double height : {0.0, -0.02, 0.01})
    for (const double h : closed(sampled([&](double) { return height; }))) EXPECT_NEAR(h, height, kRounding);
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

TEST(BallClosing, PeakIsFeltAsItIs) {
  for (const double slope : {0.5, 1.0, 5.0}) {
    const std::vector<double> peak = sampled([&](double x) { return -slope * std::abs(x); });
    const std::vector<double> got = closed(peak);
    EXPECT_NEAR(got[kHalf], 0, kRounding);
    // The ball is convex and so is the peak: it touches every sample, a radius away from the ends.
    for (std::size_t i = 50; i + 50 < got.size(); ++i) EXPECT_NEAR(got[i], peak[i], 10 * kRounding) << slope;
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

TEST(BallClosing, NeverBelowTheProfileAndNoHigherThanItsTop) {
  const std::vector<double> heights = rough_profile(1), got = closed(heights);
  int lifted = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_GE(got[i], heights[i] - kRounding);
    EXPECT_LE(got[i], *std::max_element(heights.begin(), heights.end()) + kRounding);
    lifted += got[i] > heights[i] + 1e-6;
  }
  EXPECT_GT(lifted, 400);
}

// A second closing changes nothing that the ball can feel: exact for samples, up to rounding.
TEST(BallClosing, IsIdempotent) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<double> once = closed(rough_profile(seed)), twice = closed(once);
    for (std::size_t i = 0; i < once.size(); ++i) ASSERT_NEAR(twice[i], once[i], kRounding) << i;
  }
}

TEST(BallClosing, HigherProfileIsNeverFeltLower) {
  const std::vector<double> low = rough_profile(4), more = rough_profile(5);
  std::vector<double> high = low;
  for (std::size_t i = 0; i < high.size(); i += 7) high[i] += more[i];
  const std::vector<double> felt_low = closed(low), felt_high = closed(high);
  for (std::size_t i = 0; i < high.size(); ++i) ASSERT_GE(felt_high[i], felt_low[i]);
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

}  // namespace
}  // namespace remote_touch::ball_closing_test
