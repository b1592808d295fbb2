// Fitting the heights of a patch: planes, curvature, edges and noise against closed forms and brute force.
#include "core/beyond/tracked_surface/height_fit.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/scenes.h"

namespace remote_touch::height_fit_test {
namespace {

using Surface = double (*)(double u, double v);

// Points of a grid, 0.3 contact radii apart by default, with noise of standard deviation sigma on all
// coordinates.
PatchPoints sampled(Surface surface, double sigma, unsigned seed, double spacing = 0.3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;  // test data only: its bits need not be the same everywhere
  PatchPoints points(scenes::kernels());
  points.reserve(4000);
  for (double v = -8.1; v <= 8.1; v += spacing)
    for (double u = -8.1; u <= 8.1; u += spacing) {
      const PatchPlace p{PatchFrame::rounded(u + sigma * normal(random)),
                         PatchFrame::rounded(v + sigma * normal(random)),
                         PatchFrame::rounded(surface(u, v) + sigma * normal(random))};
      if (!(p.u * p.u + p.v * p.v < 64)) continue;
      points.add(p, true);
    }
  return points;
}

HeightMap fitted(const PatchPoints& points, double sigma) {
  HeightFit fit;
  HeightMap map;
  fit.set_points(points, fit_trend(points, std::max(sigma, 0.01)));
  fit.fit(sigma, map);
  return map;
}

double tilted(double u, double v) {
  return 0.3 + 0.2 * u - 0.1 * v;
}
double ball(double u, double v) {  // radius: ten contact radii
  return std::sqrt(std::max(0.0, 100 - u * u - v * v)) - 10;
}
double ridge(double u, double) {
  return -0.5 * std::abs(u - 0.4);
}

TEST(HeightFit, FitsAPlaneExactly) {
  const HeightMap map = fitted(sampled(tilted, 0, 1), 0);
  for (double u = -6; u <= 6; u += 0.37)
    for (double v = -4; v <= 4; v += 0.41) EXPECT_NEAR(map.height(u, v), tilted(u, v), 3e-4);
  EXPECT_NEAR(map.slopes(1, 1).u, 0.2, 1e-3);
  EXPECT_NEAR(map.slopes(1, 1).v, -0.1, 1e-3);
}

// The mean over many draws. Noise along the ball's sides lowers the fitted height by sigma^2 / R, and a ball
// is not exactly quadratic. Fits of planes alone would lie 0.8 below it in the widest window.
TEST(HeightFit, ABallIsNotFlattenedByNoise) {
  for (const double sigma : {0.0, 0.2, 0.6}) {
    double sum = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) sum += fitted(sampled(ball, sigma, seed), sigma).height(0, 0);
    EXPECT_NEAR(sum / 20, -sigma * sigma / 10, 0.04 + 0.05 * sigma) << sigma;
  }
}

// The flanks beside the ridge are found within a few standard errors. A window that crosses the ridge would
// be off by as much as its width.
TEST(HeightFit, WindowsStopAtARidge) {
  const HeightMap map = fitted(sampled(ridge, 0.05, 3), 0.05);
  for (const double u : {-4.0, -2.5, 3.0, 4.5}) EXPECT_NEAR(map.height(u, 0), ridge(u, 0), 0.08) << u;
  EXPECT_NEAR(map.height(0.4, 0), 0, 0.2);
}

// Expected error: sigma / sqrt(n), where n is the number of points in the widest window, 10 by 10 contact
// radii.
TEST(HeightFit, HasTheErrorOfTheWidestWindowOnAPlane) {
  const double sigma = 2;
  double squares = 0;
  HeightMap map;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    map = fitted(sampled([](double, double) { return 0.0; }, sigma, seed), sigma);
    squares += map.height(0, 0) * map.height(0, 0);
  }
  const double expected = sigma / std::sqrt(100 / 0.09);
  EXPECT_NEAR(map.nearest_node(0, 0).error, expected, 0.15 * expected);
  EXPECT_NEAR(std::sqrt(squares / 60), expected, 4 / std::sqrt(2 * 60.0) * expected);  // four standard errors
}

TEST(HeightFit, DistinguishesNoiseFromEdges) {
  for (const double sigma : {0.02, 0.2, 1.0, 3.0}) {
    HeightFit fit;
    fit.set_points(sampled(ridge, sigma, 7));
    EXPECT_NEAR(fit.noise(), sigma, 0.2 * sigma) << sigma;
  }
  HeightFit clean;
  clean.set_points(sampled(ridge, 0, 7));
  EXPECT_LT(clean.noise(), 1e-3);
}

TEST(HeightFit, TooFewPointsHaveNoMeasuredNoise) {
  HeightFit fit;
  fit.set_points(PatchPoints(scenes::kernels()));
  EXPECT_TRUE(std::isnan(fit.noise()));
  PatchPoints few(scenes::kernels());
  few.reserve(3);
  for (const double u : {-6.0, 0.0, 6.0}) few.add({u, 0, 0.3 * u}, true);
  fit.set_points(few);
  EXPECT_TRUE(std::isnan(fit.noise()));
}

