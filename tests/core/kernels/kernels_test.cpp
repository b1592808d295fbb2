// The kernels of the proxy and of the search compared with the equations and plain loops, on every
// instruction set level.
#include "core/kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/kernels/point_kernels.h"
#include "tests/support/scenes.h"

namespace remote_touch::kernels_test {
namespace {

using Real = long double;
using std::nextafter;
constexpr double kReach = 0.005;  // r_c
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ProxyRegions kRegions{0.00499, 0.00501, 0.01, 1.5 * 1024, 600};
constexpr double kOnGrid =
    kRegions.sum_grid / 1.5 * 0x1p-53;  // half a step of the grid that terms are rounded to
const Vec3 kOrigin = Vec3::Zero();

PointCloud random_points(int count, double half_width, unsigned seed, bool with_radius, bool with_stiffness) {
  PointCloud cloud = scenes::random_cloud(count, half_width, seed);
  const PointCloud more = scenes::random_cloud(count, 1, seed + 1000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (with_radius) cloud.fixture_radius_m.push_back(0.002 * (more.x[i] + 1));
    if (with_stiffness)
      cloud.stiffness_N_per_m.push_back(i % 5 == 4 ? (i % 2 ? -1 : 1) * std::nan("")
                                                   : 5000 * (more.y[i] + 1));
  }
  return cloud;
}

PointCloud one_point(const Vec3& p, double r_f = 0) {
  PointCloud cloud = scenes::cloud_of({p});
  if (r_f > 0) cloud.fixture_radius_m.push_back(r_f);
  return cloud;
}

GatheredPoints columns(const PointCloud& cloud) {
  return scenes::gathered(BruteForceSearch(cloud));
}

Real radius_of(const PointCloud& cloud, std::size_t i) {
  return cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i];
}

using Vec = equations::Vec<Real>;

// Agrees with (4.1), (4.2), (5.5) and (5.8). A point without a stiffness, NaN, counts with the renderer's.
void expect_query(const ContactQuery& got, const PointCloud& cloud, const Vec3& p) {
  const Vec P = p.cast<Real>();
  Real nearest = kInfinity, weights = 0, stiffness = 0;
  Vec normal = Vec::Zero();
  int touching = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec x = cloud.point(i).cast<Real>();
    const Real r1 = kRegions.r1, r3 = kRegions.r3, r_f = radius_of(cloud, i);
    const Real r = equations::distance(P, x, r_f), psi = equations::weight(r, r1, r3);
    nearest = std::min(nearest, r), touching += r <= kRegions.r2;
    normal += equations::normal_term(P, x, r_f, r1, r3);
    if (cloud.stiffness_N_per_m.empty()) continue;
    const double k = cloud.stiffness_N_per_m[i];
    weights += psi, stiffness += psi * (std::isnan(k) ? kRegions.stiffness : k);
  }
  // psi and the unit vector of a point carry a few roundings of their own, in addition to those of the grid.
  const double rounding = static_cast<double>(cloud.size()) * (kOnGrid + 2e-15);
  EXPECT_NEAR(got.nearest, static_cast<double>(nearest), 1e-17);
  EXPECT_EQ(got.touching_count, touching);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got.normal_sum[k], static_cast<double>(normal[k]), rounding);
  EXPECT_NEAR(got.weight_sum, static_cast<double>(weights), rounding);
  EXPECT_NEAR(got.stiffness_sum, static_cast<double>(stiffness), 0x1p20 * rounding);  // a coarser grid
}

TEST(ContactQuery, AgreesWithTheEquations) {
  const PointCloud at = scenes::random_cloud(40, 0.01, 2);
  for (const bool with_radius : {false, true})
    for (const bool with_stiffness : {false, true}) {
      const PointCloud cloud = random_points(700, 0.012, 1, with_radius, with_stiffness);
      const GatheredPoints points = columns(cloud);
      for (const Kernels* kernels : supported_kernels())
        for (std::size_t i = 0; i < at.size(); ++i)
          expect_query(kernels->proxy.contact_query(points.view(), at.point(i).data(), kRegions), cloud,
                       at.point(i));
    }
}

