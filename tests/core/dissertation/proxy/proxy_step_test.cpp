// The steps of the proxy in each state, 4.2, compared with closed forms and plain loops.
#include "core/dissertation/proxy/proxy_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::proxy_step_test {
namespace {

using Real = long double;
constexpr double kDegree = 3.14159265358979323846 / 180;
const ProxyParameters kDefault;
const Vec3 kUp = Vec3::UnitY();

Neighbourhood around(const PointCloud& cloud) {
  return scenes::neighbourhood(make_search(cloud), kDefault.r3_m);
}

double distance(const PointCloud& cloud, std::size_t i, const Vec3& p) {
  const Real x = Real{cloud.x[i]} - p.x(), y = Real{cloud.y[i]} - p.y(), z = Real{cloud.z[i]} - p.z();
  return static_cast<double>(std::sqrt(x * x + y * y + z * z));
}
double nearest(const PointCloud& cloud, const Vec3& p) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud.size(); ++i) smallest = std::min(smallest, distance(cloud, i, p));
  return smallest;
}

ContactQuery with_normal_sum(const Vec3& sum) {
  return {0, {sum.x(), sum.y(), sum.z()}, 0, 0, 0};
}

TEST(Classify, ContactRegionIncludesBothEnds) {
  const double r1 = kDefault.r1_m, r2 = kDefault.r2_m, infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(classify(0, kDefault), ContactState::entrenched);
  EXPECT_EQ(classify(std::nextafter(r1, 0.0), kDefault), ContactState::entrenched);
  EXPECT_EQ(classify(r1, kDefault), ContactState::contact);
  EXPECT_EQ(classify(r2, kDefault), ContactState::contact);
  EXPECT_EQ(classify(std::nextafter(r2, 1.0), kDefault), ContactState::free);
  EXPECT_EQ(classify(infinity, kDefault), ContactState::free);
}

TEST(UnitNormal, KeepsThePreviousNormalIfTheSumIsZero) {
  const Vec3 previous(0, 0.6, 0.8);
  EXPECT_EQ(unit_normal(with_normal_sum({0, 0, 0}), previous), previous);
  EXPECT_EQ(unit_normal(with_normal_sum({1e-13, 0, -1e-13}), previous), previous);  // rounding, no direction
  EXPECT_LT((unit_normal(with_normal_sum({0, 1e-6, 0}), previous) - kUp).norm(), 1e-15);
  EXPECT_LT((unit_normal(with_normal_sum({30, 0, -40}), previous) - Vec3(0.6, 0, -0.8)).norm(), 1e-15);
}

TEST(FreeStep, DoesNotTunnelThroughALonePointFarAhead) {
  Neighbourhood near = around(scenes::cloud_of({{0.5, 0, 0}}));
  EXPECT_NEAR(free_step(near, Vec3::Zero(), {1, 0, 0}, kDefault).x(), 0.495, 1e-15);
  EXPECT_NEAR(free_step(near, {0, 0.003, 0}, {1, 0, 0}, kDefault).x(), 0.496, 1e-15);
  EXPECT_NEAR(free_step(near, Vec3::Zero(), {100, 0, 0}, kDefault).x(), 0.495, 1e-13);
  EXPECT_EQ(free_step(near, {0, 0.0051, 0}, {1, 0, 0}, kDefault), Vec3(1, 0, 0));
}