// All sums are exact, so the order of the terms does not change them.
TEST(HeightFit, TheOrderOfThePointsDoesNotMatter) {
  const PatchPoints points = sampled(ball, 1, 5);
  const HeightMap one = fitted(points, 1);
  std::mt19937 random(1);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  PatchPoints shuffled(scenes::kernels());
  shuffled.reserve(points.size());
  for (const std::size_t i : order) shuffled.add(points.place(i), true);
  const HeightMap other = fitted(shuffled, 1);
  for (double u = -7; u <= 7; u += 0.5) EXPECT_EQ(one.height(u, 0.3 * u), other.height(u, 0.3 * u));
}

TEST(HeightFit, MapCoversOnlyPlacesWithPoints) {
  PatchPoints points = sampled(tilted, 0, 1);
  for (std::size_t i = 0; i < points.size(); ++i) points.set_member(i, points.place(i).u < 0);
  HeightMap map = fitted(points, 0);
  EXPECT_TRUE(map.covers(-3, 0));
  EXPECT_FALSE(map.covers(2, 0));
  EXPECT_TRUE(std::isnan(map.height(5, 0)));
  map.extend(8);
  EXPECT_FALSE(map.covers(5, 0));
  EXPECT_NEAR(map.height(5, 0), tilted(5, 0), 0.01);
}

// One point in a window is enough where points are rare everywhere.
TEST(HeightFit, FewPointsCoverToo) {
  const HeightMap map = fitted(sampled(tilted, 0, 1, 1.9), 0);
  int covered = 0;
  for (int i = -3; i <= 3; ++i) covered += map.covers(1.9 * i + 0.4, 0.5) ? 1 : 0;
  EXPECT_GE(covered, 5);
}

TEST(HeightMap, MovesAsAPlane) {
  HeightMap map = fitted(sampled(ball, 0, 1), 0);
  const double before = map.height(2, -3);
  map.add_plane(0.5, 0.1, -0.2);
  EXPECT_NEAR(map.height(2, -3), before + 0.5 + 0.2 + 0.6, 1e-12);
}

// The trend equals the least-squares solution from a QR decomposition of all six terms.
TEST(Trend, IsTheQuadraticOfLeastSquares) {
  const PatchPoints points = sampled(ball, 0.3, 11);
  std::vector<PatchPlace> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PatchPlace p = points.place(i);
    if (p.u * p.u + p.v * p.v <= kTrendRadius * kTrendRadius) near.push_back(p);
  }
  Eigen::MatrixXd a(static_cast<Eigen::Index>(near.size()), 6);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const PatchPlace& p = near[static_cast<std::size_t>(i)];
    a.row(i) << 1, p.u, p.v, p.u * p.u, p.u * p.v, p.v * p.v;
    b[i] = p.h;
  }
  const Eigen::VectorXd c = a.colPivHouseholderQr().solve(b);
  const Trend trend = fit_trend(points, 1e-6);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(trend.c[i], c[i], 1e-4) << i;
}

// James-Stein shrinkage: a curvature that chance explains is set to zero in most draws.
TEST(Trend, NoiseHasNoCurvature) {
  int kept = 0;
  for (unsigned seed = 1; seed <= 50; ++seed)
    kept += fit_trend(sampled(tilted, 1, seed), 1).c[3] != 0 ? 1 : 0;
  EXPECT_LT(kept, 15);
  // Expected: -1 / 20, and -36 / 8000 from the fourth powers of a ball within 6 contact radii. The standard
  // error is sqrt(18 / n) / 36 = 0.0033 with n = 1260 points.
  EXPECT_NEAR(fit_trend(sampled(ball, 1, 1), 1).c[3], -0.0545, 3 * 0.0033);
}

TEST(Trend, FewPointsHaveNone) {
  PatchPoints points(scenes::kernels());
  points.reserve(20);
  for (int i = 0; i < 20; ++i) points.add({0.1 * i, 0.01 * i * i, 1}, true);
  for (const double c : fit_trend(points, 0.01).c) EXPECT_EQ(c, 0);
}

// Points on two lines fit any curvature between the lines, so even many points do not determine it.
TEST(Trend, PointsThatDoNotDetermineACurvatureHaveNone) {
  PatchPoints points(scenes::kernels());
  points.reserve(400);
  for (int i = 0; i < 400; ++i) points.add({i % 2 ? 1.0 : -1.0, 0.01 * (i - 200), 0.3}, true);
  for (const double c : fit_trend(points, 0.01).c) EXPECT_EQ(c, 0);
}

}  // namespace
}  // namespace remote_touch::height_fit_test