TEST(ContactQuery, HasTheSameBitsOnEveryLevelInAnyOrderAndWithPointsFarAway) {
  const PointCloud cloud = random_points(601, 0.012, 3, true, true), at = scenes::random_cloud(20, 0.01, 4);
  const GatheredPoints plain = columns(cloud);
  std::vector<std::size_t> order(640);  // the last ones mean points far away
  std::iota(order.begin(), order.end(), 0u);
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    PointCloud mixed;
    for (const std::size_t i : order) {
      const bool far = i >= cloud.size();
      if (far && seed == 0) continue;  // the first order has none
      mixed.append(far ? Vec3(0.03 * static_cast<double>(i), -0.5, 1) : cloud.point(i));
      mixed.fixture_radius_m.push_back(far ? 0.001 : cloud.fixture_radius_m[i]);
      mixed.stiffness_N_per_m.push_back(far ? 600 : cloud.stiffness_N_per_m[i]);
    }
    const GatheredPoints other = columns(mixed);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const ContactQuery first =
          supported_kernels()[0]->proxy.contact_query(plain.view(), at.point(i).data(), kRegions);
      ASSERT_GT(first.touching_count, 0);
      for (const Kernels* kernels : supported_kernels()) {
        const ContactQuery got = kernels->proxy.contact_query(other.view(), at.point(i).data(), kRegions);
        EXPECT_EQ(std::memcmp(&got, &first, sizeof got), 0) << kernels->isa << " " << seed;
      }
    }
  }
}

TEST(ContactQuery, WeightFallsFromOneAtR1ToZeroAtR3AndTouchingIncludesR2) {
  const double halfway = 0.5 * (kRegions.r1 + kRegions.r3);  // (1/2)^4 (4/2 + 1) = 3/16
  const std::pair<double, double> cases[] = {
      {0.001, 1}, {kRegions.r1, 1}, {halfway, 0.1875}, {kRegions.r3, 0}, {0.5, 0}};
  const double r2 = kRegions.r2, above = nextafter(r2, 1.0), below = nextafter(r2, 0.0);
  const GatheredPoints at_r2 =
      columns(scenes::cloud_of({{0, r2, 0}, {-r2, 0, 0}, {0, above, 0}, {-above, 0, 0}, {0, below, 0}}));
  for (const Kernels* kernels : supported_kernels()) {
    const auto query = [&](const GatheredPoints& points) {
      return kernels->proxy.contact_query(points.view(), kOrigin.data(), kRegions);
    };
    for (const auto& [distance, psi] : cases) {
      const ContactQuery got = query(columns(one_point({0, 0, -distance})));
      EXPECT_NEAR(got.normal_sum[2], psi, kOnGrid) << distance;
      EXPECT_EQ(got.normal_sum[0], 0);
      EXPECT_EQ(got.nearest, distance);
    }
    EXPECT_EQ(query(at_r2).touching_count, 3);
    const ContactQuery alone = query(columns(one_point(kOrigin)));
    EXPECT_EQ(Vec3(alone.normal_sum), kOrigin) << "a point at the proxy gives no direction";
    EXPECT_EQ(alone.nearest, 0);
    EXPECT_EQ(alone.touching_count, 1);
    EXPECT_EQ(query(columns({})).nearest, kInfinity);
  }
}

TEST(FirstHit, AgreesWithTheClosedFormForOnePoint) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto hit = [&](const Vec3& x, double r_f = 0) {
      return kernels->proxy.first_hit(columns(one_point(x, r_f)).view(), kOrigin.data(),
                                      Vec3::UnitX().eval().data(), kReach);
    };
    EXPECT_NEAR(hit({0.02, 0, 0}), 0.015, 1e-17);
    EXPECT_NEAR(hit({0.02, 0.003, 0}), 0.016, 1e-17);  // a 3-4-5 triangle
    EXPECT_NEAR(hit({0.02, 0, 0.006}, 0.005), 0.012, 1e-17);
    EXPECT_EQ(hit({0.1, kReach, 0}), 0.1) << "a tangent counts as a hit";
    EXPECT_EQ(hit({0.1, nextafter(kReach, 1.0), 0}), kInfinity);
    EXPECT_EQ(hit({-0.02, 0, 0}), kInfinity) << "behind";
    EXPECT_EQ(hit({0.003, 0, 0}), kInfinity) << "within reach already: its near root is behind";
  }
}

