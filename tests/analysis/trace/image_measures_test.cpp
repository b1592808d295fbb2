#include "analysis/trace/image_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "analysis/trace/interval_estimates.h"

namespace remote_touch::image_measures_test {
namespace {

// Statistics of depth images against images whose noise, steps and holes are known.

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
constexpr int kWidth = 120, kHeight = 80;

template <class Depth>
DepthImage image_of(const Depth& depth, int width = kWidth, int height = kHeight) {
  DepthImage image{width, height, {}};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) image.z_m.push_back(depth(u, v));
  return image;
}

// A plane that is seen at an angle: 1 / z is linear over the pixels.
double inverse_of_plane(int u, int v) {
  return 1.25 + 0.001 * u - 0.0004 * v;
}

// Frames of the plane with normal noise of this standard deviation in 1 / z.
std::vector<DepthImage> noisy_frames(int count, double per_m) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, per_m);
  std::vector<DepthImage> frames;
  for (int frame = 0; frame < count; ++frame)
    frames.push_back(image_of([&](int u, int v) { return 1 / (inverse_of_plane(u, v) + normal(random)); }));
  return frames;
}

TEST(TemporalNoise, IsThatOfTheInverseDepth) {
  constexpr double kNoise_per_m = 0.003;
  const std::vector<DepthNoise> noise = temporal_noise(noisy_frames(5, kNoise_per_m));
  ASSERT_EQ(noise.size(), std::size_t{kWidth * kHeight});
  double squares = 0;
  for (const DepthNoise& pixel : noise) squares += pixel.per_m * pixel.per_m;
  EXPECT_NEAR(std::sqrt(squares / (kWidth * kHeight)) / kNoise_per_m, 1, 0.02);
  // The median of a variance of 5 values is that of chi-square with 4 degrees of freedom, over 4.
  const DepthNoise median = noise_quantile(noise, 0.5, 1, 0.5);
  EXPECT_NEAR(median.per_m / kNoise_per_m, std::sqrt(3.3567 / 4), 0.02);
  EXPECT_NEAR(median.depth_m, 1 / inverse_of_plane(kWidth / 2, kHeight / 2), 0.005);
  EXPECT_DOUBLE_EQ(median.in_m(), median.per_m * median.depth_m * median.depth_m);
}

TEST(TemporalNoise, LeavesOutPixelsThatAFrameDidNotMeasure) {
  std::vector<DepthImage> frames = noisy_frames(3, 0.001);
  frames[0].z_m[7] = kHole, frames[2].z_m[9] = kHole;
  EXPECT_EQ(temporal_noise(frames).size(), std::size_t{kWidth * kHeight - 2});
}

TEST(TemporalNoise, RefusesASingleFrameAndFramesOfTwoSizes) {
  EXPECT_THROW(temporal_noise(noisy_frames(1, 0.001)), std::invalid_argument);
  const auto one = [](int, int) { return 1.0; };
  const std::vector<DepthImage> frames{image_of(one, 4, 6), image_of(one, 6, 4)};
  EXPECT_THROW(temporal_noise(frames), std::invalid_argument);
}

TEST(FittedWindows, HaveThePlaneAndNoNoiseWithoutNoise) {
  const std::vector<FittedWindow> windows =
      fitted_windows(image_of([](int u, int v) { return 1 / inverse_of_plane(u, v); }), 20);
  ASSERT_EQ(windows.size(), std::size_t{kWidth / 20 * kHeight / 20});
  for (const FittedWindow& window : windows) {
    EXPECT_NEAR(window.across_per_m, 0.001, 1e-12);
    EXPECT_NEAR(window.down_per_m, -0.0004, 1e-12);
    EXPECT_NEAR(window.noise.per_m, 0, 1e-12);
    for (const int column : {window.u, window.u + 19})
      EXPECT_NEAR(window.depth_at(column, window.v + 3), 1 / inverse_of_plane(column, window.v + 3), 1e-12);
  }
}

TEST(FittedWindows, HaveTheNoiseAboutThePlane) {
  constexpr double kNoise_per_m = 0.002;
  for (const int width : {4, 20}) {
    double squares = 0, count = 0;
    for (const FittedWindow& window : fitted_windows(noisy_frames(1, kNoise_per_m)[0], width))
      squares += window.noise.per_m * window.noise.per_m, ++count;
    EXPECT_NEAR(std::sqrt(squares / count) / kNoise_per_m, 1, 0.03) << width;
  }
}

