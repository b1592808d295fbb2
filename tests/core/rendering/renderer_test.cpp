// Ticks that were missed, the target of guidance, and the estimate of the velocity of a surface.
#include "core/rendering/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::renderer_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ElapsedTicks, IsOneFromTickToTickWhateverTheRounding) {
  for (const double rate_hz : {100.0, 250.0, 1000.0, 3000.0})
    for (int tick = 0; tick < 100000; tick += 7)
      ASSERT_EQ(elapsed_ticks(tick / rate_hz, (tick + 1) / rate_hz, rate_hz), 1) << tick;
}

TEST(ElapsedTicks, CountsMissedTicksAndIsNeverBelowOne) {
  EXPECT_EQ(elapsed_ticks(0.1, 0.104, 1000), 4);
  EXPECT_EQ(elapsed_ticks(2, 5, 250), 750);
  EXPECT_EQ(elapsed_ticks(1, 1, 1000), 1);
  EXPECT_EQ(elapsed_ticks(1, 0.5, 1000), 1);
  EXPECT_EQ(elapsed_ticks(kNaN, 1, 1000), 1);
  EXPECT_EQ(elapsed_ticks(1, kNaN, 1000), 1);
}

// --- the target of guidance: the mean of the points of a class, and the plane in which they lie ---

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kCentre(0.3, -0.2, 0.9);

GuidanceTarget whole(const PointCloud& cloud) {
  return guidance_target(cloud, std::vector<double>(cloud.size(), 1));
}

Eigen::Matrix3d turn(const Vec3& vector) {
  return rotation(vector).toRotationMatrix();
}

const Vec3 kBoard_m(0.05, 0.03, 1e-3);  // half the sides of a flat box

// The corners of a box: spread along its axes like its sides.
PointCloud box(const Vec3& half_m, const Eigen::Matrix3d& R) {
  PointCloud cloud;
  for (int i = 0; i < 8; ++i)
    cloud.append(kCentre + R * Vec3(i & 1 ? half_m.x() : -half_m.x(), i & 2 ? half_m.y() : -half_m.y(),
                                    i & 4 ? half_m.z() : -half_m.z()));
  return cloud;
}

TEST(GuidanceTarget, IsNotVisibleIfNoPointIsPicked) {
  EXPECT_FALSE(guidance_target({}, {}).is_visible());
  const GuidanceTarget none = guidance_target(scenes::flat_grid(3), std::vector<double>(9, 0));
  EXPECT_FALSE(none.is_visible() || none.is_flat());
  EXPECT_EQ(none.mean_W, Vec3::Zero());
}

// Two points lie on a line, except for rounding. Points that nearly coincide differ by nothing but rounding.
TEST(GuidanceTarget, OneOrTwoPointsHaveAPlaceAndNoPlaneHoweverNearTheyAre) {
  EXPECT_EQ(whole(scenes::cloud_of({{1, 2, 3}})).mean_W, Vec3(1, 2, 3));
  EXPECT_FALSE(whole(scenes::cloud_of({{1, 2, 3}})).is_flat());
  EXPECT_EQ(whole(scenes::cloud_of({{1, 2, 3}, {2, 2, 5}})).mean_W, Vec3(1.5, 2, 4));
  std::mt19937 random(21);
  const auto share = [&] { return (random() + 1.0) / 4294967296.0; };
  for (int run = 0; run < 1000; ++run) {
    const Vec3 p = kCentre + 0.1 * Vec3(share(), share(), share());
    PointCloud pair;
    pair.append(p), pair.append(p + 0x1p-52 * Vec3(share(), share(), share()));
    EXPECT_FALSE(guidance_target(pair, {share(), share()}).is_flat()) << run;
  }
}

TEST(GuidanceTarget, ThreePointsHaveThePlaneThroughThem) {
  for (const Vec3& turned : {Vec3(0, 0, 0), Vec3(0.7, -0.3, 0.2), Vec3(-1.1, 0.4, 2)}) {
    const Eigen::Matrix3d R = turn(turned);
    PointCloud cloud;
    for (const Vec3& p : {Vec3(0.05, 0.01, 0), Vec3(-0.02, 0.03, 0), Vec3(-0.04, -0.06, 0)})
      cloud.append(kCentre + R * p);
    const GuidanceTarget target = guidance_target(cloud, {1, 0.5, 0.25});
    EXPECT_NEAR(std::abs(target.normal_W.dot(R.col(2))), 1, 1e-12);
  }
}

