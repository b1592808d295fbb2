// The error of the registration of a slave: its size, its directions, and that it belongs to the key.
#include "core/teleoperation/registration_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/rotation.h"

namespace remote_touch::registration_error_test {
namespace {

constexpr int kDraws = 2000;

NoiseKey key(int replicate) {
  return {7, 0, static_cast<std::uint64_t>(replicate)};
}

TEST(RegistrationError, NoErrorIsTheIdentity) {
  const Vec3 p(0.1, -0.2, 0.3);
  EXPECT_EQ(registration_of({}, key(3)) * p, p);
}

TEST(RegistrationError, HasTheSizeThatIsAskedFor) {
  for (int i = 0; i < 20; ++i) {
    const RigidTransform X = registration_of({0.004, 2}, key(i));
    EXPECT_NEAR(X.translation().norm(), 0.004, 1e-15);
    const Eigen::Quaterniond turn(X.linear());
    EXPECT_NEAR(rotation_vector(turn).norm(), 2 * kRadiansPerDegree, 1e-12);
  }
}

// The axis of the rotation goes through the centre, so a point at its distance d moves by 2 d sin(a / 2),
// where d is the distance from the axis. Without an offset the centre stays.
TEST(RegistrationError, TurnsAboutItsCentre) {
  const Vec3 centre(0.5, -0.1, 0.3);
  double largest_m = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X = registration_of({0.004, 2, centre}, key(i));
    const RigidTransform about_origin = registration_of({0.004, 2}, key(i));
    EXPECT_TRUE(X.linear().isApprox(about_origin.linear(), 0)) << "the centre changes no direction";
    EXPECT_NEAR((X * centre - centre - about_origin.translation()).norm(), 0, 1e-15);
    const RigidTransform turn = registration_of({0, 2, centre}, key(i));
    largest_m = std::max(largest_m, (turn * Vec3::Zero()).norm());
  }
  const double bound_m = 2 * centre.norm() * std::sin(kRadiansPerDegree);
  EXPECT_LE(largest_m, bound_m + 1e-12);
  EXPECT_GT(largest_m, 0.99 * bound_m);
}

// The mean of n unit vectors that are uniform on the sphere has the length 1 / sqrt(n), and the mean of their
// products is a third of the identity. A direction of every run would not be random.
TEST(RegistrationError, DirectionsAreUniformAndIndependent) {
  Vec3 offsets = Vec3::Zero(), axes = Vec3::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double products = 0;
  for (int i = 0; i < kDraws; ++i) {
    const RigidTransform X = registration_of({1, 10}, key(i));
    const Vec3 axis = rotation_vector(Eigen::Quaterniond(X.linear())).normalized();
    offsets += X.translation(), axes += axis, products += axis.dot(X.translation());
    spread += X.translation() * X.translation().transpose();
  }
  const double allowed = 4 / std::sqrt(kDraws);
  EXPECT_LT(offsets.norm() / kDraws, allowed);
  EXPECT_LT(axes.norm() / kDraws, allowed);
  EXPECT_LT(std::abs(products) / kDraws, allowed);
  EXPECT_LT((spread / kDraws - Eigen::Matrix3d::Identity() / 3).norm(), allowed);
}

TEST(RegistrationError, BelongsToTheKey) {
  const RegistrationError error{0.01, 5};
  EXPECT_TRUE(registration_of(error, key(1)).isApprox(registration_of(error, key(1)), 0));
  EXPECT_FALSE(registration_of(error, key(1)).isApprox(registration_of(error, key(2)), 0.001));
  // A larger error has the same direction.
  EXPECT_LT(
      (registration_of({0.02, 5}, key(1)).translation() - 2 * registration_of(error, key(1)).translation())
          .norm(),
      1e-15);
}

// The runs of one replicate of a sweep have the same error, so that its cells are compared in pairs.
TEST(RegistrationError, IsTheSameInEveryCellOfASweep) {
  const RegistrationError error{0.01, 5};
  EXPECT_TRUE(registration_of(error, {7, 0, 3}).isApprox(registration_of(error, {7, 12, 3}), 0));
  EXPECT_FALSE(registration_of(error, {7, 0, 3}).isApprox(registration_of(error, {8, 0, 3}), 0.001));
}

}  // namespace
}  // namespace remote_touch::registration_error_test
