// Meshes that are placed and moved: the true surface against closed forms, and meshes that are refused in one
// line.
#include "runners/experiment/mesh_files/placed_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "tests/runners/experiment/mesh_files/box_scene.h"
#include "tests/support/meshes.h"

namespace remote_touch::placed_mesh_test {
namespace {

using namespace box_scene;

class PlacedMeshes : public BoxScene {};

// --- positions ---

TEST_F(PlacedMeshes, AnObjectStandsAtItsPosition) {
  Settings s = box_alone();
  s.objects[0].position_m = {0.1, -0.05, 0.2};
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0.1, -0.05 + 0.5 * kSides_m.y(), 0.2)));
  s.objects[0].origin = PlacedMesh::Origin::file;
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0.1, -0.05, 0.2) + kCentre_m));
}

TEST_F(PlacedMeshes, TheSizeIsThatOfTheLongestSide) {
  Settings s = box_alone();
  s.objects[0].size_m = 0.125;
  const Vec3 sides = 0.25 * kSides_m;
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0, 0.5 * sides.y(), 0)), sides);
}

TEST_F(PlacedMeshes, AVertexWithoutTrianglesIsNotInTheSize) {
  Settings s = box_alone();
  TriangleMesh mesh = box_mesh(kSides_m);
  mesh.vertices.insert(mesh.vertices.begin(), Vec3(9, 9, 9));
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) ++corner;
  write("box.obj", mesh);
  s.objects[0].size_m = 0.5;
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0, 0.5 * kSides_m.y(), 0)));
}

TEST_F(PlacedMeshes, ATurnedObjectStandsOnItsLowestPoint) {
  Settings s = box_alone();
  s.objects[0].rotation_deg = {-90, 0, 0};  // z of the file is up
  expect_box(made(s), 0, turned({-90, 0, 0}, Vec3(0, 0.5 * kSides_m.z(), 0)));
  s.objects[0].rotation_deg = {0, 0, 45};
  const double height = (kSides_m.x() + kSides_m.y()) / std::sqrt(2);
  expect_box(made(s), 0, turned({0, 0, 45}, Vec3(0, 0.5 * height, 0)));
}

TEST_F(PlacedMeshes, ASphereHasTheDistanceOfASphere) {
  constexpr double kRadius_m = 0.1, kSag_m = 3e-4;  // between the sphere and its triangles
  Settings s = box_alone();
  s.objects[0].mesh = write("ball.obj", sphere(kRadius_m));
  const MeshSceneFromFiles scene = made(s);
  for (const Vec3& p : positions_around({0, kRadius_m, 0}, {0.3, 0.3, 0.3}))
    EXPECT_NEAR(scene.signed_distance(p, 0), (p - Vec3(0, kRadius_m, 0)).norm() - kRadius_m, kSag_m);
}

TEST_F(PlacedMeshes, SeveralObjectsCountAsTheirUnion) {
  Settings s = box_alone();
  s.objects[1] = {.mesh = "slab-40", .position_m = {0.4, 0, 0}};
  s.objects[2] = {.mesh = s.objects[0].mesh, .size_m = 0.25, .position_m = {-0.4, 0.1, 0}};
  const MeshSceneFromFiles scene = made(s);
  for (const Vec3& p : positions_around({0, 0.1, 0}, {1, 0.3, 0.6})) {
    const double first = distance_to_box(p, {0, 0.0625, 0}, kSides_m);
    const double second = distance_to_box(p, {0.4, 0.02, 0}, {0.04, 0.04, 0.04});
    const double third = distance_to_box(p, {-0.4, 0.13125, 0}, 0.5 * kSides_m);
    EXPECT_NEAR(scene.signed_distance(p, 0), std::min({first, second, third}), 1e-9) << p.transpose();
  }
  EXPECT_EQ(scene.true_meshes(0).size(), 3u);
}

// --- motions ---