TEST(FreeStep, HasTheSameBitsFromTheKeptListAndFromHops) {
  const PointCloud cloud = scenes::random_cloud(500, 0.03, 3);
  const PointCloud from = scenes::random_cloud(400, 0.03, 4), directions = scenes::random_cloud(400, 1, 5);
  const BruteForceSearch search(cloud);
  Neighbourhood kept = around(cloud);
  int met = 0, missed = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 p = from.point(i), u = directions.point(i).normalized();
    if (nearest(cloud, p) <= kDefault.r2_m) continue;
    Neighbourhood hopping = around(cloud);  // has no list yet
    const GatheredPoints all = scenes::gathered(search, {p, 10});
    const double first = scenes::kernels().proxy.first_hit(all.view(), p.data(), u.data(), 0.005);
    kept.around(p);
    for (const double limit : {0.0001, 0.004, 0.009, 0.03, 0.1, 5.0}) {
      const double want = std::min(limit, first);
      EXPECT_EQ(kept.first_hit(p, u, 0.005, limit), want) << limit;
      EXPECT_EQ(hopping.first_hit(p, u, 0.005, limit), want) << limit;
      ++(want < limit ? met : missed);
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(missed, 100);
}

TEST(FreeStep, PrintedRootPullsTheProxyBackToPointsBehind) {
  Neighbourhood near = around(scenes::cloud_of({{-0.008, 0, 0}}));
  ProxyParameters printed;
  printed.free_root = FreeRoot::smallest_magnitude;
  const Vec3 u(0.02, 0, 0);
  EXPECT_EQ(free_step(near, Vec3::Zero(), u, kDefault), u);
  // Roots -0.013 and -0.003 of the point at -0.008.
  EXPECT_LT((free_step(near, Vec3::Zero(), u, printed) - Vec3(-0.003, 0, 0)).norm(), 1e-17);
  // Both readings agree for a point ahead. A point beside the ray has no root.
  EXPECT_NEAR(free_step(near, {-0.016, 0, 0}, u, printed).x(), 0.003, 1e-17);
  EXPECT_EQ(free_step(near, {0, 0.006, 0}, u, printed), u);
  // A region of 3 mm around a point that is 3 mm farther behind.
  PointCloud region = scenes::cloud_of({{-0.011, 0, 0}});
  region.fixture_radius_m = {0.003};
  Neighbourhood around_it = around(region);
  EXPECT_LT((free_step(around_it, Vec3::Zero(), u, printed) - Vec3(-0.003, 0, 0)).norm(), 1e-17);
}

TEST(EntrenchedStep, GetsAllPointsOut) {
  const PointCloud offsets = scenes::random_cloud(4000, 0.0028, 7),
                   directions = scenes::random_cloud(100, 1, 8);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vec3 p = Vec3(0.3, -0.2, 0.9) + directions.point(i),
               normal = directions.point((i + 1) % 100).normalized();
    PointCloud inside;
    for (std::size_t j = 40 * i; j < 40 * i + 40; ++j) inside.append(p + offsets.point(j));
    const GatheredPoints points = scenes::gathered(BruteForceSearch(inside), {p, 0.1});
    // All of them are within r1: the half diagonal of the cube they fill is 4.85 mm.
    const Vec3 s = entrenched_step(points.view(), scenes::kernels(), p, normal, Vec3::Zero(), kDefault);
    EXPECT_GT(s.dot(normal), 0);
    EXPECT_LT(s.cross(normal).norm(), 1e-16);
    // The last point to leave is at r_c. A root that is too large would leave it farther away.
    EXPECT_NEAR(nearest(inside, p + s), kDefault.contact_radius_m(), 1e-14);
  }
}

TEST(EntrenchedStep, GoesBackFromTheHipIfThereIsNoNormal) {
  // The second one is at the distance r_c: touched, but not within r1, so the point sets no step.
  const PointCloud cloud = scenes::cloud_of({{0, 0, 0}, {0.003, 0.004, 0}});
  const GatheredPoints points = scenes::gathered(BruteForceSearch(cloud), {Vec3::Zero(), 1});
  const auto step = [&](const Vec3& normal, const Vec3& u, const ProxyParameters& p = kDefault) {
    return entrenched_step(points.view(), scenes::kernels(), Vec3::Zero(), normal, u, p);
  };
  EXPECT_LT((step(Vec3::Zero(), {0, -0.03, 0}) - Vec3(0, 0.005, 0)).norm(), 1e-17);
  EXPECT_LT((step(Vec3::UnitZ(), {0, -0.03, 0}) - Vec3(0, 0, 0.005)).norm(), 1e-17);
  EXPECT_EQ(step(Vec3::Zero(), Vec3::Zero()), Vec3(0, 0, 0));
  ProxyParameters fixed;
  fixed.step_rule = StepRule::fixed;
  EXPECT_LT((step(kUp, {0, -0.03, 0}, fixed) - Vec3(0, 1e-4, 0)).norm(), 1e-19);
}

