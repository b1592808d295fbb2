#include "core/dissertation/tool/shape/mass_properties.h"

#include <gtest/gtest.h>

#include "core/dissertation/tool/shape/voxelisation.h"
#include "tests/support/meshes.h"

namespace remote_touch::mass_properties_test {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Vec3(x, y, z).asDiagonal();
}

TEST(MassProperties, AreRightForABox) {
  const MassProperties mass = mass_properties(box_mesh({0.3, 0.2, 0.1}, {5, -4, 3}));
  EXPECT_NEAR(mass.volume_m3, 0.006, 1e-15);
  EXPECT_LT((mass.centre - Vec3(5, -4, 3)).norm(), 1e-13);
  EXPECT_LT((mass.inertia_m2 - diagonal(0.05, 0.1, 0.13) / 12).norm(), 1e-13);
}

// Corners at 0 and the unit vectors: volume 1/6, centre 1/4; inertia 3/40 on and 1/80 off the diagonal.
TEST(MassProperties, AreRightForATetrahedron) {
  const MassProperties mass =
      mass_properties(meshes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_NEAR(mass.volume_m3, 1.0 / 6, 1e-15);
  EXPECT_LT((mass.centre - Vec3::Constant(0.25)).norm(), 1e-15);
  const Eigen::Matrix3d expected =
      diagonal(1, 1, 1) * (3.0 / 40 - 1.0 / 80) + Eigen::Matrix3d::Constant(1.0 / 80);
  EXPECT_LT((mass.inertia_m2 - expected).norm(), 1e-15) << mass.inertia_m2;
}

TEST(MassProperties, AreRightForABallWithinItsTriangles) {
  const MassProperties mass = mass_properties(find_generated_tool("ball")->make());
  EXPECT_NEAR(mass.volume_m3, 4.18879e-6, 0.01 * 4.2e-6);
  EXPECT_LT(mass.centre.norm(), 1e-5);
  EXPECT_LT((mass.inertia_m2 - 0.4 * 1e-4 * Eigen::Matrix3d::Identity()).norm(), 0.02 * 0.4e-4);
}

TEST(MassProperties, MoveAndTurnWithTheMesh) {
  const TriangleMesh key = find_generated_tool("key")->make();
  const MassProperties before = mass_properties(key);
  const Vec3 by(0.3, -0.2, 0.1);
  const MassProperties after = mass_properties(meshes::moved(key, meshes::rotated(), by));
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-12 * before.volume_m3);
  EXPECT_LT((after.centre - (meshes::rotated() * before.centre + by)).norm(), 1e-14);
  const Eigen::Matrix3d rotated = meshes::rotated() * before.inertia_m2 * meshes::rotated().transpose();
  EXPECT_LT((after.inertia_m2 - rotated).norm(), 1e-10 * rotated.norm());
}

TEST(MassProperties, InsideOutOnlyTheVolumeChangesItsSign) {
  const TriangleMesh key = find_generated_tool("key")->make();
  const MassProperties right = mass_properties(key), wrong = mass_properties(meshes::inside_out(key));
  EXPECT_NEAR(wrong.volume_m3, -right.volume_m3, 1e-12 * right.volume_m3);
  EXPECT_LT((wrong.centre - right.centre).norm(), 1e-12);
  EXPECT_LT((wrong.inertia_m2 - right.inertia_m2).norm(), 1e-12);
}

TEST(MassProperties, AreTheSameFromNodesAndFromTheMesh) {
  const TriangleMesh body = meshes::any_body("husky");
  const VoxelGrid grid = grid_around(body, 1e-3);
  const MassProperties fine = mass_properties(body),
                       coarse = mass_properties(grid, inside_nodes(body, grid).inside);
  EXPECT_NEAR(coarse.volume_m3, fine.volume_m3, 0.005 * fine.volume_m3);
  EXPECT_LT((coarse.centre - fine.centre).norm(), 5e-5);
  EXPECT_LT((coarse.inertia_m2 - fine.inertia_m2).norm(), 0.005 * fine.inertia_m2.norm());
}

}  // namespace
}  // namespace remote_touch::mass_properties_test