TEST_F(PlacedMeshes, AMotionMovesTheTrueSurfaceAtAllTimes) {
  Settings s = box_alone();
  s.objects[0].position_m = {0.1, 0.2, 0};
  s.objects[0].motion = {0.2, 0, 0, 0, 0, 0, 0, 1.2, 0, 0.3, 0, 0, 90, 0};
  const MeshSceneFromFiles scene = made(s);
  for (const double time : {0.0, 0.1999, 0.37, 0.7, 1.1, 1.2, 9.0}) {
    const double share = std::clamp(time - 0.2, 0.0, 1.0);
    const Vec3 middle(0.1, 0.2 + 0.3 * share + 0.5 * kSides_m.y(), 0);
    expect_box(scene, time, turned({0, 90 * share, 0}, middle));
  }
}

// A hand at rest over the middle of the top comes nearer to it at the speed of the motion.
TEST_F(PlacedMeshes, TheTrueSurfaceHasTheVelocityOfTheMotion) {
  Settings s = box_alone();
  s.objects[0].motion = {0, 0, 0, 0, 0, 0, 0, 0.5, 0.05, 0.1, 0, 0, 0, 0, 1, 0.05, -0.3, 0, 0, 0, 0};
  const MeshSceneFromFiles scene = made(s);
  constexpr double kStep_s = 1e-4;
  const Vec3 p_W(0.02, 0.3, 0.03);
  for (const auto& [time, speed] : {std::pair(0.013, 0.2), {0.4, 0.2}, {0.6, -0.8}, {0.99, -0.8}, {1.1, 0.0}})
    EXPECT_NEAR((scene.signed_distance(p_W, time) - scene.signed_distance(p_W, time + kStep_s)) / kStep_s,
                speed, 1e-8)
        << time;
}

TEST_F(PlacedMeshes, APathIsThatOfItsFile) {
  const double half = std::sqrt(0.5);
  std::ostringstream path;
  path.precision(17);
  path << "# t tx ty tz qx qy qz qw\n100 0 0 0 0 0 0 1\n100.5 0.2 0 0 0 0 0 1\n101.5 0.2 0.1 0 0 " << half
       << " 0 " << half << "\n";
  Settings s = box_alone();
  s.objects[0].path = folder_.write("path.txt", path.str()).string();
  s.objects[0].origin = PlacedMesh::Origin::file;
  s.objects[0].position_m = {0, 0, 0.3};
  s.objects[0].rotation_deg = {0, 90, 0};
  const MeshSceneFromFiles scene = made(s);
  const RigidTransform X_WP = turned({0, 90, 0}, {0, 0, 0.3}), X_OB = turned(Vec3::Zero(), kCentre_m);
  for (const double time : {0.0, 0.2, 0.5, 0.9, 1.5, 4.0}) {
    const double first = std::min(time / 0.5, 1.0), second = std::clamp(time - 0.5, 0.0, 1.0);
    expect_box(scene, time, X_WP * turned({0, 90 * second, 0}, {0.2 * first, 0.1 * second, 0}) * X_OB);
  }
  EXPECT_EQ(scene.frame_count(), 46) << "until the end of the path";
}

TEST_F(PlacedMeshes, AnObjectOnAPathStandsAtItsPositionAtTheStart) {
  Settings s = box_alone();
  s.objects[0].path = folder_.write("path.txt", "0 0.7 0.4 0 0 0 0 1\n2 0.7 0.6 0 0 0 0 1\n").string();
  s.objects[0].position_m = {0, 0.05, 0};
  const MeshSceneFromFiles scene = made(s);
  for (const double time : {0.0, 1.0, 2.0})
    expect_box(scene, time, turned(Vec3::Zero(), Vec3(0, 0.05 + 0.1 * time + 0.5 * kSides_m.y(), 0)));
}

// --- refusals ---

TEST_F(PlacedMeshes, RefusesFilesThatAreNotThere) {
  Settings s = box_alone();
  s.objects[1].mesh = "none.obj";
  EXPECT_HAS(refused(s), "scenario.second_mesh = none.obj: no such mesh: expected ball, bar");
  EXPECT_THROW(made(s), MissingRecording);
  s.objects[1].mesh = "bar", s.objects[1].path = "none.txt";
  EXPECT_HAS(refused(s), "none.txt");
  s.objects[1].path.clear(), s.camera_path = "none.tum";
  EXPECT_HAS(refused(s), "none.tum");
}

