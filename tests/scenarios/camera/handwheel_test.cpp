#include "scenarios/camera/handwheel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::handwheel_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kCentre(0.02, -0.03, 0.06);
constexpr double kRing_m = 0.045;
const Handwheel kWheel(kCentre, kRing_m);

// Oracle for the parts, tubes about a curve and cylinders: each has an inequality of its own, and samples.
struct Cylinder {
  double radius, low, high;
  bool holds(const Vec3& q) const { return std::hypot(q.x(), q.y()) < radius && q.z() > low && q.z() < high; }
};
const Cylinder kHub{Handwheel::kHubRadius_m, -Handwheel::kHubHalfLength_m, Handwheel::kHubHalfLength_m};
const Cylinder kStem{Handwheel::kStemRadius_m, -kCentre.z(), 0};

Vec3 spoke(int i) {
  const double angle = std::numbers::pi / 2 + i * 2 * std::numbers::pi / 3;
  return {std::cos(angle), std::sin(angle), 0};
}

bool inside_ring(const Vec3& q) {
  const Vec3 middle = kRing_m * Vec3(q.x(), q.y(), 0).normalized();
  return (q - middle).norm() < Handwheel::kTubeRadius_m;
}
bool inside_spoke(const Vec3& q, int i) {
  const double along = std::min(std::max(q.dot(spoke(i)), 0.0), kRing_m);
  return (q - along * spoke(i)).norm() < Handwheel::kSpokeRadius_m;
}
bool inside(const Vec3& p) {
  const Vec3 q = p - kCentre;
  bool any = inside_ring(q) || kHub.holds(q) || kStem.holds(q);
  for (int i = 0; i < 3; ++i) any |= inside_spoke(q, i);
  return any;
}

// Samples of the surfaces of all parts, in rings about 0.7 mm apart. Samples inside another part are left
// out.
class Surface {
 public:
  Surface() {
    constexpr int kAround = 420;
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      add_circle(kRing_m * out, out, Vec3::UnitZ(), Handwheel::kTubeRadius_m, 70);
    }
    for (int i = 0; i < 3; ++i)
      for (double along = 0; along <= kRing_m; along += 0.0005)
        add_circle(along * spoke(i), spoke(i).cross(Vec3::UnitZ()), Vec3::UnitZ(), Handwheel::kSpokeRadius_m,
                   60);
    for (const Cylinder& c : {kHub, kStem}) {
      for (double z = c.low; z <= c.high; z += 0.0005)
        add_circle({0, 0, z}, Vec3::UnitX(), Vec3::UnitY(), c.radius, 120);
      for (double r = 0; r <= c.radius; r += 0.0005) {
        add_circle({0, 0, c.low}, Vec3::UnitX(), Vec3::UnitY(), r, 120, -Vec3::UnitZ());
        add_circle({0, 0, c.high}, Vec3::UnitX(), Vec3::UnitY(), r, 120, Vec3::UnitZ());
      }
    }
  }
  double nearest(const Vec3& p) const {
    double squared = kInfinity;
    for (const Vec3& s : samples_) squared = std::min(squared, (s - p).squaredNorm());
    return std::sqrt(squared);
  }

 private:
  // The normal points away from the middle of the circle, unless it is given.
  void add_circle(const Vec3& middle, const Vec3& one, const Vec3& other, double radius, int count,
                  const Vec3& normal = Vec3::Zero()) {
    for (int j = 0; j < count; ++j) {
      const double angle = 2 * std::numbers::pi * j / count;
      const Vec3 out = std::cos(angle) * one + std::sin(angle) * other;
      const Vec3 p = kCentre + middle + radius * out;
      if (!inside(p + 1e-9 * (normal.isZero() ? out : normal))) samples_.push_back(p);
    }
  }
  std::vector<Vec3> samples_;
};

std::vector<Vec3> places(int count, double half_width, unsigned seed) {
  const PointCloud at = scenes::random_cloud(count, half_width, seed);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < at.size(); ++i) places.push_back(kCentre + at.point(i));
  return places;
}

TEST(Handwheel, TheDistanceOutsideIsThatToTheNearestSample) {
  const Surface surface;
  int outside = 0;
  for (const Vec3& p : places(500, 0.08, 1)) {
    const double distance = kWheel.signed_distance(p), nearest = surface.nearest(p);
    ASSERT_EQ(distance < 0, inside(p)) << p.transpose();
    if (distance < 0) {
      EXPECT_GE(nearest, -distance - 1e-12) << "inside, the depth is at least the returned one";
      continue;
    }
    ++outside;
    EXPECT_LE(distance, nearest + 1e-12) << p.transpose();
    EXPECT_GE(distance, nearest - 0.0007) << p.transpose();
  }
  EXPECT_GT(outside, 300);
}