TEST(FittedWindows, LeaveOutSquaresWithAHole) {
  DepthImage image = image_of([](int, int) { return 0.8; });
  image.z_m[25] = kHole;  // in the second square of the first row
  const std::vector<FittedWindow> windows = fitted_windows(image, 20);
  EXPECT_EQ(windows.size(), std::size_t{kWidth / 20 * kHeight / 20 - 1});
  for (const FittedWindow& window : windows) EXPECT_FALSE(window.u == 20 && window.v == 0);
}

TEST(NoiseQuantile, UsesTheSamplesInTheRangeOnly) {
  std::vector<DepthNoise> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({1, 0.001 * i}), samples.push_back({2, 7.0});
  EXPECT_DOUBLE_EQ(noise_quantile(samples, 1, 2, 0.9).per_m, 0.09);
  EXPECT_DOUBLE_EQ(noise_quantile(samples, 1, 2, 0.9).depth_m, 1);
  EXPECT_DOUBLE_EQ(noise_quantile(samples, 2, 3, 0.9).per_m, 7);
  EXPECT_TRUE(std::isnan(noise_quantile(samples, 3, 4, 0.9).per_m));
  EXPECT_TRUE(std::isnan(noise_quantile(std::span(samples).first(30), 1, 2, 0.5).per_m));  // 15 samples
}

// A slope whose inverse depth is rounded to a step, and its depth to a unit (0: not rounded).
DepthImage stepped(double step_per_m, double unit_m) {
  return image_of([=](int u, int v) {
    const double inverse = 0.8 + 0.4 * (v * kWidth + u) / (kWidth * kHeight);
    const double depth = 1 / (step_per_m * std::round(inverse / step_per_m));
    return unit_m > 0 ? unit_m * std::round(depth / unit_m) : depth;
  });
}

TEST(DepthStep, IsThatOfTheInverseDepth) {
  const std::vector<DepthImage> frames{stepped(0.0025, 0)};
  EXPECT_NEAR(depth_step_per_m(frames, 0.85, 1.2), 0.0025, 1e-9);
}

TEST(DepthStep, IsThatOfTheInverseDepthAlsoIfDepthIsRoundedToASmallerUnit) {
  const std::vector<DepthImage> frames{stepped(0.0025, 0.001)};
  EXPECT_NEAR(depth_step_per_m(frames, 1, 1.2), 0.0025, 5e-5);
}

TEST(DepthStep, IsThatOfTheUnitIfTheUnitIsLarger) {
  const std::vector<DepthImage> frames{stepped(0.0002, 0.001)};
  EXPECT_NEAR(depth_step_per_m(frames, 0.95, 1.05), 0.001, 2e-5);
}

TEST(DepthStep, IgnoresGapsBetweenDepths) {
  DepthImage image = stepped(0.0025, 0);
  for (double& z : image.z_m)
    if (z > 1 && z < 1.05) z = kHole;
  EXPECT_NEAR(depth_step_per_m(std::vector<DepthImage>{image}, 0.85, 1.2), 0.0025, 1e-9);
}

TEST(DepthStep, IsNanForFewDepths) {
  const std::vector<DepthImage> frames{stepped(0.0025, 0)};
  EXPECT_TRUE(std::isnan(depth_step_per_m(frames, 1, 1.02)));
  EXPECT_TRUE(std::isnan(depth_step_per_m(frames, 3, 4)));
}

TEST(DepthEdges, HaveTheSideTheJumpAndTheHoles) {
  // Far, two holes, near, one hole, far; then a step that is too small; and a row with holes at its ends.
  const DepthImage image{
      8, 2, {2, kHole, kHole, 1, 1, kHole, 2, 2.1, kHole, kHole, 1, 1, 2, kHole, kHole, kHole}};
  const std::vector<DepthEdge> edges = depth_edges(image, 0.1);
  ASSERT_EQ(edges.size(), 3u);
  EXPECT_TRUE(edges[0].is_left_of_near);
  EXPECT_EQ(edges[0].hole_px, 2);
  EXPECT_FALSE(edges[1].is_left_of_near);
  EXPECT_EQ(edges[1].hole_px, 1);
  EXPECT_FALSE(edges[2].is_left_of_near);
  EXPECT_EQ(edges[2].hole_px, 0);
  for (const DepthEdge& edge : edges) EXPECT_DOUBLE_EQ(edge.jump_per_m, 0.5);
}