TEST(WayOut, AgreesWithTheClosedFormForOnePoint) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto exit_distance = [&](const Vec3& x, double r_f = 0) {
      return kernels->proxy.exit_distance(columns(one_point(x, r_f)).view(), kOrigin.data(),
                                          Vec3::UnitY().eval().data(), kReach, kRegions.r1);
    };
    EXPECT_NEAR(exit_distance({0, -0.003, 0}), 0.002, 1e-17);
    EXPECT_NEAR(exit_distance({0, 0.003, 0}), 0.008, 1e-17);
    EXPECT_NEAR(exit_distance({0.003, 0, 0}), 0.004, 1e-17);
    EXPECT_NEAR(exit_distance({0, 0, 0.006}, 0.005), 0.008, 1e-17) << "r_f moves both radii out";
    EXPECT_EQ(exit_distance({0, -kRegions.r1, 0}), 0) << "at r1 is not within r1";
    EXPECT_GT(exit_distance({0, -nextafter(kRegions.r1, 0.0), 0}), 0);
  }
}

TEST(Roots, AreTheSmallestAheadAndTheLargestWithinR1) {
  const PointCloud at = scenes::random_cloud(200, 0.06, 6), displacement = scenes::random_cloud(200, 1, 7);
  int hits = 0, entrenched = 0;
  for (const bool with_radius : {false, true}) {
    const PointCloud cloud = random_points(600, 0.06, 5, with_radius, false);
    const GatheredPoints points = columns(cloud);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 p = at.point(i), u = displacement.point(i).normalized();
      Real first = kInfinity, max_length = 0;
      for (std::size_t j = 0; j < cloud.size(); ++j) {
        const Vec P = p.cast<Real>(), x = cloud.point(j).cast<Real>();
        const Vec direction = u.cast<Real>().normalized();
        const Real r_f = radius_of(cloud, j);
        const auto d = equations::first_hit<Real>(P, x, direction, kReach + r_f);
        first = std::min(first, d.value_or(first));
        max_length = std::max(
            max_length, equations::exit_distance<Real>(P, x, direction, kReach + r_f, kRegions.r1 + r_f));
      }
      for (const Kernels* kernels : supported_kernels()) {
        const double hit = kernels->proxy.first_hit(points.view(), p.data(), u.data(), kReach);
        const double out =
            kernels->proxy.exit_distance(points.view(), p.data(), u.data(), kReach, kRegions.r1);
        ASSERT_TRUE(hit == first || std::abs(hit - first) < 1e-13);  // no ray here grazes a point closer
        ASSERT_NEAR(out, static_cast<double>(max_length), 1e-15);    // some roundings of a centimetre
      }
      hits += first<kInfinity, entrenched += max_length> 0;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(entrenched, 100);
}

// The value as a sensor's file stores it. volatile: otherwise g++ 12 -O3 omits the rounding to float before
// arithmetic in long double.
double stored_as_float(double value) {
  volatile float stored = static_cast<float>(value);
  return stored;
}

// The discriminant of the quadratic loses 4e-16 m^2 at 1 m, which is 4e-14 m at r_c. The perpendicular form
// keeps the error at the rounding of the coordinates.
TEST(FirstHit, LandsOnTheContactRadiusFromAMetreAway) {
  const PointCloud at = scenes::random_cloud(300, 1, 8), offset = scenes::random_cloud(300, 0.0028, 9);
  for (const Kernels* kernels : supported_kernels())
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 p = 0.1 * at.point((i + 1) % at.size()), u = (at.point(i) - p).normalized();
      const Vec3 moved = at.point(i) + offset.point(i);
      const Vec3 x(stored_as_float(moved.x()), stored_as_float(moved.y()), stored_as_float(moved.z()));
      const double d = kernels->proxy.first_hit(columns(one_point(x)).view(), p.data(), u.data(), kReach);
      Real squared = 0;
      for (int k = 0; k < 3; ++k) squared += std::pow(Real{p[k]} + Real{d} * u[k] - x[k], Real{2});
      ASSERT_NEAR(static_cast<double>(std::sqrt(squared) - Real{kReach}), 0, 1e-15);
    }
}