TEST(GuidanceTarget, MissingPointsDoNotCount) {
  PointCloud cloud = box(kBoard_m, turn({0.4, 0.1, 0}));
  const GuidanceTarget expected = whole(cloud);
  for (const Vec3& p : {Vec3(kNaN, kNaN, kNaN), Vec3(kInfinity, 0, 0), Vec3(0, kNaN, 0)}) cloud.append(p);
  const GuidanceTarget target = whole(cloud);
  EXPECT_EQ(target.points, 8u);
  EXPECT_EQ(target.mean_W, expected.mean_W);
  EXPECT_EQ(target.normal_W, expected.normal_W);
}

// Brute force: no other direction has a smaller weighted sum of squared distances.
TEST(GuidanceTarget, NoOtherPlaneIsNearerToTheWeightedPoints) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 10; ++run) {
    const Eigen::Matrix3d R = turn({normal(random), normal(random), normal(random)});
    PointCloud cloud;
    std::vector<double> weights;
    for (int i = 0; i < 60; ++i) {
      cloud.append(kCentre + R * Vec3(0.1 * normal(random), 0.05 * normal(random), 0.004 * normal(random)));
      weights.push_back(random() / 4294967296.0);
    }
    const GuidanceTarget target = guidance_target(cloud, weights);
    ASSERT_TRUE(target.is_flat());
    const auto distance = [&](const Vec3& n, const Vec3& place_W) {
      double sum = 0;
      for (std::size_t i = 0; i < 60; ++i) sum += weights[i] * std::pow(n.dot(cloud.point(i) - place_W), 2);
      return sum;
    };
    const double min = distance(target.normal_W, target.mean_W);
    for (int i = 0; i < 300; ++i) {
      const double far = std::pow(10, -4.0 * i / 300);
      const Vec3 aside = far * Vec3(normal(random), normal(random), normal(random));
      EXPECT_GE(distance((target.normal_W + aside).normalized(), target.mean_W), min * (1 - 1e-12));
      EXPECT_GE(distance(target.normal_W, target.mean_W + aside), min * (1 - 1e-12));
    }
  }
}

TEST(GuidanceTarget, IsFlatUpToAQuarterOfTheShorterSide) {
  const Eigen::Matrix3d R = turn({-0.5, 0.8, 1.2});
  EXPECT_TRUE(whole(box({0.3, 0.08, 0.0199}, R)).is_flat());
  EXPECT_FALSE(whole(box({0.3, 0.08, 0.0201}, R)).is_flat());
}

TEST(GuidanceTarget, PointsInALineHaveNoPlane) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 200; ++run) {
    const Vec3 from(normal(random), normal(random), normal(random));
    const Vec3 along(normal(random), normal(random), normal(random));
    PointCloud line;
    for (int i = 0; i < 3 + run % 30; ++i) line.append(from + 0.013 * i * along);
    EXPECT_FALSE(whole(line).is_flat()) << run;
  }
  PointCloud same;
  for (int i = 0; i < 30; ++i) same.append(kCentre);
  EXPECT_FALSE(whole(same).is_flat());
  EXPECT_TRUE(whole(same).mean_W.isApprox(kCentre, 1e-15));
}

TEST(GuidanceTarget, TheNormalIsTowardsTheSensor) {
  const Eigen::Matrix3d R = turn({0.7, -0.3, 0.2});
  PointCloud board = box(kBoard_m, R);
  EXPECT_LT(whole(board).normal_W.dot(kCentre), 0) << "in the origin without an image";
  for (const double side : {1.0, -1.0}) {
    board.image.emplace();
    board.image->X_WC =
        Eigen::Translation3d(kCentre + 0.5 * side * R.col(2) + 0.2 * R.col(0)) * rotation({1, 0, 0});
    EXPECT_NEAR(whole(board).normal_W.dot(R.col(2)), side, 1e-12);
  }
}

// --- of an assignment ---

std::unique_ptr<const FixtureRule> near(const Vec3& point_m, FixtureRole role, double strength = 1) {
  NearPoint::Settings settings;
  settings.values.role = role;
  settings.values.schedule = {0, strength};
  settings.point_m = point_m, settings.inner_radius_m = 0.1;
  return std::make_unique<NearPoint>(settings);
}

