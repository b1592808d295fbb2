#include "core/points/vector.h"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace remote_touch::vector_test {
namespace {

TEST(BoundingBox, IsAroundEveryPosition) {
  const BoundingBox box = bounding_box(std::vector<Vec3>{{1, -2, 3}, {-1, 5, 3}, {0, 0, 4}});
  EXPECT_EQ(box.min(), Vec3(-1, -2, 3));
  EXPECT_EQ(box.max(), Vec3(1, 5, 4));
  EXPECT_TRUE(bounding_box(std::vector<Vec3>{}).isEmpty());
}

TEST(LimitedLength, OnlyWhatIsLongerIsShortened) {
  EXPECT_EQ(limited_length({3, 0, 4}, 5), Vec3(3, 0, 4));
  EXPECT_EQ(limited_length({3, 0, 4}, 2.5), Vec3(1.5, 0, 2));
  EXPECT_EQ(limited_length({3, 0, 4}, 0), Vec3(0, 0, 0));
  EXPECT_EQ(limited_length({0, 0, 0}, 0), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace remote_touch::vector_test

namespace remote_touch::rotation_test {
namespace {

const double kPi = std::acos(-1.0);

TEST(Rotation, SineAndCosineAreThoseOfTheLibrary) {
  for (double angle = -50; angle < 50; angle += 0.00137) {
    const auto [s, c] = sin_cos(angle);
    ASSERT_NEAR(s, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(c, std::cos(angle), 3e-16) << angle;
  }
  for (double angle = -9.9e5; angle < 9.9e5; angle += 1371.7) {
    ASSERT_NEAR(sin_cos(angle).first, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(sin_cos(angle).second, std::cos(angle), 3e-16) << angle;
  }
  EXPECT_EQ(sin_cos(0).first, 0);
  EXPECT_EQ(sin_cos(0).second, 1);
}

TEST(Rotation, TurnsAboutItsAxisByItsLength) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double angle = 3 * normal(random);
    const Eigen::Quaterniond q = rotation(angle * axis);
    EXPECT_NEAR(q.norm(), 1, 4e-16);
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((q.toRotationMatrix() - expected).norm(), 5e-15);
  }
  EXPECT_EQ(rotation(Vec3::Zero()).coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Rotation, VectorIsTheShortestOfTheRotation) {
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-3, 0.5, 1.5, 3.0, kPi - 1e-9}) {
    const Vec3 vector = angle * Vec3(2, -1, 2) / 3;
    EXPECT_LT((rotation_vector(rotation(vector)) - vector).norm(), 1e-15 * (1 + angle)) << angle;
    // The same rotation, written the other way.
    const Eigen::Quaterniond q = rotation(vector), other(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((rotation_vector(other) - vector).norm(), 1e-15 * (1 + angle)) << angle;
  }
  const Vec3 far = 1.5 * kPi * Vec3::UnitX();
  EXPECT_LT((rotation_vector(rotation(far)) + 0.5 * kPi * Vec3::UnitX()).norm(), 1e-15);
}

}  // namespace
}  // namespace remote_touch::rotation_test

namespace remote_touch::angle_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(AngleBetween, IsThatOfTheLibraryForRandomVectors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a(normal(random), normal(random), normal(random));
    const Vec3 b(normal(random), normal(random), normal(random));
    const double expected = std::atan2(a.cross(b).norm(), a.dot(b));
    ASSERT_NEAR(angle_between(1e-3 * a, 1e3 * b), expected, 2e-15) << i;
    ASSERT_EQ(angle_between(a, b), angle_between(b, a));
  }
}

// Acos of the dot product would lose half of the digits at both ends.
TEST(AngleBetween, IsExactAtBothEnds) {
  for (const double angle : {1e-12, 1e-8, 1e-4, 0.1, kPi / 2, 3.0}) {
    const Vec3 a(2, 0, 0), b(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(angle_between(a, b), angle, 2e-15) << angle;
    EXPECT_NEAR(angle_between(a, -b), kPi - angle, 2e-15) << angle;
  }
  EXPECT_EQ(angle_between(Vec3(1, 2, 3), Vec3(2, 4, 6)), 0);
  EXPECT_NEAR(angle_between(Vec3(1, 2, 3), Vec3(-1, -2, -3)), kPi, 2e-15);
  EXPECT_NEAR(angle_between(Vec3(1, 0, 0), Vec3(0, 1, 0)), kPi / 2, 2e-15);
}

}  // namespace
}  // namespace remote_touch::angle_test