TEST(ContactStep, IsInTheTangentPlaneWhenTheHipIsBelowIt) {
  const PointCloud normals = scenes::random_cloud(200, 1, 9),
                   directions = scenes::random_cloud(200, 0.02, 10);
  int below = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 n = normals.point(i).normalized(), u = directions.point(i);
    const Vec3 s = contact_step(n, u, kDefault), tangential = u - u.dot(n) * n;
    const bool inside = u.dot(n) < 0;
    const Vec3 goal = inside ? tangential : u;
    const double length = goal.norm();
    EXPECT_NEAR(s.norm(), length < kDefault.r1_m ? 0.3 * length : 0.1 * kDefault.r1_m, 1e-17);
    EXPECT_LT((s / s.norm() - goal / length).norm(), 1e-14);
    below += inside;
  }
  EXPECT_GT(below, 50);
  EXPECT_LT(below, 150);
  // The share of distances below r1, and a small step above: (4.11) and (4.12).
  const double r1 = kDefault.r1_m, just_below = std::nextafter(r1, 0.0);
  EXPECT_DOUBLE_EQ(contact_step(kUp, {just_below, -0.001, 0}, kDefault).x(), 0.3 * just_below);
  EXPECT_DOUBLE_EQ(contact_step(kUp, {r1, -0.001, 0}, kDefault).x(), 0.1 * r1);
  EXPECT_EQ(contact_step(kUp, {0, -0.02, 0}, kDefault), Vec3(0, 0, 0));
  EXPECT_EQ(contact_step(kUp, Vec3::Zero(), kDefault), Vec3(0, 0, 0));
}

TEST(ExitRule, AHipOutsideFreesTheProxyAlongTheNormal) {
  ProxyParameters out;
  out.exit_rule = ExitRule::out_of_contact;
  const PointCloud normals = scenes::random_cloud(200, 1, 9),
                   directions = scenes::random_cloud(200, 0.02, 10);
  int outside = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 n = normals.point(i).normalized(), u = directions.point(i), s = contact_step(n, u, out);
    if (u.dot(n) < 0) {
      EXPECT_EQ(s, contact_step(n, u, kDefault)) << "below the surface nothing changes";
      continue;
    }
    EXPECT_NEAR(s.norm(), out.r2_m - out.r1_m, 1e-20);
    EXPECT_LT((s - (out.r2_m - out.r1_m) * n).norm(), 1e-20);
    ++outside;
  }
  EXPECT_GT(outside, 50);
  const double width = out.r2_m - out.r1_m;
  EXPECT_EQ(contact_step(kUp, {0.01, 0, 0}, out), width * kUp) << "a HIP in the tangent plane is outside";
  EXPECT_EQ(contact_step(kUp, Vec3::Zero(), out), Vec3(0, 0, 0)) << "at the HIP there is nowhere to go";
  EXPECT_LT(contact_step(kUp, {0.01, -1e-9, 0}, out).y(), 1e-12);
}

TEST(HasConverged, IsTrueWithinThetaOfTheNormal) {
  const Vec3 n = Vec3(2, -1, 2) / 3, t = Vec3(1, 2, 0) / std::sqrt(5.0);
  for (const double theta : {0.1, 1.0, 30.0, 89.0})
    for (const double length : {1e-4, 0.03, 2.0}) {
      ProxyParameters p;
      p.theta_deg = theta;
      const auto at = [&](double degrees) {
        const Vec3 u = length * (std::sin(degrees * kDegree) * t - std::cos(degrees * kDegree) * n);
        return has_converged(ContactState::contact, n, u, p);
      };
      EXPECT_TRUE(at(0));
      EXPECT_TRUE(at(theta * (1 - 1e-9))) << theta;
      EXPECT_FALSE(at(theta * (1 + 1e-9))) << theta;
      EXPECT_FALSE(at(180)) << "the HIP is above the surface";
    }
  const Vec3 down(0, -0.01, 0);
  EXPECT_TRUE(has_converged(ContactState::contact, kUp, down, kDefault));
  EXPECT_FALSE(has_converged(ContactState::entrenched, kUp, down, kDefault));
  EXPECT_TRUE(has_converged(Vec3(Vec3::Zero()), down, kDefault));
  EXPECT_FALSE(has_converged(std::nullopt, down, kDefault)) << "no admissible motion was found";
  EXPECT_FALSE(has_converged(ContactState::free, kUp, down, kDefault));
  EXPECT_TRUE(has_converged(ContactState::free, kUp, Vec3::Zero(), kDefault));
}

