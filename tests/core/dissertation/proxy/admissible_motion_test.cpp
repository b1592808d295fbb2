// admissible_motion() enters none of the touching regions. It is compared with all pairs of them, in any
// order of the points.
#include "core/dissertation/proxy/admissible_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "tests/core/dissertation/proxy/union_of_spheres.h"
#include "tests/support/scenes.h"

namespace remote_touch::admissible_motion_test {
namespace {

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

// Numbers so small that rounding is as large as they are: the rounds go in a circle.
TEST(TouchingRegions, AMotionThatIsNotFoundIsNotZero) {
  const PointCloud cloud =
      touching({Vec3(-2, 2, -1).normalized(), Vec3(1, -1, 1).normalized(), Vec3::UnitZ()});
  const Vec3 u(-3, 18, -8);
  EXPECT_EQ(found_motion(cloud, std::numeric_limits<double>::denorm_min() * u), std::nullopt);
  EXPECT_TRUE(found_motion(cloud, 1e-3 * u));
}

TEST(TouchingRegions, TheOrderOfThePointsDoesNotMatter) {
  spheres::Draw draw(2);
  std::mt19937 random(3);
  for (int round = 0; round < 5000; ++round) {
    std::vector<Vec3> normals = whole_normals(draw);
    const Vec3 u = draw.in_cube(0.01), s = motion(touching(normals), u);
    for (int again = 0; again < 3; ++again) {
      std::shuffle(normals.begin(), normals.end(), random);
      ASSERT_EQ(motion(touching(normals), u), s) << round;
    }
  }
}

// The touching normals in a groove all lie in one plane, so any two of them leave the same line.
TEST(TouchingRegions, TheOrderOfThePointsDoesNotMatterInAGroove) {
  ProxyParameters p;
  p.contact_motion = ContactMotion::regions;
  int together = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    spheres::Draw draw(seed);
    const Vec3 along = draw.direction(), side = along.cross(draw.direction()).normalized(),
               up = along.cross(side);
    const int count = 3 + static_cast<int>(seed % 3);
    std::vector<Vec3> normals;
    for (int k = 0; k < count; ++k) {
      const double angle = 0.4 + 2.34 * k / (count - 1) + draw.between(-0.05, 0.05);
      normals.push_back(std::cos(angle) * side + std::sin(angle) * up);
    }
    ProxyRenderer renderer = scenes::renderer(p), reversed = scenes::renderer(p);
    renderer.on_frame(scenes::frame(touching(normals)));
    std::reverse(normals.begin(), normals.end());
    reversed.on_frame(scenes::frame(touching(normals)));
    for (int tick = 0; tick < 1500; ++tick) {
      const Vec3 hip = (0.01 - 0.00002 * tick) * up + 0.004 * std::sin(0.007 * tick) * side;
      const RenderOutput out = renderer.step({hip}, 0.001 * tick);
      ASSERT_EQ(out.proxy_W, reversed.step({hip}, 0.001 * tick).proxy_W) << seed << " " << tick;
      together += out.contact_count > 2;
    }
  }
  EXPECT_GT(together, 1000);
}

}  // namespace
}  // namespace remote_touch::admissible_motion_test
