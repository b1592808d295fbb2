#include "core/beyond/tracked_surface/height_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace remote_touch::height_map_test {
namespace {

// Histograms of heights: shifts between frames, and where one sheet ends and another begins.

// Profile of `points` points on each of the sheets, with noise sigma; all heights are shifted by `moved`.
HeightProfile profile(const std::vector<double>& sheets, double sigma, int points, unsigned seed,
                      double moved = 0, double half_range = 15) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;  // test data only
  HeightProfile result(half_range);
  for (int i = 0; i < points; ++i)
    for (const double height : sheets) result.add(height + moved + sigma * normal(random));
  return result;
}

TEST(HeightProfile, CountsInBinsAndIgnoresTheRest) {
  HeightProfile p(1);
  for (const double h : {-0.95, -0.95, 0.05, 1.5, -3.0, std::nan("")}) p.add(h);
  EXPECT_EQ(p.bins(), 20);
  EXPECT_EQ(p.count(0), 2);
  EXPECT_EQ(p.count(10), 1);
  EXPECT_NEAR(p.centre(10), 0.05, 1e-12);
  double sum = 0;
  for (int b = 0; b < p.bins(); ++b) sum += p.count(b);
  EXPECT_EQ(sum, 3);
}

TEST(HeightProfile, SmoothingKeepsTheSumAwayFromTheEnds) {
  const HeightProfile p = profile({0}, 0.3, 1000, 1), s = p.smoothed(0.5);
  double before = 0, after = 0;
  for (int b = 0; b < p.bins(); ++b) before += p.count(b), after += s.count(b);
  EXPECT_NEAR(before, after, 1e-9 * before);
  EXPECT_LT(s.max(), p.max());
}

TEST(HeightProfile, FindsTheShift) {
  for (const double moved : {-2.5, -0.4, 0.0, 1.0, 2.9})
    for (const double sigma : {0.1, 1.0}) {
      const HeightProfile before = profile({0}, sigma, 800, 1), now = profile({0}, sigma, 800, 2, moved, 20);
      EXPECT_NEAR(before.shift_of(now.smoothed(0.3), 3), moved, 0.1 + 0.3 * sigma) << moved << " " << sigma;
    }
}

// Both sheets must match: a shift by the distance between the sheets matches only one of them.
TEST(HeightProfile, ASecondSheetMakesTheShiftUnique) {
  const HeightProfile before = profile({0, -3}, 0.2, 500, 1), now = profile({0, -3}, 0.2, 500, 2, 1.8, 20);
  EXPECT_NEAR(before.shift_of(now.smoothed(0.3), 3), 1.8, 0.15);
}

TEST(HeightProfile, AValleyLiesBetweenTwoSheets) {
  const HeightProfile p = profile({0, -3}, 0.4, 400, 1).smoothed(0.2);
  EXPECT_NEAR(p.valley_from(0, -1), 1.5, 0.6);
  EXPECT_EQ(p.valley_from(0, 1), 30);  // no valley above: returns 2 half_range
}

TEST(HeightProfile, AnEmptyProfileHasNoValley) {
  EXPECT_EQ(HeightProfile().valley_from(0, 1), 0);
}

// One sheet shows no valley, whatever its noise. Chance may make one in at most 1 of 200 draws.
TEST(HeightProfile, NoiseMakesNoValleys) {
  int wrong = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const double sigma = 0.2 + 0.014 * seed;
    const HeightProfile p = profile({0}, sigma, 1200, seed).smoothed(std::max(0.2, 0.5 * sigma));
    const double max = 3.5 * sigma;
    wrong += p.valley_from(0, 1) < max || p.valley_from(0, -1) < max ? 1 : 0;
  }
  EXPECT_LE(wrong, 1);
}

HeightMap plane(double height, double slope_u, double error) {
  HeightMap map;
  map.set_plane(height, slope_u, 0, 20);
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) map.node(i, j).error = error;
  map.fill_cells();
  return map;
}

// A change x is kept as x^3 / (x^2 + 4 e^2), where e is 1.5 times the error of a node.
TEST(HeightMap, SteadyKeepsWhatNoiseDoesNotExplain) {
  const double error = 0.1, e = 1.5 * error;
  for (const double x : {0.0, 0.05, 0.3, 3.0}) {
    HeightMap map = plane(1 + x, 0, error);
    map.shrink_change_since(plane(1, 0, error));
    EXPECT_NEAR(map.height(0.3, -2.1), 1 + x * x * x / (x * x + 4 * e * e), 1e-12) << x;
  }
}

TEST(HeightMap, SteadyKeepsARotationThatIsLarge) {
  HeightMap map = plane(0, 0.5, 0.01);
  map.shrink_change_since(plane(0, 0, 0.01));
  EXPECT_NEAR(map.slopes(0.2, 0.3).u, 0.5, 0.01);
}

TEST(HeightMap, SteadyLeavesNodesThatOneOfTheMapsDoesNotCover) {
  HeightMap map = plane(2, 0, 0.1), earlier = plane(1.9, 0, 0.1);
  earlier.node(8, 8).covered = false;
  map.shrink_change_since(earlier);
  EXPECT_EQ(map.node(8, 8).height, 2);
  EXPECT_NE(map.node(8, 9).height, 2);
}

// A node without a plane takes the largest error around it: it must not seem the most certain one.
TEST(HeightMap, ErrorOfANodeWithoutAPlaneIsThatOfItsNeighbours) {
  HeightMap map = plane(0, 0, 0.1);
  map.node(8, 8) = {};
  map.node(9, 9).error = 0.2;
  EXPECT_EQ(map.error(0.1, -0.1), 0.2);
  EXPECT_EQ(map.error(-1, 0), 0.1);
  for (int j = 7; j <= 9; ++j)
    for (int i = 7; i <= 9; ++i) map.node(i, j) = {};
  EXPECT_TRUE(std::isinf(map.error(0, 0)));
  EXPECT_EQ(map.error(1, 1), 0.1);
}

}  // namespace
}  // namespace remote_touch::height_map_test