KnownStep step_from(const Vec3& proxy_W, double stiffness_N_per_m = 0) {
  return {.proxy_W = proxy_W,
          .normal_W = Vec3::UnitY(),
          .state = ContactState::contact,
          .stiffness_N_per_m = stiffness_N_per_m};
}

TEST(KnownSteps, ForgetsWhenTheHipMoves) {
  const Vec3 p(0.1, 0, 0.3), hip_W(0, -0.01, 0);
  KnownSteps steps;
  steps.set_hip(hip_W);
  steps.remember(step_from(p));
  steps.set_hip(hip_W);
  EXPECT_NE(steps.from(p), nullptr);
  EXPECT_EQ(steps.from({0.1, -0.0, 0.3}), nullptr);
  steps.set_hip({-0.0, -0.01, 0});
  EXPECT_EQ(steps.from(p), nullptr);
  steps.remember(step_from(p));
  steps.forget();
  EXPECT_EQ(steps.from(p), nullptr);
}

PointCloud noisy_plane(double sigma_m, unsigned seed, bool with_regions) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigma_m);
  PointCloud cloud;
  for (int i = -25; i <= 25; ++i)
    for (int k = -25; k <= 25; ++k) {
      cloud.append({0.002 * i + normal(random), normal(random), 0.002 * k + normal(random)});
      if (with_regions) {
        cloud.fixture_radius_m.push_back(0.001 * ((i + k) & 3));
        cloud.stiffness_N_per_m.push_back(300 + i);
      }
    }
  return cloud;
}

// Compares the positions of two proxies after each tick, over frames with new noise. The HIP rests below the
// surface for some ticks at a time. The second proxy makes the 30 steps of a tick in 30 ticks of one step,
// with a change of settings after each, which makes its renderer forget the known steps. So it computes every
// step.
struct Rest {
  int repeated = 0;  // ticks in a cycle of positions
  int different = 0;
};
Rest compare(ProxyParameters p, double sigma_m, bool with_regions) {
  p.velocity_estimate = false, p.max_exit_steps = 0;
  ProxyParameters one = p;
  one.steps_per_tick = 1;
  ProxyRenderer whole = scenes::renderer(p), single = scenes::renderer(one);
  Rest rest;
  for (unsigned frame = 0; frame < 12; ++frame) {
    const PointCloud cloud = noisy_plane(sigma_m, frame, with_regions);
    whole.on_frame(scenes::frame(cloud, static_cast<int>(frame)));
    single.on_frame(scenes::frame(cloud, static_cast<int>(frame)));
    std::vector<Vec3> ends_W;  // positions at the ends of ticks that used all steps
    for (int tick = 0; tick < 30; ++tick) {
      // The HIP comes down in the first frame, and moves in the middle of each later one.
      const Vec3 hip_W(0, frame == 0 && tick < 10 ? 0.02 : -0.01 - 0.001 * (frame + (tick + 15) / 30),
                       0.0003);
      const RenderOutput out = whole.step({hip_W}, 0);
      for (int k = 0; k < 30; ++k) {
        single.step({hip_W}, 0);
        single.parameters_changed();
      }
      rest.different += out.proxy_W == single.proxy_W() ? 0 : 1;
      if (out.steps < 30) continue;
      rest.repeated += std::find(ends_W.begin(), ends_W.end(), out.proxy_W) != ends_W.end() ? 1 : 0;
      ends_W.push_back(out.proxy_W);
    }
  }
  return rest;
}

TEST(KnownSteps, ChangeNoPositionOfTheProxy) {
  for (const double sigma_m : {0.001, 0.004})
    for (const bool with_regions : {false, true})
      for (const auto motion :
           {ContactMotion::tangent_plane, ContactMotion::regions, ContactMotion::creases}) {
        ProxyParameters p;
        p.contact_motion = motion;
        const Rest rest = compare(p, sigma_m, with_regions);
        EXPECT_EQ(rest.different, 0) << sigma_m << " m, regions: " << with_regions;
        if (motion == ContactMotion::tangent_plane) {
          EXPECT_GT(rest.repeated, 5) << sigma_m << " m, regions: " << with_regions;
        }
      }
}

}  // namespace
}  // namespace remote_touch::proxy_step_test
