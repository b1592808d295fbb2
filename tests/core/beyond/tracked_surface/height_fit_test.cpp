// The heights of a tracked sheet: kernels against code for one point, fits against closed forms and brute
// force.
#include "core/beyond/tracked_surface/height_fit.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/kernels/kernels.h"
#include "tests/support/scenes.h"

namespace remote_touch::height_fit_test {
namespace {

// The kernels of every level select, measure and add the points of a patch. The results must equal those of
// the code for one point.

constexpr double kUnit = 0.005;
const PatchRegion kRegion{PatchFrame(Vec3(0.01, 0, -0.01), Vec3(1, 2, 3).normalized(), kUnit), 8, 6};

GatheredPoints gathered_points() {
  PointCloud cloud = scenes::random_cloud(5003, 0.06, 3);
  for (std::size_t i = 0; i < cloud.size(); i += 97) cloud.y[i] = std::numeric_limits<double>::quiet_NaN();
  return scenes::gathered(BruteForceSearch(cloud));
}

HeightMap bumpy_map() {
  HeightMap map;
  map.set_plane(0.3, 0.2, -0.1, 6);  // the corners are unknown
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) map.node(i, j).height += 0.01 * ((7 * i + 3 * j) % 11);
  map.fill_cells();
  return map;
}

PatchPoints taken(const Kernels& kernels, const GatheredPoints& gathered) {
  PatchPoints points(kernels);
  points.reserve(gathered.size());
  points.set_points(gathered, kRegion);
  for (std::size_t i = 0; i < points.size(); ++i) points.set_member(i, i % 3 != 0);
  points.set_residuals(bumpy_map());
  return points;
}

// Their residuals are heights above the map, where it is known.
TEST(PatchPoints, AreThePointsOfTheRegionInItsFrame) {
  const GatheredPoints gathered = gathered_points();
  const PointsView all = gathered.view();
  const HeightMap map = bumpy_map();
  for (const Kernels* kernels : supported_kernels()) {
    SCOPED_TRACE(kernels->isa);
    const PatchPoints points = taken(*kernels, gathered);
    std::size_t next = 0;
    int unknown = 0;
    for (std::size_t i = 0; i < gathered.size(); ++i) {
      const PatchPlace p = kRegion.frame.place(Vec3(all.x[i], all.y[i], all.z[i]));
      if (!kRegion.holds(p)) continue;
      ASSERT_LT(next, points.size());
      EXPECT_EQ(points.source(next), i);
      const PatchPlace q = points.place(next);
      EXPECT_TRUE(p.u == q.u && p.v == q.v && p.h == q.h) << i;
      const double expected = p.h - map.height(p.u, p.v), residual = points.residual(next++);
      EXPECT_TRUE(residual == expected || (std::isnan(residual) && std::isnan(expected))) << i;
      unknown += std::isnan(expected) ? 1 : 0;
    }
    EXPECT_EQ(next, points.size());
    EXPECT_GT(next, 500u);
    EXPECT_GT(unknown, 10);
  }
}

// Points on the rim are outside, for the kernels as for PatchRegion::holds().
TEST(PatchPoints, TheRimIsOutside) {
  const PatchRegion region{PatchFrame(Vec3::Zero(), Vec3::UnitY(), 1), 8, 6};
  PointCloud cloud;
  for (const double r : {8.0, 7.75, 8.25})
    for (const Vec3& towards : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0)}) cloud.append(r * towards);
  const GatheredPoints gathered = scenes::gathered(BruteForceSearch(cloud));
  for (const Kernels* kernels : supported_kernels()) {
    PatchPoints points(*kernels);
    points.reserve(gathered.size());
    points.set_points(gathered, region);
    ASSERT_EQ(points.size(), 3u) << kernels->isa;
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_TRUE(region.holds(points.place(i)));
  }
}

TEST(PatchRegion, ItsBallHoldsItsRim) {
  const Ball ball = kRegion.around();
  const double corner_m = std::hypot(kRegion.radius, kRegion.half_height) * kUnit;
  EXPECT_GE(ball.radius, corner_m);
  EXPECT_LE(ball.radius, 1.000001 * corner_m);
}

TEST(PatchPoints, TheProfileCountsThemOneByOne) {
  const GatheredPoints gathered = gathered_points();
  const PatchPlace proxy{1, -2, 0.5};
  for (const Kernels* kernels : supported_kernels()) {
    const PatchPoints points = taken(*kernels, gathered);
    const HeightProfile profile = points.profile_near(proxy, 5, 3);
    HeightProfile expected(3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      if ((p.u - 1) * (p.u - 1) + (p.v + 2) * (p.v + 2) <= 25) expected.add(points.residual(i));
    }
    ASSERT_EQ(profile.bins(), expected.bins());
    EXPECT_GT(expected.max(), 3);
    for (int bin = 0; bin < profile.bins(); ++bin)
      EXPECT_EQ(profile.count(bin), expected.count(bin)) << kernels->isa << " bin " << bin;
  }
}