TEST(GuidanceTarget, EveryGuidanceRuleHasATargetInTheOrderOfTheRules) {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i) cloud.append({1.0 * i, 0, 0});
  cloud.append({kNaN, kNaN, kNaN});
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(near({3, 0, 0}, FixtureRole::guidance));
  rules.push_back(near({0, 0, 0}, FixtureRole::forbidden));
  rules.push_back(near({1, 0, 0}, FixtureRole::guidance));
  rules.push_back(near({2, 0, 0}, FixtureRole::guidance, 0));
  const FixtureAssignment assignment(std::move(rules));
  const std::vector<GuidanceTarget> targets = assignment.targets(cloud, 0);
  ASSERT_EQ(targets.size(), 3u);
  EXPECT_EQ(targets[0].mean_W, Vec3(3, 0, 0));
  EXPECT_EQ(targets[1].mean_W, Vec3(1, 0, 0));
  EXPECT_FALSE(targets[2].is_visible()) << "a rule of no strength";
  // Only the forbidden rule makes a region.
  assignment.assign(cloud, 0);
  EXPECT_EQ(cloud.fixture_radius_m, (std::vector<double>{0.02, 0, 0, 0, 0, 0}));
}

// --- the velocity of a surface ---

const Vec3 kUp = Vec3::UnitY();
constexpr double kInterval = 1.0 / 32;  // exact in binary, so that sums of it are too

// A step before any frame has no interval to be divided by.
TEST(SurfaceVelocity, FirstFrameAndStepsBeforeItSayNothing) {
  SurfaceVelocity velocity(1);
  velocity.on_step(kUp);
  EXPECT_EQ(velocity.vector(), Vec3(0, 0, 0));
  EXPECT_EQ(velocity.on_frame(7, kUp), Vec3(0, 0, 0));
  velocity.on_step(0.003 * kUp);
  EXPECT_EQ(velocity.m_per_s(), 0);
  EXPECT_EQ(velocity.on_frame(7 + kInterval, kUp), Vec3(0, 0, 0));
}

// The estimate lags one frame under acceleration a: the correction misses a / f_c^2, the bound of (4.14).
TEST(SurfaceVelocity, AccelerationIsMissedByOneFrame) {
  const double a = 3;
  SurfaceVelocity velocity(1);
  double surface = 0, speed = 0, proxy = 0;
  for (int frame = 0; frame < 10; ++frame) {
    if (frame > 0) speed += a * kInterval, surface += speed * kInterval;
    proxy += velocity.on_frame(frame * kInterval, kUp).y();
    if (frame > 0) {
      EXPECT_NEAR(surface - proxy, a * kInterval * kInterval, 1e-15) << frame;
    }
    velocity.on_step({0.5, surface - proxy, -0.25});  // the tangential part gives no information
    proxy = surface;
    EXPECT_NEAR(velocity.m_per_s(), speed, 1e-14) << frame;
  }
}

TEST(SurfaceVelocity, NormalOfTheFrameIsUsedUntilTheNext) {
  const Vec3 tilted = Vec3(1, 2, 2) / 3;
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, tilted);
  velocity.on_step({0.003, 0.006, 0.006});  // 0.009 along the normal
  EXPECT_NEAR(velocity.m_per_s(), 0.009 / kInterval, 1e-15);
  EXPECT_LT((velocity.vector() - 0.009 / kInterval * tilted).norm(), 1e-15);
  const Vec3 correction = velocity.on_frame(2 * kInterval, kUp);
  EXPECT_LT((correction - 0.009 * kUp).norm(), 1e-16) << "(4.3) is along the newest normal";
}

TEST(SurfaceVelocity, OnlyTheFirstStepAfterAFrameCounts) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.001 * kUp);
  const double first = velocity.m_per_s();
  EXPECT_NEAR(first, 0.001 / kInterval, 1e-16);
  velocity.on_step(0.002 * kUp);
  velocity.on_step(-0.5 * kUp);
  EXPECT_EQ(velocity.m_per_s(), first);
  velocity.on_frame(2 * kInterval, kUp);
  velocity.on_step(0.002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.003 / kInterval, 1e-15);
}

TEST(SurfaceVelocity, IsNeverNegativeAndNeverReset) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(-0.004 * kUp);
  EXPECT_EQ(velocity.m_per_s(), 0);
  velocity.on_frame(2 * kInterval, kUp);
  velocity.on_step(0.004 * kUp);
  const double v = velocity.m_per_s();
  EXPECT_NEAR(v, 0.004 / kInterval, 1e-16) << "a clamped estimate owes nothing";
  velocity.on_frame(3 * kInterval, kUp);
  velocity.on_step(Vec3::Zero());
  EXPECT_EQ(velocity.m_per_s(), v) << "a zero step confirms the estimate";
  velocity.on_frame(4 * kInterval, kUp);
  velocity.on_step(-0.001 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.003 / kInterval, 1e-15);
}

