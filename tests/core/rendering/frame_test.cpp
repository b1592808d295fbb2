// The target of guidance: the mean of the points of a class, and the plane in which they lie.
#include "core/rendering/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::guidance_target_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kCentre(0.3, -0.2, 0.9);

GuidanceTarget whole(const PointCloud& cloud) {
  return guidance_target(cloud, std::vector<double>(cloud.size(), 1));
}

// A grid of n x n points, n even, in the plane through kCentre that R turns from x and y. The points lie
// noise_m above and below it like the fields of a chessboard, which changes neither the mean nor the plane.
PointCloud chessboard(const Eigen::Matrix3d& R, int n, double noise_m) {
  PointCloud cloud;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      cloud.append(kCentre + R * Vec3(0.01 * (i - 0.5 * (n - 1)), 0.02 * (j - 0.5 * (n - 1)),
                                      (i + j) % 2 == 0 ? noise_m : -noise_m));
  return cloud;
}

Eigen::Matrix3d turn(const Vec3& vector) {
  return rotation(vector).toRotationMatrix();
}

// The corners of a box: spread along its axes like its sides.
PointCloud box(const Vec3& half_m, const Eigen::Matrix3d& R) {
  PointCloud cloud;
  for (int i = 0; i < 8; ++i)
    cloud.append(kCentre + R * Vec3(i & 1 ? half_m.x() : -half_m.x(), i & 2 ? half_m.y() : -half_m.y(),
                                    i & 4 ? half_m.z() : -half_m.z()));
  return cloud;
}

PointCloud picked(const PointCloud& from, const std::vector<std::size_t>& order) {
  PointCloud cloud;
  for (const std::size_t i : order) cloud.append(from.point(i));
  cloud.image = from.image;
  return cloud;
}

// --- mean ---

TEST(GuidanceTarget, TheMeanIsThatOfTheShares) {
  PointCloud cloud;
  for (const Vec3& p : {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 4), Vec3(100, 100, 100)}) cloud.append(p);
  const GuidanceTarget target = guidance_target(cloud, {1, 0.5, 0.25, 0});
  EXPECT_EQ(target.points, 3u);
  EXPECT_LT((target.mean_W - Vec3(1, 1, 1) / 1.75).norm(), 1e-15);
}

TEST(GuidanceTarget, IsNotVisibleIfNoPointIsPicked) {
  EXPECT_FALSE(guidance_target({}, {}).is_visible());
  const GuidanceTarget none = guidance_target(scenes::flat_grid(3), std::vector<double>(9, 0));
  EXPECT_FALSE(none.is_visible() || none.is_flat());
  EXPECT_EQ(none.mean_W, Vec3::Zero());
}

TEST(GuidanceTarget, OneOrTwoPointsHaveAPlaceAndNoPlane) {
  PointCloud cloud;
  cloud.append({1, 2, 3});
  EXPECT_EQ(whole(cloud).mean_W, Vec3(1, 2, 3));
  EXPECT_FALSE(whole(cloud).is_flat());
  cloud.append({2, 2, 5});
  EXPECT_EQ(whole(cloud).mean_W, Vec3(1.5, 2, 4));
  EXPECT_FALSE(whole(cloud).is_flat());
}

// Two points lie on a line, except for rounding. Points that nearly coincide differ by nothing but rounding.
TEST(GuidanceTarget, TwoPointsHaveNoPlaneHoweverNearTheyAre) {
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
  PointCloud cloud = chessboard(turn({0.4, 0.1, 0}), 4, 0);
  const GuidanceTarget expected = whole(cloud);
  for (const Vec3& p : {Vec3(kNaN, kNaN, kNaN), Vec3(kInfinity, 0, 0), Vec3(0, kNaN, 0)}) cloud.append(p);
  const GuidanceTarget target = whole(cloud);
  EXPECT_EQ(target.points, 16u);
  EXPECT_EQ(target.mean_W, expected.mean_W);
  EXPECT_EQ(target.normal_W, expected.normal_W);
}

// --- plane ---

TEST(GuidanceTarget, ThePlaneOfATiltedBoardIsFoundThroughItsNoise) {
  for (const double noise_m : {0.0, 1e-4, 2e-3}) {
    const Eigen::Matrix3d R = turn({0.7, -0.3, 0.2});
    const GuidanceTarget target = whole(chessboard(R, 10, noise_m));
    EXPECT_LT((target.mean_W - kCentre).norm(), 1e-14);
    EXPECT_NEAR(std::abs(target.normal_W.dot(R.col(2))), 1, 1e-12) << noise_m;
    EXPECT_NEAR(target.normal_W.norm(), 1, 1e-14);
  }
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

TEST(GuidanceTarget, ABallHasNoPlane) {
  PointCloud ball;
  for (int k = 0; k < 500; ++k) {
    const double v = 2 * (k + 0.5) / 500 - 1, w = std::sqrt(1 - v * v);
    ball.append(kCentre + 0.1 * Vec3(w * std::cos(2.399963 * k), v, w * std::sin(2.399963 * k)));
  }
  const GuidanceTarget target = whole(ball);
  EXPECT_FALSE(target.is_flat());
  EXPECT_LT((target.mean_W - kCentre).norm(), 1e-4);
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
  PointCloud board = chessboard(R, 6, 1e-4);
  EXPECT_LT(whole(board).normal_W.dot(kCentre), 0) << "in the origin without an image";
  for (const double side : {1.0, -1.0}) {
    board.image.emplace();
    board.image->X_WC =
        Eigen::Translation3d(kCentre + 0.5 * side * R.col(2) + 0.2 * R.col(0)) * rotation({1, 0, 0});
    EXPECT_NEAR(whole(board).normal_W.dot(R.col(2)), side, 1e-12);
  }
}

// --- invariance ---

TEST(GuidanceTarget, MovesWithTheScene) {
  const RigidTransform X = Eigen::Translation3d(0.3, -1.2, 2.5) * rotation({0.4, -1.7, 0.2});
  PointCloud board = chessboard(turn({0.1, 0.6, 0}), 8, 1e-3), moved;
  board.image.emplace();
  board.image->X_WC = RigidTransform(Eigen::Translation3d(0.1, 0.2, -0.3));
  for (std::size_t i = 0; i < board.size(); ++i) moved.append(X * board.point(i));
  moved.image = board.image;
  moved.image->X_WC = X * board.image->X_WC;
  const GuidanceTarget a = whole(board), b = whole(moved);
  EXPECT_LT((X * a.mean_W - b.mean_W).norm(), 1e-14);
  EXPECT_LT((X.linear() * a.normal_W - b.normal_W).norm(), 1e-12);
}

TEST(GuidanceTarget, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud board = chessboard(turn({0.1, 0.6, 0}), 8, 1e-3);
  std::vector<std::size_t> order(board.size());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937 random(8);
  const GuidanceTarget expected = whole(board);
  for (int run = 0; run < 20; ++run) {
    std::shuffle(order.begin(), order.end(), random);
    const GuidanceTarget target = whole(picked(board, order));
    EXPECT_LT((target.mean_W - expected.mean_W).norm(), 1e-15);
    EXPECT_LT((target.normal_W - expected.normal_W).norm(), 1e-12);
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

}  // namespace
}  // namespace remote_touch::guidance_target_test
