// Exits from regions that enclose the proxy, regions that grow, and motions that touching regions allow.
#include "core/dissertation/proxy/proxy_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "tests/core/dissertation/proxy/union_of_spheres.h"
#include "tests/support/scenes.h"

namespace remote_touch::region_motion_test {
namespace {

const ProxyParameters kDefault;

Neighbourhood neighbourhood(const PointCloud& cloud) {
  return scenes::neighbourhood(make_search(cloud), kDefault.r3_m);
}

// Two balls that overlap, the proxy between them.
PointCloud two_balls(double half_distance_m, double radius_m) {
  PointCloud cloud = scenes::cloud_of({{-half_distance_m, 0, 0}, {half_distance_m, 0, 0}});
  cloud.fixture_radius_m = {radius_m, radius_m};
  return cloud;
}

// The exit leads along the normal, in the plane between the balls, to the height of a right triangle.
TEST(StraightExit, LeavesTwoBallsInThePlaneBetweenThem) {
  const double a = 0.01, radius_m = 0.02, reach_m = radius_m + kDefault.contact_radius_m();
  Neighbourhood near = neighbourhood(two_balls(a, radius_m));
  for (const double sign : {1.0, -1.0}) {
    const auto exit =
        straight_exit(near, scenes::kernels(), Vec3::Zero(), sign * Vec3::UnitY(), {1e-3, 0, 0}, kDefault);
    ASSERT_TRUE(exit);
    const Vec3 expected(0, sign * std::sqrt(reach_m * reach_m - a * a), 0);
    EXPECT_LT((*exit - expected).norm(), 1e-12) << "or to a side, which is as far";
  }
}

// The centres lie in a row along the normal, so the shortest line out leads to the side.
PointCloud three_balls() {
  PointCloud cloud = scenes::cloud_of({{0, 0, 0}, {0, 0.03, 0}, {0, 0.06, 0}});
  cloud.fixture_radius_m = {0.02, 0.02, 0.02};
  return cloud;
}

// The direction of u is one of the lines, however short u is. No other line is shorter.
TEST(StraightExit, OnlyTheDirectionOfTheDisplacementMatters) {
  Neighbourhood near = neighbourhood(three_balls());
  for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3(1, 0, 1).normalized())})
    for (const int exponent : {0, -10, -30, -100}) {
      const auto exit = straight_exit(near, scenes::kernels(), 0.001 * direction, Vec3::UnitY(),
                                      std::ldexp(1, exponent) * direction, kDefault);
      ASSERT_TRUE(exit);
      EXPECT_LT((*exit - (0.02 + kDefault.contact_radius_m()) * direction).norm(), 1e-12) << exponent;
    }
}

// Rows of balls along all nine lines. The end of a ball lies in the next one, so every ball is an exit.
PointCloud rows_of_balls(int count) {
  constexpr double kBall_m = 0.02;
  const double apart_m = 1.5 * (kBall_m + kDefault.contact_radius_m());
  PointCloud cloud;
  cloud.append(Vec3::Zero());
  for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(0, 1, 1), Vec3(0, 1, -1),
                                Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    for (int k = 1; k < count; ++k) cloud.append(k * apart_m * direction.normalized());
  cloud.fixture_radius_m.assign(cloud.size(), kBall_m);
  return cloud;
}

TEST(StraightExit, LeavesAsManyRegionsAsItMay) {
  for (const int count : {kMaxExits - 1, kMaxExits, kMaxExits + 1}) {
    Neighbourhood near = neighbourhood(rows_of_balls(count));
    const auto exit =
        straight_exit(near, scenes::kernels(), Vec3::Zero(), Vec3::UnitY(), {1e-3, 0, 0}, kDefault);
    EXPECT_EQ(exit.has_value(), count <= kMaxExits) << count;
  }
}

// The nearest exit would lead against the normal.
TEST(StraightExit, NeverGoesAgainstTheNormal) {
  Neighbourhood near = neighbourhood(two_balls(0, 0.02));
  const auto exit =
      straight_exit(near, scenes::kernels(), {0, -0.019, 0}, Vec3::UnitY(), {0, -1e-3, 0}, kDefault);
  ASSERT_TRUE(exit);
  EXPECT_GE(exit->y(), -0.019);
}

