#include "scenarios/objects/mesh_object.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch::mesh_object_test {
namespace {

// Poses at and between the given times, compared with Eigen's spherical interpolation.

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

// The nearest of several posed meshes, compared with the closed form of the distance to a box.

constexpr double kFar_m = 100;
using Poses = std::vector<std::optional<RigidTransform>>;

const Vec3 kSides_m(0.2, 0.3, 0.4);

MeshObject box(const Vec3& sides_m = kSides_m) {
  return {"box", std::make_shared<const MeshDistance>(box_mesh(sides_m)), true};
}

// A square of 1 m in the plane z = 0, which points along z.
MeshObject sheet() {
  const TriangleMesh mesh{{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}},
                          {{0, 1, 2}, {0, 2, 3}}};
  return {"sheet", std::make_shared<const MeshDistance>(mesh), false};
}

RigidTransform pose(const Vec3& position_m, const Vec3& rotation_vector = Vec3::Zero()) {
  return Eigen::Translation3d(position_m) * rotation(rotation_vector);
}

// Signed distance to a box around the origin of its frame.
double to_box(const Vec3& p_O, const Vec3& sides_m) {
  const Vec3 beyond = p_O.cwiseAbs() - sides_m / 2;
  return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

TEST(NearestOnObjects, IsTheSmallestDistanceToPosedBoxes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  const auto vector = [&](double size) { return Vec3(size * Vec3(any(random), any(random), any(random))); };
  const std::vector<MeshObject> objects = {box(), box({0.1, 0.1, 0.5}), box({0.6, 0.1, 0.2})};
  const std::vector<Vec3> sides_m = {kSides_m, {0.1, 0.1, 0.5}, {0.6, 0.1, 0.2}};
  int negative = 0;
  for (int i = 0; i < 2000; ++i) {
    const Poses X_PO = {pose(vector(0.5), vector(6)), pose(vector(0.5), vector(6)),
                        pose(vector(0.5), vector(6))};
    const Vec3 p_P = vector(0.8);
    std::vector<double> expected_m;
    for (std::size_t k = 0; k < objects.size(); ++k)
      expected_m.push_back(to_box(X_PO[k]->inverse() * p_P, sides_m[k]));
    const auto smallest = std::min_element(expected_m.begin(), expected_m.end());
    const NearestOnObjects nearest = nearest_on_objects(objects, X_PO, p_P, kFar_m);
    ASSERT_NEAR(nearest.distance_m, *smallest, 1e-14);
    ASSERT_EQ(nearest.object, smallest - expected_m.begin());
    ASSERT_NEAR(nearest.normal.norm(), 1, 1e-14);
    negative += *smallest < 0;
  }
  EXPECT_GT(negative, 100);
}

TEST(NearestOnObjects, NormalIsInTheFrameOfThePosition) {
  const std::vector<MeshObject> objects = {box()};
  const double quarter_turn = std::acos(0.0);
  const Poses X_PO = {pose({1, 2, 3}, {0, 0, quarter_turn})};  // x of the object is y of the parent
  const NearestOnObjects above = nearest_on_objects(objects, X_PO, {1, 2.15, 3}, kFar_m);
  EXPECT_NEAR(above.distance_m, 0.05, 1e-15);
  EXPECT_TRUE(above.normal.isApprox(Vec3::UnitY(), 1e-15)) << above.normal.transpose();
  const NearestOnObjects inside = nearest_on_objects(objects, X_PO, {1, 1.91, 3}, kFar_m);
  EXPECT_NEAR(inside.distance_m, -0.01, 1e-15);
  EXPECT_TRUE(inside.normal.isApprox(-Vec3::UnitY(), 1e-15)) << inside.normal.transpose();
}

void expect_unknown(const NearestOnObjects& nearest) {
  EXPECT_TRUE(std::isnan(nearest.distance_m));
  EXPECT_TRUE(nearest.normal.array().isNaN().all());
  EXPECT_EQ(nearest.object, -1);
}

TEST(NearestOnObjects, IsUnknownWithoutAPose) {
  const std::vector<MeshObject> objects = {box(), box()};
  expect_unknown(nearest_on_objects(objects, Poses{{}, {}}, Vec3::Zero(), kFar_m));
  const NearestOnObjects second =
      nearest_on_objects(objects, Poses{{}, pose({0, 0, -0.3})}, Vec3::Zero(), kFar_m);
  EXPECT_EQ(second.object, 1);
  EXPECT_NEAR(second.distance_m, 0.1, 1e-15);
  expect_unknown(nearest_on_objects({}, {}, Vec3::Zero(), kFar_m));
}

TEST(NearestOnObjects, IsUnknownBeyondTheReach) {
  const std::vector<MeshObject> objects = {box()};
  const Poses at_origin = {RigidTransform::Identity()};
  EXPECT_NEAR(nearest_on_objects(objects, at_origin, {0, 0, 0.229}, 0.03).distance_m, 0.029, 1e-15);
  expect_unknown(nearest_on_objects(objects, at_origin, {0, 0, 0.231}, 0.03));
  EXPECT_NEAR(nearest_on_objects(objects, at_origin, {0.071, 0, 0}, 0.03).distance_m, -0.029, 1e-15);
  expect_unknown(nearest_on_objects(objects, at_origin, {0.069, 0, 0}, 0.03));
}

TEST(NearestOnObjects, IsUnknownForPositionsThatAreNotFinite) {
  const std::vector<MeshObject> objects = {box()};
  const Poses at_origin = {RigidTransform::Identity()};
  expect_unknown(nearest_on_objects(objects, at_origin, Vec3::Constant(std::nan("")), kFar_m));
  expect_unknown(nearest_on_objects(objects, at_origin, {0, INFINITY, 0}, kFar_m));
}

TEST(NearestOnObjects, OpenSheetEndsAtItsBorder) {
  const std::vector<MeshObject> objects = {sheet()};
  const Poses at_origin = {RigidTransform::Identity()};
  EXPECT_NEAR(nearest_on_objects(objects, at_origin, {0.4, 0.1, 0.2}, kFar_m).distance_m, 0.2, 1e-15);
  EXPECT_NEAR(nearest_on_objects(objects, at_origin, {0.4, 0.1, -0.2}, kFar_m).distance_m, -0.2, 1e-15);
  expect_unknown(nearest_on_objects(objects, at_origin, {0.51, 0.1, 0.2}, kFar_m));
  expect_unknown(nearest_on_objects(objects, at_origin, {0.6, 0.7, -0.2}, kFar_m));
}

// The sheet is nearer than the box, but ends before the position.
TEST(NearestOnObjects, BorderOfASheetDoesNotHideAnotherObject) {
  const std::vector<MeshObject> objects = {sheet(), box()};
  const Poses X_PO = {RigidTransform::Identity(), pose({1, 0, 0})};
  const NearestOnObjects nearest = nearest_on_objects(objects, X_PO, {0.6, 0, 0}, kFar_m);
  EXPECT_EQ(nearest.object, 1);
  EXPECT_NEAR(nearest.distance_m, 0.3, 1e-15);
}

TEST(NearestOnObjects, FirstOfEqualObjectsIsChosen) {
  const std::vector<MeshObject> objects = {box(), box(), box()};
  const Poses X_PO = {pose({5, 0, 0}), RigidTransform::Identity(), RigidTransform::Identity()};
  EXPECT_EQ(nearest_on_objects(objects, X_PO, {0.2, 0, 0}, kFar_m).object, 1);
}

TEST(PosedMeshes, AreTheObjectsAtTheirPoses) {
  const std::vector<MeshObject> objects = {box(), sheet()};
  const std::vector<PosedMesh> meshes = posed_meshes(objects, Poses{pose({1, 2, 3}), std::nullopt});
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "box");
  EXPECT_EQ(meshes[0].triangles.size(), 12u);
  for (const Vec3& p_O : meshes[0].vertices_O) EXPECT_EQ(p_O.cwiseAbs(), kSides_m / 2);
  EXPECT_EQ(meshes[0].X_WO.value().translation(), Vec3(1, 2, 3));
  EXPECT_EQ(meshes[1].triangles.size(), 2u);
  EXPECT_FALSE(meshes[1].X_WO);
}

}  // namespace
}  // namespace remote_touch::mesh_object_test