TEST(SurfaceVelocity, IntervalIsBetweenTheCaptures) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.002 * kUp);
  // One frame is lost: twice the time, twice the way.
  EXPECT_NEAR(velocity.on_frame(3 * kInterval, kUp).y(), 0.004, 1e-17);
  velocity.on_step(0.002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.002 / kInterval + 0.002 / (2 * kInterval), 1e-15);
}

TEST(SurfaceVelocity, PredictionIsBoundedWhenFramesStayAway) {
  const double max_length = 0.1;
  SurfaceVelocity velocity(max_length);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.005 * kUp);
  const double v = velocity.m_per_s();
  EXPECT_NEAR(velocity.on_frame(kInterval + 60, kUp).y(), v * max_length, 1e-16);
  velocity.on_step(0.001 * kUp);
  // The velocity is the carried distance plus the step, over the true time.
  EXPECT_NEAR(velocity.m_per_s(), (v * max_length + 0.001) / 60, 1e-15);
  EXPECT_NEAR(velocity.on_frame(2 * kInterval + 60, kUp).y(), velocity.m_per_s() * kInterval, 1e-15);
}

// The next frame of a slow stream comes later than max_interval_s, and until then v_hat is all that is known.
// Returns the horizon after a first frame and frames at these intervals. The estimated and the measured
// velocity must agree on it.
double horizon_after(const std::vector<double>& intervals_s) {
  SurfaceVelocity estimated(0.1), measured(0.1);
  double time_s = 3;
  const auto add_frame = [&] {
    estimated.on_frame(time_s, kUp), estimated.on_step(0.001 * kUp);
    measured.on_measured(time_s, 0.2, kUp);
  };
  add_frame();
  for (const double interval_s : intervals_s) time_s += interval_s, add_frame();
  EXPECT_EQ(measured.horizon_s(), estimated.horizon_s());
  return estimated.horizon_s();
}

// If the stream stops again right after a pause of a minute, (4.15) must not grow for another minute.
TEST(SurfaceVelocity, IsTrustedForAFrameIntervalOfASlowStreamButNotForAPause) {
  const std::tuple<std::vector<double>, double, const char*> cases[] = {
      {{}, 0.1, "the first frame has no interval"},
      {{0}, 0.1, "nor has one of the same time"},
      {{kInterval}, 0.1, "a fast stream"},
      {{0.25}, 0.25, "a slow stream"},
      {{0.25, 0.25, kInterval}, 0.1, "a stream that gets faster"},
      {{kInterval, kInterval, 60}, 0.1, "a pause"},
      {{0.25, 0.25, 60}, 0.75, "three of its intervals"},
      {{0.25, 0.25, 60, 0.25}, 0.25, "after a pause"},
      {{0.25, 60, 0, 60}, 2.25, "frames without an interval say nothing about the rate"},
      {{0.25, 0.25}, 0.25, "no frame is lost"},
      {{0.25, 0.5}, 0.5, "one is lost"},
      {{0.25, 0.75}, 0.75, "two are lost"},
      {{60}, 60, "nothing is known of a stream with two frames"},
      {{0.125, 2, 2, 2}, 2, "a stream that gets slower: 0.375, 1.125, 2"}};
  for (const auto& [intervals_s, horizon_s, what] : cases)
    EXPECT_EQ(horizon_after(intervals_s), horizon_s) << what;
}

// More frames than steps: they count as one, over their whole time.
TEST(SurfaceVelocity, FramesWithoutAStepBetweenThemCountAsOne) {
  SurfaceVelocity velocity(0.1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(0.001, kUp);
  velocity.on_frame(0.002, kUp);
  velocity.on_step(0.0002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.1, 1e-15);
  const double first = velocity.on_frame(0.003, kUp).y(), second = velocity.on_frame(0.004, kUp).y();
  EXPECT_NEAR(first + second, 0.0002, 1e-17);
  velocity.on_step(Vec3::Zero());
  EXPECT_NEAR(velocity.m_per_s(), 0.1, 1e-15);
}

}  // namespace
}  // namespace remote_touch::renderer_test