// A frame brings random regions around a proxy that touched nothing. The proxy is outside in the same tick,
// unless the closing steps are turned off.
TEST(StraightExit, NoFrameTrapsTheProxy) {
  int trapped = 0, ticks = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const PointCloud cloud = spheres::random_union(700 + seed, 0.05);
    spheres::Draw draw(seed);
    const Vec3 hip_W = draw.in_cube(0.05);
    for (const int exit_steps : {0, 10}) {
      ProxyParameters p;
      p.max_exit_steps = exit_steps;
      ProxyRenderer renderer = scenes::renderer(p);
      renderer.on_frame(scenes::frame(PointCloud{}));
      renderer.step({hip_W}, 0);
      renderer.on_frame(scenes::frame(cloud, 1));
      for (int tick = 1; tick <= 20; ++tick) {
        const RenderOutput out = renderer.step({hip_W}, 0.001 * tick);
        const bool inside = spheres::nearest_region(cloud, out.proxy_W) < p.r1_m - 1e-16;
        if (exit_steps == 0)
          trapped += inside, ++ticks;
        else
          ASSERT_FALSE(inside) << "union " << seed << ", tick " << tick;
      }
    }
  }
  RecordProperty("trapped_ticks_as_printed", trapped);
  EXPECT_GT(trapped, ticks / 100) << "the unions trap where no line leads out";
}

TEST(NearestRegion, IsTheOneWithTheSmallestDistance) {
  Neighbourhood none = neighbourhood(PointCloud{});
  EXPECT_EQ(nearest_region_radius_m(none.around(Vec3::Zero()).view(), Vec3::Zero()), std::nullopt);
  spheres::Draw draw(3);
  for (unsigned seed = 0; seed < 50; ++seed) {
    const PointCloud cloud = spheres::random_union(seed, 0.05);
    Neighbourhood near = neighbourhood(cloud);
    const Vec3 p_W = draw.in_cube(0.05);
    double nearest_m = 1, radius_m = -1;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double distance_m = (p_W - cloud.point(i)).norm() - cloud.fixture_radius_m[i];
      if (distance_m < nearest_m) nearest_m = distance_m, radius_m = cloud.fixture_radius_m[i];
    }
    if (nearest_m > kDefault.r3_m) continue;
    EXPECT_EQ(nearest_region_radius_m(near.around(p_W).view(), p_W), radius_m) << seed;
  }
}

// All numbers are exact in binary, so both distances are equal. The proxy is outside both regions, and then
// inside.
TEST(NearestRegion, IsTheSmallestOfEquallyNearOnesInAnyOrder) {
  constexpr double small_m = 0x1p-8, large_m = 0x1p-7;
  for (const double distance_m : {0x1p-8, -0x1p-9})
    for (const bool small_first : {true, false}) {
      PointCloud cloud;
      for (const double radius_m : {small_first ? small_m : large_m, small_first ? large_m : small_m}) {
        cloud.append((radius_m + distance_m) * (radius_m == small_m ? Vec3::UnitX() : Vec3::UnitZ()));
        cloud.fixture_radius_m.push_back(radius_m);
      }
      Neighbourhood near = neighbourhood(cloud);
      EXPECT_EQ(nearest_region_radius_m(near.around(Vec3::Zero()).view(), Vec3::Zero()), small_m)
          << distance_m << ", " << small_first;
    }
}

// --- regions that grow ---

// A proxy of reach r rests on the points of a grid between r - sag(r) and r above it. The contact shell adds
// r2 - r1.
double sag_m(double reach_m) {
  constexpr double kSpacing_m = 0.0015;
  return reach_m - std::sqrt(reach_m * reach_m - 0.5 * kSpacing_m * kSpacing_m);
}
const double kBand_m = kDefault.r2_m - kDefault.r1_m;

PointCloud raised(double height_m, double radius_m) {
  PointCloud cloud = scenes::flat_grid(60);
  for (double& y : cloud.y) y += height_m;
  cloud.fixture_radius_m.assign(cloud.size(), radius_m);
  return cloud;
}