// Lengths around multiples of the lanes and the chunks. The points are appended behind points already there.
TEST(AppendWithin, FindsThePointsOfAPlainLoop) {
  PointCloud cloud = random_points(200, 0.01, 13, true, true);
  for (std::size_t i = 4; i < cloud.size(); i += 9)
    (i % 3 == 0 ? cloud.x : i % 3 == 1 ? cloud.y : cloud.z)[i] = std::nan("");
  std::vector<std::uint32_t> names(cloud.size());
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = static_cast<std::uint32_t>(4000000000u - 7 * i);
  std::vector<std::size_t> lengths{63, 64, 65, 72, 127, 128, 129, 199};
  for (std::size_t length = 0; length <= 40; ++length) lengths.push_back(length);

  const std::size_t before = 3;
  for (const Kernels* kernels : supported_kernels())
    for (const std::size_t length : lengths)
      for (const double reach : {0.007, 0.0, kInfinity})
        for (const bool named : {false, true}) {
          const std::size_t buffer = before + length + kLanes;
          std::vector<double> out[5];
          for (auto& column : out) column.assign(buffer + 1, -1);
          std::vector<std::uint32_t> index(buffer + 1, 77);
          const std::size_t count = kernels->gather.append_within(
              {cloud.x.data(), cloud.y.data(), cloud.z.data(),
               named ? cloud.fixture_radius_m.data() : nullptr, cloud.stiffness_N_per_m.data(),
               named ? names.data() : nullptr, 900, length},
              kOrigin.data(), reach,
              {out[0].data(), out[1].data(), out[2].data(), out[3].data(), out[4].data(), index.data()},
              before);
          std::size_t n = before;
          for (std::size_t i = 0; i < length; ++i) {
            const Vec3 p = cloud.point(i);
            const double far = named ? reach + cloud.fixture_radius_m[i] : reach;
            if (!(p.x() * p.x() + p.y() * p.y() + p.z() * p.z() <= far * far)) continue;
            ASSERT_LT(n, count);
            EXPECT_EQ(Vec3(out[0][n], out[1][n], out[2][n]), p);
            EXPECT_EQ(index[n], named ? names[i] : 900 + i);
            EXPECT_EQ(out[3][n], named ? cloud.fixture_radius_m[i] : -1);
            EXPECT_EQ(std::memcmp(&out[4][n++], &cloud.stiffness_N_per_m[i], sizeof(double)), 0);  // or NaN
          }
          ASSERT_EQ(count, n);
          EXPECT_EQ(out[0][before - 1], -1) << "wrote before the end";
          EXPECT_TRUE(out[0][buffer] == -1 && index[buffer] == 77) << "wrote beyond the room";
        }
}

TEST(SupportedKernels, AreTheLevelsUpToTheBestInRisingOrder) {
  const auto supported = supported_kernels();
  const std::string names[] = {"x86-64", "x86-64-v3", "x86-64-v4"};
  ASSERT_EQ(supported.size(), static_cast<std::size_t>(best_isa()) + 1);
  for (std::size_t i = 0; i < supported.size(); ++i) {
    EXPECT_EQ(supported[i]->isa, names[i]);
    EXPECT_EQ(supported[i], &kernels_for(static_cast<Isa>(i)));
  }
}

}  // namespace
}  // namespace remote_touch::kernels_test
