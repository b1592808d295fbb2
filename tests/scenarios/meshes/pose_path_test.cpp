// Poses at and between the given times, compared with Eigen's spherical interpolation.
#include "scenarios/meshes/pose_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace remote_touch::pose_path_test {
namespace {

const double kPi = std::acos(-1.0);

RigidTransform about_z(double angle, const Vec3& position_m) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  X.translation() = position_m;
  return X;
}

std::vector<StampedPose> random_poses(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<StampedPose> poses;
  double time_s = -0.7;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    StampedPose pose{time_s};
    pose.X.linear() = q.normalized().toRotationMatrix();
    pose.X.translation() = Vec3(normal(random), normal(random), normal(random));
    poses.push_back(pose);
    time_s += 0.1 + std::abs(normal(random));
  }
  return poses;
}

TEST(PosePath, PassesThroughItsPoses) {
  const std::vector<StampedPose> poses = random_poses(20);
  const PosePath path(poses);
  for (const StampedPose& pose : poses)
    EXPECT_TRUE((path.at(pose.time_s).matrix().array() == pose.X.matrix().array()).all()) << pose.time_s;
  EXPECT_EQ(path.duration_s(), poses.back().time_s);
}

TEST(PosePath, RestsBeforeTheFirstPoseAndAfterTheLast) {
  const std::vector<StampedPose> poses = random_poses(3);
  const PosePath path(poses);
  for (const double time_s : {-std::numeric_limits<double>::infinity(), -5.0, -0.71})
    EXPECT_TRUE((path.at(time_s).matrix().array() == poses.front().X.matrix().array()).all()) << time_s;
  for (const double time_s : {path.duration_s() + 1e-9, 1e9, std::numeric_limits<double>::infinity()})
    EXPECT_TRUE((path.at(time_s).matrix().array() == poses.back().X.matrix().array()).all()) << time_s;
}

TEST(PosePath, MovesStraightAndTurnsAboutOneAxis) {
  const std::vector<StampedPose> poses = random_poses(50);
  const PosePath path(poses);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const StampedPose &a = poses[i], &b = poses[i + 1];
    const Eigen::Quaterniond from(a.X.linear()), to(b.X.linear());
    for (const double share : {0.001, 0.25, 0.5, 0.9}) {
      const RigidTransform X = path.at(a.time_s + share * (b.time_s - a.time_s));
      const Eigen::Matrix3d expected = from.slerp(share, to).toRotationMatrix();
      EXPECT_LT((X.linear() - expected).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_LT((X.translation() - (1 - share) * a.X.translation() - share * b.X.translation()).norm(),
                1e-13);
      EXPECT_LT((X.linear().transpose() * X.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
                1e-13);
    }
  }
}

TEST(PosePath, TurnsTheShorterWay) {
  const PosePath path(
      std::vector<StampedPose>{{0, about_z(0, {0, 0, 0})}, {2, about_z(1.5 * kPi, {4, 0, 2})}});
  const RigidTransform X = path.at(1);
  EXPECT_LT((X.matrix() - about_z(-0.25 * kPi, {2, 0, 1}).matrix()).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(PosePath, OfOnePoseRests) {
  const RigidTransform X = about_z(1, {1, 2, 3});
  const PosePath path(X);
  EXPECT_EQ(path.duration_s(), 0);
  for (const double time_s : {-1.0, 0.0, 7.0})
    EXPECT_TRUE((path.at(time_s).matrix().array() == X.matrix().array()).all()) << time_s;
}

TEST(PosePath, RejectsTimesThatDoNotIncrease) {
  const RigidTransform X = RigidTransform::Identity();
  const auto make = [](const std::vector<StampedPose>& poses) { return PosePath(poses); };
  EXPECT_THROW(make({}), std::invalid_argument);
  EXPECT_THROW(make({{0, X}, {0, X}}), std::invalid_argument);
  EXPECT_THROW(make({{0, X}, {1, X}, {0.5, X}}), std::invalid_argument);
  EXPECT_THROW(make({{std::nan(""), X}}), std::invalid_argument);
  EXPECT_THROW(make({{0, X}, {std::nan(""), X}}), std::invalid_argument);
  EXPECT_THROW(make({{0, X}, {std::numeric_limits<double>::infinity(), X}}), std::invalid_argument);
}

}  // namespace
}  // namespace remote_touch::pose_path_test