struct GrowingFrame {
  double height_m, radius_m;
};

// Returns v_hat after each frame at 30 Hz, with the HIP 1 cm below the points.
std::vector<double> estimates(bool growth_is_motion, const std::vector<GrowingFrame>& frames) {
  ProxyParameters p;
  p.growth_is_motion = growth_is_motion, p.steps_per_tick = 100;
  ProxyRenderer renderer = scenes::renderer(p);
  std::vector<double> all;
  for (std::size_t j = 0; j < frames.size(); ++j) {
    renderer.on_frame(scenes::frame(raised(frames[j].height_m, frames[j].radius_m), static_cast<int>(j)));
    RenderOutput out;
    const double hip_m = j == 0 ? 0.02 : frames[j].height_m - 0.01;
    for (int tick = 0; tick < 33; ++tick)
      out = renderer.step({Vec3(0.0002, j == 0 ? hip_m - 0.001 * tick : hip_m, 0.0003)},
                          static_cast<double>(j) / 30 + 0.001 * tick);
    all.push_back(out.surface_velocity_m_per_s);
  }
  return all;
}

// A region of 8 mm appears from one frame to the next: the printed method estimates 0.24 m/s.
TEST(GrowingRegion, CountsAsMotionOnlyIfGrowthIsMotion) {
  const std::vector<GrowingFrame> appears{{0, 0}, {0, 0}, {0, 0.008}, {0, 0.008}};
  const double limit_m_per_s = 30 * (sag_m(kDefault.contact_radius_m()) + kBand_m);  // 4 mm/s
  EXPECT_NEAR(estimates(true, appears)[2], 0.008 * 30, limit_m_per_s);
  for (const double v : estimates(false, appears)) EXPECT_NEAR(v, 0, limit_m_per_s);
}

TEST(GrowingRegion, MotionIsStillSeen) {
  std::vector<GrowingFrame> rises{{0, 0}, {0, 0}};
  for (int j = 1; j < 6; ++j) rises.push_back({0.002 * j, 0.003 * j});
  const double apart = estimates(false, rises).back(), together = estimates(true, rises).back();
  // The reach grows from 17 mm to 20 mm.
  const double limit_m_per_s = 30 * (sag_m(0.012 + kDefault.contact_radius_m()) + kBand_m);  // 1.6 mm/s
  EXPECT_NEAR(apart, 0.002 * 30, limit_m_per_s);
  EXPECT_NEAR(together, 0.005 * 30, limit_m_per_s);
}

// admissible_motion() enters none of the touching regions. It is compared with all pairs of them, in any
// order of the points.

constexpr double kRegion = 0.02, kDistance = 0.025, kR2 = 0.00501;

// Points whose regions touch a proxy at the origin, one for each normal.
PointCloud touching(const std::vector<Vec3>& normals) {
  PointCloud cloud;
  for (const Vec3& n : normals) cloud.append(-kDistance * n);
  cloud.fixture_radius_m.assign(normals.size(), kRegion);
  return cloud;
}

std::optional<Vec3> found_motion(const PointCloud& c, const Vec3& u) {
  const PointsView view{c.x.data(), c.y.data(), c.z.data(), c.fixture_radius_m.data(), nullptr, c.size()};
  return admissible_motion(view, Vec3::Zero(), u, kR2);
}

Vec3 motion(const PointCloud& c, const Vec3& u) {
  return found_motion(c, u).value();
}

// Normals of small whole numbers: many lie in one plane, and some occur twice.
std::vector<Vec3> whole_normals(spheres::Draw& draw) {
  std::vector<Vec3> normals;
  const auto whole = [&] { return std::floor(draw.between(-2, 3)); };
  for (int i = 0; i < 8; ++i) {
    const Vec3 n(whole(), whole(), whole());
    if (n.norm() > 0) normals.push_back(n.normalized());
  }
  return normals;
}