TEST(DepthEdges, AreChosenBySideAndJump) {
  const std::vector<DepthEdge> edges{{true, 0.3, 1}, {true, 0.5, 2}, {false, 0.4, 3}, {true, 0.4, 4}};
  const std::vector<DepthEdge> chosen = edges_between(edges, true, 0.4, 0.5);
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen[0].hole_px, 4);
}

TEST(HoleFraction, IsTheShareOfEdgesWithAHoleSoFarAway) {
  // A near strip whose shadow to the left is as wide as the row's number says, of 30 rows.
  const DepthImage image = image_of(
      [](int u, int v) { return u >= 60 && u < 70       ? 0.5
                                : u < 60 && u >= 60 - v ? kHole
                                                        : 1.0; }, kWidth, 30);
  const std::vector<DepthEdge> edges = depth_edges(image, 0.1);
  const std::vector<DepthEdge> left = edges_between(edges, true, 0.9, 1.1);
  ASSERT_EQ(left.size(), 30u);
  for (const int distance : {1, 5, 29})
    EXPECT_DOUBLE_EQ(hole_fraction(left, distance), (30 - distance) / 30.0);
  EXPECT_EQ(hole_fraction(left, 30), 0);
  EXPECT_EQ(median_hole_px(left), 15);
  const std::vector<DepthEdge> right = edges_between(edges, false, 0.9, 1.1);
  EXPECT_EQ(right.size(), 30u);
  EXPECT_EQ(hole_fraction(right, 1), 0);
  EXPECT_EQ(median_hole_px(right), 0);
}

TEST(HoleFraction, IsNanWithoutEdges) {
  EXPECT_TRUE(std::isnan(hole_fraction({}, 1)));
  EXPECT_TRUE(std::isnan(median_hole_px(std::vector<DepthEdge>(19))));
  EXPECT_EQ(median_hole_px(std::vector<DepthEdge>(20)), 0);
}

// Every combination, except a selected pixel of another class without depth.
const std::vector<char> kPicked{1, 1, 1, 0, 1, 0, 0, 0};
const std::vector<char> kOfClass{1, 1, 0, 1, 1, 1, 0, 0};
const std::vector<char> kDepth{1, 1, 1, 1, 0, 0, 1, 0};

TEST(Segmentation, CountsPixelsWithoutDepthSeparately) {
  const SegmentationScore score = score_segmentation(kPicked, kOfClass, kDepth);
  EXPECT_EQ(score.found, 2);
  EXPECT_EQ(score.missed, 1);
  EXPECT_EQ(score.wrong, 1);
  EXPECT_EQ(score.of_class_without_depth, 2);
  EXPECT_DOUBLE_EQ(score.recall(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.depth_fraction(), 3.0 / 5);
  EXPECT_EQ(score.recall_interval(), exact_interval(2, 3));
  EXPECT_EQ(score.precision_interval(), exact_interval(2, 3));
}

TEST(Segmentation, FramesAddUp) {
  SegmentationScore sum = score_segmentation(kPicked, kOfClass, kDepth);
  sum += score_segmentation({1, 0}, {1, 1}, {1, 1});
  EXPECT_EQ(sum.found, 3);
  EXPECT_EQ(sum.missed, 2);
  EXPECT_EQ(sum.wrong, 1);
  EXPECT_EQ(sum.of_class_without_depth, 2);
}

TEST(Segmentation, FractionsOfNoPixelsAreNan) {
  const SegmentationScore none = score_segmentation({}, {}, {});
  EXPECT_TRUE(std::isnan(none.recall()) && std::isnan(none.precision()) && std::isnan(none.depth_fraction()));
  const SegmentationScore unpicked = score_segmentation({0, 0}, {1, 0}, {1, 1});
  EXPECT_EQ(unpicked.recall(), 0);
  EXPECT_TRUE(std::isnan(unpicked.precision()));
  EXPECT_EQ(unpicked.precision_interval(), (std::pair(0.0, 1.0)));
}

TEST(Segmentation, ColumnsOfOtherLengthsAreRefused) {
  EXPECT_THROW(score_segmentation({1}, {1, 0}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(score_segmentation({1, 0}, {1, 0}, {1}), std::invalid_argument);
}

}  // namespace
}  // namespace remote_touch::image_measures_test
