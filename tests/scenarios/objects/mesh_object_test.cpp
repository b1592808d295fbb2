// Poses between given times against the spherical interpolation of Eigen, and the nearest of several posed
// meshes against the closed form of the distance to a box.
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

TEST(PosePath, PassesThroughItsPosesAndRestsBeforeAndAfterThem) {
  const std::vector<StampedPose> poses = random_poses(20);
  const PosePath path(poses);
  for (const StampedPose& pose : poses)
    EXPECT_TRUE((path.at(pose.time_s).matrix().array() == pose.X.matrix().array()).all()) << pose.time_s;
  EXPECT_EQ(path.duration_s(), poses.back().time_s);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double time_s : {-infinity, -5.0, -0.71})
    EXPECT_TRUE((path.at(time_s).matrix().array() == poses.front().X.matrix().array()).all()) << time_s;
  for (const double time_s : {path.duration_s() + 1e-9, 1e9, infinity})
    EXPECT_TRUE((path.at(time_s).matrix().array() == poses.back().X.matrix().array()).all()) << time_s;
  const PosePath one(poses.back().X);
  EXPECT_EQ(one.duration_s(), 0);
  for (const double time_s : {-1.0, 0.0, 7.0})
    EXPECT_TRUE((one.at(time_s).matrix().array() == poses.back().X.matrix().array()).all()) << time_s;
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

// A row: objects, their poses, position, reach, and the expected distance (NaN: not known), normal and
// object.
TEST(NearestOnObjects, IsKnownOrNotAtSpecialPositions) {
  struct Row {
    std::vector<MeshObject> objects;
    Poses X_PO;
    Vec3 p_P;
    double reach_m, distance_m;
    Vec3 normal = Vec3::Zero();
    int object = 0;
  };
  const double nothing = std::nan(""), quarter_turn = std::acos(0.0);
  const RigidTransform here = RigidTransform::Identity(), turned = pose({1, 2, 3}, {0, 0, quarter_turn});
  const Row rows[] = {
      {{box()}, {turned}, {1, 2.15, 3}, kFar_m, 0.05, Vec3::UnitY()},  // x of the object is y of the parent
      {{box()}, {turned}, {1, 1.91, 3}, kFar_m, -0.01, -Vec3::UnitY()},
      {{}, {}, {0, 0, 0}, kFar_m, nothing},
      {{box(), box()}, {{}, {}}, {0, 0, 0}, kFar_m, nothing},  // no pose
      {{box(), box()}, {{}, pose({0, 0, -0.3})}, {0, 0, 0}, kFar_m, 0.1, Vec3::UnitZ(), 1},
      {{box()}, {here}, {0, 0, 0.229}, 0.03, 0.029, Vec3::UnitZ()},
      {{box()}, {here}, {0, 0, 0.231}, 0.03, nothing},  // beyond the reach
      {{box()}, {here}, {0.071, 0, 0}, 0.03, -0.029, Vec3::UnitX()},
      {{box()}, {here}, {0.069, 0, 0}, 0.03, nothing},
      {{box()}, {here}, {nothing, nothing, nothing}, kFar_m, nothing},
      {{box()}, {here}, {0, INFINITY, 0}, kFar_m, nothing},
      {{sheet()}, {here}, {0.4, 0.1, 0.2}, kFar_m, 0.2, Vec3::UnitZ()},
      {{sheet()}, {here}, {0.4, 0.1, -0.2}, kFar_m, -0.2, Vec3::UnitZ()},
      {{sheet()}, {here}, {0.51, 0.1, 0.2}, kFar_m, nothing},  // beyond its border
      {{sheet()}, {here}, {0.6, 0.7, -0.2}, kFar_m, nothing},
      {{sheet(), box()}, {here, pose({1, 0, 0})}, {0.6, 0, 0}, kFar_m, 0.3, -Vec3::UnitX(), 1},  // farther
      {{box(), box(), box()}, {pose({5, 0, 0}), here, here}, {0.2, 0, 0}, kFar_m, 0.1, Vec3::UnitX(), 1},
  };
  for (const Row& row : rows) {
    const NearestOnObjects nearest = nearest_on_objects(row.objects, row.X_PO, row.p_P, row.reach_m);
    SCOPED_TRACE(testing::Message() << row.p_P.transpose() << ", reach " << row.reach_m);
    const bool is_known = !std::isnan(row.distance_m);
    EXPECT_EQ(nearest.object, is_known ? row.object : -1);
    EXPECT_EQ(std::isnan(nearest.distance_m), !is_known);
    if (is_known) {
      EXPECT_NEAR(nearest.distance_m, row.distance_m, 1e-15);
      EXPECT_TRUE(nearest.normal.isApprox(row.normal, 1e-15)) << nearest.normal.transpose();
    } else {
      EXPECT_TRUE(nearest.normal.array().isNaN().all());
    }
  }
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