// Distance from u to the nearest motion that no region forbids, among u, its projections onto the plane of
// each region and onto the line of each two planes, and no motion.
double min_change(const std::vector<Vec3>& normals, const Vec3& u) {
  double min = u.norm();  // no motion
  const auto consider = [&](const Vec3& s) {
    for (const Vec3& n : normals)
      if (n.dot(s) < -1e-10 * u.norm()) return;
    min = std::min(min, (s - u).norm());
  };
  consider(u);
  for (const Vec3& a : normals) {
    consider(u - u.dot(a) * a);
    for (const Vec3& b : normals) {
      const Vec3 line = a.cross(b);
      if (line.norm() > 1e-9) consider(line * (line.dot(u) / line.squaredNorm()));
    }
  }
  return min;
}

TEST(TouchingRegions, TheMotionIsTheNearestThatEntersNone) {
  spheres::Draw draw(1);
  int along = 0, held = 0;
  for (int round = 0; round < 5000; ++round) {
    const std::vector<Vec3> normals = whole_normals(draw);
    const Vec3 u = draw.in_cube(0.01), s = motion(touching(normals), u);
    for (const Vec3& n : normals) ASSERT_GE(n.dot(s), -1e-11 * u.norm()) << round;
    ASSERT_NEAR((s - u).norm(), min_change(normals, u), 1e-9 * u.norm()) << round;
    ++(s.isZero(0) ? held : along);
  }
  EXPECT_GT(along, 500);
  EXPECT_GT(held, 500);
}

// A step that a region ended leaves the proxy on its margin, up to rounding. It may go on along the region.
TEST(TouchingRegions, TheProxyGoesOnFromTheMarginOfARegion) {
  spheres::Draw draw(5);
  const double margin_m = 0.5 * (kDefault.r1_m + kDefault.contact_radius_m());
  for (int round = 0; round < 1000; ++round) {
    PointCloud ball = scenes::cloud_of({draw.in_cube(0.5)});
    ball.fixture_radius_m = {draw.between(0.001, 0.05)};
    const Vec3 n = draw.direction(), goal = 5e-4 * n.cross(draw.direction()).normalized();
    const Vec3 p_W = ball.point(0) + (margin_m + ball.fixture_radius_m[0]) * n;
    Neighbourhood near = neighbourhood(ball);
    const Vec3 step = region_step(near, p_W, goal, goal - 0.01 * n, kDefault);
    ASSERT_LT((step - kDefault.gamma * goal).norm(), 1e-12) << round;
  }
}

// Numbers so small that rounding is as large as they are: the rounds go in a circle.
TEST(TouchingRegions, AMotionThatIsNotFoundIsNotZero) {
  const PointCloud cloud =
      touching({Vec3(-2, 2, -1).normalized(), Vec3(1, -1, 1).normalized(), Vec3::UnitZ()});
  const Vec3 u(-3, 18, -8);
  EXPECT_EQ(found_motion(cloud, std::numeric_limits<double>::denorm_min() * u), std::nullopt);
  EXPECT_TRUE(found_motion(cloud, 1e-3 * u));
}

// Normals of a groove: they all lie in one plane, so any two of them leave the same line.
std::vector<Vec3> groove_normals(spheres::Draw& draw) {
  const Vec3 along = draw.direction(), side = along.cross(draw.direction()).normalized(),
             up = along.cross(side);
  std::vector<Vec3> normals;
  const int count = static_cast<int>(draw.between(3, 6));
  for (int k = 0; k < count; ++k) {
    const double angle = 0.4 + 2.34 * k / (count - 1) + draw.between(-0.05, 0.05);
    normals.push_back(std::cos(angle) * side + std::sin(angle) * up);
  }
  return normals;
}

TEST(TouchingRegions, TheOrderOfThePointsDoesNotMatter) {
  spheres::Draw draw(2);
  std::mt19937 random(3);
  for (int round = 0; round < 10000; ++round) {
    std::vector<Vec3> normals = round % 2 == 0 ? whole_normals(draw) : groove_normals(draw);
    const Vec3 u = draw.in_cube(0.01), s = motion(touching(normals), u);
    for (int again = 0; again < 3; ++again) {
      std::shuffle(normals.begin(), normals.end(), random);
      ASSERT_EQ(motion(touching(normals), u), s) << round;
    }
  }
}

}  // namespace
}  // namespace remote_touch::region_motion_test