TEST(Handwheel, HasTheKnownDistances) {
  const auto at = [&](double x, double y, double z) {
    return kWheel.signed_distance(kCentre + Vec3(x, y, z));
  };
  EXPECT_NEAR(at(0, 0, 0.03), 0.02, 1e-15) << "before the hub";
  EXPECT_NEAR(at(0, 0.062, 0), 0.010, 1e-15) << "above the ring";
  EXPECT_NEAR(at(0.045, 0, 0.017), 0.010, 1e-15) << "before the ring";
  EXPECT_NEAR(at(0, 0.025, 0.0145), 0.010, 1e-15) << "before the upper spoke";
  EXPECT_NEAR(at(0, -0.025, 0), 0.013, 1e-15) << "between two spokes, above the ring";
  EXPECT_NEAR(at(0.018, 0, -0.040), 0.010, 1e-15) << "beside the stem";
  EXPECT_NEAR(at(0.014, 0, 0.014), 0.005, 1e-15) << "off the hub's edge";
  EXPECT_NEAR(at(0.045, 0, 0), -0.007, 1e-15) << "in the middle of the tube";
}

// Compares cast(), from cameras all around, with a march of small steps to the first position inside.
TEST(Handwheel, RaysHitItWhereAMarchDoes) {
  const std::vector<Vec3> origins = places(400, 0.5, 2), targets = places(400, 0.07, 3);
  int hits = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (inside(origins[i])) continue;
    const Vec3 ray = (0.1 + 0.01 * static_cast<double>(i)) * (targets[i] - origins[i]).normalized();
    const double t = kWheel.cast(origins[i], ray), step = 1e-4 / ray.norm();
    double found = kInfinity;
    for (double s = 0; s * ray.norm() < 1.5 && std::isinf(found); s += step)
      if (inside(origins[i] + s * ray)) {
        double low = s - step, high = s;
        for (int k = 0; k < 50; ++k)
          (inside(origins[i] + (low + high) / 2 * ray) ? high : low) = (low + high) / 2;
        found = high;
      }
    if (std::isinf(found) && !std::isinf(t)) {
      // The march can step over slivers. The hit of cast() must still be on the surface.
      EXPECT_LE(std::abs(kWheel.signed_distance(origins[i] + t * ray)), 1e-9);
      continue;
    }
    ASSERT_EQ(std::isinf(t), std::isinf(found)) << i;
    if (std::isinf(t)) continue;
    ++hits;
    EXPECT_LE(std::abs(kWheel.signed_distance(origins[i] + t * ray)), 1e-9) << i;
    EXPECT_LE(t * ray.norm(), found * ray.norm() + 1e-9) << i;
    // If cast() hits earlier, the march has stepped over a sliver within the last 10 mm.
    EXPECT_GE(t * ray.norm(), found * ray.norm() - 0.01) << i;
  }
  EXPECT_GT(hits, 80);
}

// cast() and signed_distance() agree: no ray hits the surface before it has travelled the distance.
TEST(Handwheel, NoRayMeetsItBeforeTheDistance) {
  const std::vector<Vec3> directions = places(20, 1, 4);
  for (const Vec3& p : places(200, 0.1, 5)) {
    const double distance = kWheel.signed_distance(p);
    for (const Vec3& displacement : directions)
      EXPECT_GE(kWheel.cast(p, displacement.normalized()), std::max(0.0, distance - 1e-8)) << p.transpose();
  }
}

TEST(Handwheel, ARayFromInsideHitsAtOnceAndARayAwayMisses) {
  EXPECT_EQ(kWheel.cast(kCentre, {0, 0, 1}), 0);
  EXPECT_EQ(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, 1}), kInfinity);
  EXPECT_NEAR(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, -1}), 0.19, 1e-9);
  EXPECT_NEAR(kWheel.cast(kCentre + Vec3(0, 0, 0.2), {0, 0, -0.5}), 0.38, 2e-9) << "t counts in rays";
}

TEST(Handwheel, NormalsPointAwayFromTheSurface) {
  const auto at = [&](double x, double y, double z) { return kWheel.normal(kCentre + Vec3(x, y, z)); };
  EXPECT_NEAR((at(0, 0, 0.010) - Vec3(0, 0, 1)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.052, 0, 0) - Vec3(1, 0, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.038, 0, 0) - Vec3(-1, 0, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((at(0.008, 0, -0.040) - Vec3(1, 0, 0)).norm(), 0, 1e-8);
}

TEST(Handwheel, ALargerRingIsStillOnItsSpokes) {
  const Handwheel wheel({0, 0, 0.1}, 0.12);
  EXPECT_NEAR(wheel.signed_distance({0, 0.137, 0.1}), 0.010, 1e-15);
  EXPECT_NEAR(wheel.signed_distance({0, 0.09, 0.1}), -0.0045, 1e-15);
  EXPECT_FALSE(std::isinf(wheel.cast({0.12, 0, 1}, {0, 0, -1}))) << "the ball that holds it grew with it";
}

}  // namespace
}  // namespace remote_touch::handwheel_test