TEST_F(PlacedMeshes, RefusesMeshesThatAreNoSolidsInMetres) {
  const TriangleMesh box = box_mesh(kSides_m);
  TriangleMesh open = box;
  open.triangles.pop_back();
  EXPECT_HAS(refused("open.obj", open), "open.obj: not closed: 3 boundary edges");
  EXPECT_HAS(refused("open.obj", open), "expected a closed mesh, scenario.second_mesh_repair=true or");
  EXPECT_HAS(refused("in.obj", meshes::inside_out(box)), "in.obj: closed (1 part, 12 triangles, inside out)");
  const TriangleMesh large = meshes::moved(box, 1000 * Eigen::Matrix3d::Identity(), Vec3::Zero());
  EXPECT_HAS(refused("mm.obj", large), "mm.obj: its bounding box has a diagonal of 572.8");
  EXPECT_HAS(refused("mm.obj", large), "may be millimetres; scenario.second_mesh_size_m scales the mesh");
  const TriangleMesh point = meshes::moved(box, Eigen::Matrix3d::Zero(), Vec3::Zero());
  EXPECT_HAS(refused("point.obj", point), "point.obj: ");
  const TriangleMesh line = meshes::moved(box, Vec3(1, 0, 0).asDiagonal(), Vec3::Zero());
  EXPECT_HAS(refused("line.obj", line), "line.obj: ");
}

TEST_F(PlacedMeshes, RefusesAPartThatIsInsideOutUnlessItIsAHollow) {
  const TriangleMesh large = box_mesh({0.5, 0.5, 0.5});
  const auto with_small = [&](const Vec3& at) {
    return meshes::together(large, meshes::inside_out(box_mesh({0.25, 0.25, 0.25}, at)));
  };
  EXPECT_HAS(refused("two.obj", with_small({0.5, 0, 0})), "two.obj: a part of the mesh is inside out");
  Settings s = box_alone();
  s.objects[0].mesh = write("hollow.obj", with_small({0, 0, 0}));
  EXPECT_NEAR(made(s).signed_distance({0, 0.25, 0}, 0), 0.125, 1e-9) << "in the middle of the hollow";
  EXPECT_NEAR(made(s).signed_distance({0, 0.40625, 0}, 0), -0.03125, 1e-9) << "in the wall";
}

TEST_F(PlacedMeshes, ARepairClosesAndTurnsMeshes) {
  TriangleMesh open = box_mesh(kSides_m, kCentre_m);
  open.triangles.pop_back();
  const RigidTransform standing = turned(Vec3::Zero(), Vec3(0, 0.5 * kSides_m.y(), 0));
  for (const TriangleMesh& mesh : {open, meshes::inside_out(box_mesh(kSides_m, kCentre_m))}) {
    Settings s = box_alone();
    s.objects[0].mesh = write("broken.obj", mesh), s.objects[0].repair = true;
    expect_box(made(s), 0, standing);
  }
}

TEST_F(PlacedMeshes, RefusesTextThatIsNoMeshOrNoPath) {
  Settings s = box_alone();
  for (const char* name : {"no.obj", "no.ply", "no.stl"}) {
    s.objects[0].mesh = folder_.write(name, "no mesh\n").string();
    EXPECT_HAS(refused(s), name);
  }
  const auto path_refused = [this](const std::string& text) {
    Settings moved = box_alone();
    moved.objects[0].path = folder_.write("path.txt", text).string();
    return refused(moved);
  };
  EXPECT_HAS(path_refused(""), "path.txt: has no pose");
  EXPECT_HAS(path_refused("0 0 0 0 0 0 1\n"), "path.txt:1: has 7 words");
  EXPECT_HAS(path_refused("1 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n"), "path.txt:2: its time");
  EXPECT_HAS(path_refused("0 0 0 0 0 0 0 2\n"), "path.txt:1: its quaternion has the norm 2");
}

}  // namespace
}  // namespace remote_touch::placed_mesh_test