// All terms are multiples of a power of two, so the order in which they are added does not change the sums.
TEST(PatchPoints, SumsAreThoseAddedOneByOne) {
  const GatheredPoints gathered = gathered_points();
  const NearPlane plane{1, -2, 5, 0.4, 0.1, -0.2, 1.5};
  for (const Kernels* kernels : supported_kernels()) {
    const PatchPoints points = taken(*kernels, gathered);
    const PlaneSums near = points.sums_near(plane);
    const QuadraticSums quadratic = points.sums_of_quadratic(6);
    double n = 0, vv = 0, uh = 0, members = 0, u3v = 0, v2h = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      const double off = points.residual(i) - 0.4 - 0.1 * p.u + 0.2 * p.v;
      if (std::abs(off) <= 1.5 && (p.u - 1) * (p.u - 1) + (p.v + 2) * (p.v + 2) <= 25)
        n += 1, vv += p.v * p.v, uh += p.u * PatchFrame::rounded(points.residual(i));
      if (!points.is_member(i) || !(p.u * p.u + p.v * p.v <= 36)) continue;
      const double uu = PatchFrame::rounded(p.u * p.u), uv = PatchFrame::rounded(p.u * p.v);
      members += 1, u3v += uu * uv, v2h += PatchFrame::rounded(p.v * p.v) * p.h;
    }
    EXPECT_GT(n, 50);
    EXPECT_EQ(near.n, n) << kernels->isa;
    EXPECT_EQ(near.vv, vv) << kernels->isa;
    EXPECT_EQ(near.uh, uh) << kernels->isa;
    EXPECT_EQ(quadratic.power[0], members) << kernels->isa;
    EXPECT_EQ(quadratic.power[11], u3v) << kernels->isa;
    EXPECT_EQ(quadratic.with_h[5], v2h) << kernels->isa;
  }
}

// Fitting the heights of a patch: planes, curvature, edges and noise against closed forms and brute force.

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

// Points on two lines fit any curvature between the lines, so even many points do not determine it.
TEST(Trend, FewPointsAndThoseThatDoNotDetermineACurvatureHaveNone) {
  PatchPoints few(scenes::kernels()), lines(scenes::kernels());
  few.reserve(20), lines.reserve(400);
  for (int i = 0; i < 20; ++i) few.add({0.1 * i, 0.01 * i * i, 1}, true);
  for (int i = 0; i < 400; ++i) lines.add({i % 2 ? 1.0 : -1.0, 0.01 * (i - 200), 0.3}, true);
  for (const PatchPoints* points : {&few, &lines})
    for (const double c : fit_trend(*points, 0.01).c) EXPECT_EQ(c, 0);
}

// Profile of `points` points on each of the sheets, with noise sigma.
HeightProfile profile(const std::vector<double>& sheets, double sigma, int points, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;  // test data only
  HeightProfile result(15);
  for (int i = 0; i < points; ++i)
    for (const double height : sheets) result.add(height + sigma * normal(random));
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

TEST(HeightProfile, AValleyLiesBetweenTwoSheets) {
  const HeightProfile p = profile({0, -3}, 0.4, 400, 1).smoothed(0.2);
  EXPECT_NEAR(p.valley_from(0, -1), 1.5, 0.6);
  EXPECT_EQ(p.valley_from(0, 1), 30);  // no valley above: returns 2 half_range
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

HeightMap plane(double height, double error) {
  HeightMap map;
  map.set_plane(height, 0, 0, 20);
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) map.node(i, j).error = error;
  map.fill_cells();
  return map;
}

// A change x is kept as x^3 / (x^2 + 4 e^2), where e is 1.5 times the error of a node.
TEST(HeightMap, SteadyKeepsWhatNoiseDoesNotExplain) {
  const double error = 0.1, e = 1.5 * error;
  for (const double x : {0.0, 0.05, 0.3, 3.0}) {
    HeightMap map = plane(1 + x, error);
    map.shrink_change_since(plane(1, error));
    EXPECT_NEAR(map.height(0.3, -2.1), 1 + x * x * x / (x * x + 4 * e * e), 1e-12) << x;
  }
}

TEST(HeightMap, SteadyLeavesNodesThatOneOfTheMapsDoesNotCover) {
  HeightMap map = plane(2, 0.1), earlier = plane(1.9, 0.1);
  earlier.node(8, 8).covered = false;
  map.shrink_change_since(earlier);
  EXPECT_EQ(map.node(8, 8).height, 2);
  EXPECT_NE(map.node(8, 9).height, 2);
}

// A node without a plane takes the largest error around it: it must not seem the most certain one.
TEST(HeightMap, ErrorOfANodeWithoutAPlaneIsThatOfItsNeighbours) {
  HeightMap map = plane(0, 0.1);
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
}  // namespace remote_touch::height_fit_test
