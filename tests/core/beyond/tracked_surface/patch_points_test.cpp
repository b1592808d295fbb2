// The kernels of every level select, measure and add the points of a patch. The results must equal those of
// the code for one point.
#include "core/beyond/tracked_surface/patch_points.h"
#include "core/kernels/isa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/beyond/tracked_surface/height_fit.h"
#include "tests/support/scenes.h"

namespace remote_touch::patch_points_test {
namespace {

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

TEST(PatchPoints, AreThePointsOfTheRegionInItsFrame) {
  const GatheredPoints gathered = gathered_points();
  const PointsView all = gathered.view();
  for (const Kernels* kernels : supported_kernels()) {
    const PatchPoints points = taken(*kernels, gathered);
    std::size_t next = 0;
    for (std::size_t i = 0; i < gathered.size(); ++i) {
      const PatchPlace p = kRegion.frame.place(Vec3(all.x[i], all.y[i], all.z[i]));
      if (!kRegion.holds(p)) continue;
      ASSERT_LT(next, points.size()) << kernels->isa;
      EXPECT_EQ(points.source(next), i);
      const PatchPlace q = points.place(next++);
      EXPECT_TRUE(p.u == q.u && p.v == q.v && p.h == q.h) << kernels->isa << " point " << i;
    }
    EXPECT_EQ(next, points.size());
    EXPECT_GT(next, 500u);
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

TEST(PatchPoints, ResidualsAreHeightsAboveTheMap) {
  const GatheredPoints gathered = gathered_points();
  const HeightMap map = bumpy_map();
  for (const Kernels* kernels : supported_kernels()) {
    const PatchPoints points = taken(*kernels, gathered);
    int unknown = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      const double expected = p.h - map.height(p.u, p.v);
      unknown += std::isnan(expected) ? 1 : 0;
      if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(points.residual(i)));
      else
        EXPECT_EQ(points.residual(i), expected) << kernels->isa << " point " << i;
    }
    EXPECT_GT(unknown, 10);
  }
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

}  // namespace
}  // namespace remote_touch::patch_points_test
