#include "core/geometry/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
