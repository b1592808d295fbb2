#include "runners/experiment/mesh_files/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "core/points/point_cloud.h"
#include "tests/runners/experiment/mesh_files/box_scene.h"
#include "tests/support/meshes.h"
#include "tests/support/note_kinds.h"

namespace remote_touch::mesh_scene_from_files_test {
namespace {

// Meshes that are placed and moved: the true surface against closed forms, and meshes that are refused in one
// line.

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
  EXPECT_THROW(made(s), MissingInput);
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

// Scenes of mesh files: the table, what the camera sees, and settings that contradict each other.

class ScenesOfFiles : public BoxScene {};

// --- table and sheets ---

TEST_F(ScenesOfFiles, TheTableIsBelowTheObjects) {
  Settings s = box_alone();
  s.table = true, s.table_height_m = -0.1, s.objects[0].position_m = {0.3, 0, 0};
  const MeshSceneFromFiles scene = made(s);
  EXPECT_NEAR(scene.signed_distance({0.7, -0.05, 0.4}, 0), 0.05, 1e-9);
  EXPECT_NEAR(scene.signed_distance({0.7, -0.12, 0.4}, 0), -0.02, 1e-9);
  EXPECT_GT(scene.signed_distance({-0.4, -0.12, 0}, 0), 0.3) << "the table ends 0.57 m from its middle";
  s.objects[0].size_m = 4;
  EXPECT_NEAR(made(s).signed_distance({-3, -0.05, 0}, 0), 0.05, 1e-9) << "a large table for a large object";
  s.table = false;
  EXPECT_GT(made(s).signed_distance({-0.9, -0.05, 0.3}, 0), 0.1);
}

TEST_F(ScenesOfFiles, ATableAloneIsAScene) {
  Settings s = box_alone();
  s.objects[0].mesh.clear(), s.table = true;
  EXPECT_NEAR(made(s).signed_distance({0.2, 0.07, -0.3}, 3), 0.07, 1e-12);
  EXPECT_TRUE(made(s).cloud(0).is_measured(36 * 96 + 48));
}

TEST_F(ScenesOfFiles, ASheetHasASurfaceOnlyWithinItsBorder) {
  Settings s = box_alone();
  s.objects[0].mesh = write("sheet.obj", sheet());
  EXPECT_HAS(refused(s), "sheet.obj: not closed: 4 boundary edges");
  s.objects[0].sheet = true;
  const MeshSceneFromFiles scene = made(s);
  EXPECT_NEAR(scene.signed_distance({0.1, 0.03, 0.2}, 0), 0.03, 1e-9);
  EXPECT_NEAR(scene.signed_distance({0.1, -0.02, 0.2}, 0), -0.02, 1e-9);
  EXPECT_TRUE(std::isnan(scene.signed_distance({0.3, 0.03, 0}, 0)));
}

// --- views ---

TEST_F(ScenesOfFiles, PointsWithoutNoiseLieOnTheTrueSurface) {
  Settings s = box_alone();
  s.table = true;
  s.objects[0].motion = {0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0.1, 0, 0, 20, 0};
  s.objects[1] = {.mesh = write("ball.obj", sphere(0.05)), .position_m = {0.25, 0, 0.1}};
  const MeshSceneFromFiles scene = made(s);
  for (const int frame : {0, 4, 15}) {
    std::array<int, 3> seen{};  // box, ball, table
    const PointCloud cloud = scene.cloud(frame);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!cloud.is_measured(i)) continue;
      const Vec3 p = cloud.point(i);
      EXPECT_LT(std::abs(scene.signed_distance(p, scene.captured_s(frame))), 1e-6) << p.transpose();
      const bool is_ball = (p - Vec3(0.25, 0.05, 0.1)).norm() < 0.051;
      ++seen[is_ball ? 1 : std::abs(p.y()) < 1e-9 ? 2 : 0];
    }
    for (const int count : seen) EXPECT_GT(count, 30) << frame;
  }
}

// The image shows all of the object, and it is large or as near as the sensor measures.
TEST_F(ScenesOfFiles, TheCameraFitsObjectsOfAllSizes) {
  for (const DepthSensorKind kind :
       {DepthSensorKind::simple, DepthSensorKind::structured_light, DepthSensorKind::active_stereo})
    for (const double size_m : {0.05, 0.3, 2.0, 5.0}) {
      Settings s = box_alone();
      s.objects[0].size_m = size_m, s.objects[0].position_m = {1, -1, 0.5};
      s.scene.sensor.sensor = kind, s.scene.sensor.max_disparity_px = 15;
      s.scene.sensor.disparity_focal_px = 0;
      const PointCloud cloud = made(s).cloud(0);
      ASSERT_EQ(cloud.size(), 96u * 72u);
      int measured = 0;
      double nearest_m = 1e9;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (!cloud.is_measured(i)) continue;
        ++measured;
        nearest_m = std::min(nearest_m, (cloud.point(i) - cloud.image->X_WC.translation()).norm());
        const std::size_t row = i / 96, column = i % 96;
        EXPECT_TRUE(row > 0 && row < 71 && column > 0 && column < 95) << "the object is cut off";
      }
      EXPECT_TRUE(measured > 500 || (measured > 10 && nearest_m < 0.5)) << size_m << ": " << measured;
    }
}

TEST_F(ScenesOfFiles, ACameraThatIsNotFittedIsWhereItsSettingsSay) {
  Settings s = box_alone();
  s.camera_fit = false;
  s.scene.sensor.camera.camera_position_m = {0.3, 0.6, 0},
  s.scene.sensor.camera.target_position_m = {0, 0, 0};
  const RigidTransform X_WC = made(s).cloud(0).image->X_WC;
  EXPECT_TRUE(X_WC.isApprox(look_at({0.3, 0.6, 0}, {0, 0, 0}), 1e-15));
}

TEST_F(ScenesOfFiles, ACameraFollowsItsPath) {
  Settings s = box_alone();
  s.table = true;
  const RigidTransform down = look_at({0, 1, 0}, {0, 0, 0});
  const Eigen::Quaterniond q(down.linear());
  std::ostringstream path;
  path.precision(17);
  for (const double t : {0.0, 1.0})
    path << t << " " << 0.2 * t << " 1 0 " << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "\n";
  s.camera_path = folder_.write("camera.txt", path.str()).string();
  const MeshSceneFromFiles scene = made(s);
  for (const int frame : {0, 12, 30}) {
    const PointCloud cloud = scene.cloud(frame);
    RigidTransform X_WC = down;
    X_WC.translation().x() = 0.2 * frame / 30;
    EXPECT_TRUE(cloud.image->X_WC.isApprox(X_WC, 1e-12)) << frame;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (cloud.is_measured(i)) {
        EXPECT_LT(std::abs(scene.signed_distance(cloud.point(i), scene.captured_s(frame))), 1e-6);
      }
  }
}

// Object and camera move in the same way on one clock, so that the image stays the same from the moment on
// from which both move.
TEST_F(ScenesOfFiles, PathsWhoseTimesOverlapHaveOneClock) {
  Settings s = box_alone();
  s.objects[0].origin = PlacedMesh::Origin::file, s.objects[0].position_m = -kCentre_m;
  const Eigen::Quaterniond q(look_at({0, 1, 0}, {0, 0, 0}).linear());
  const auto line = [&](double t, double x) {
    std::ostringstream text;
    text.precision(17);
    text << t << " " << x << " 1 0 " << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "\n";
    return text.str();
  };
  s.camera_path = folder_.write("camera.txt", line(100, 0) + line(100.5, 0) + line(101.5, 0.5)).string();
  const std::string moves = " 0 0 0 0 0 1\n";
  s.objects[0].path =
      folder_.write("object.txt", "# t tx ty tz qx qy qz qw\n100.5 0" + moves + "101.5 0.5" + moves).string();
  const MeshSceneFromFiles scene = made(s);
  EXPECT_TRUE(scene.true_meshes(0.5)[0].X_WO->translation().isApprox(-kCentre_m, 1e-12));
  EXPECT_TRUE(scene.true_meshes(1.0)[0].X_WO->translation().isApprox(Vec3(0.25, 0, 0) - kCentre_m, 1e-12));
  EXPECT_TRUE(scene.cloud(30).image->X_WC.translation().isApprox(Vec3(0.25, 1, 0), 1e-12));
  EXPECT_HAS(scene.input(),
             "; object.txt: 2 poses over 1 s at 1 Hz, 0.5 m long, at most 0.5 m/s; camera.txt: 3 poses");
  EXPECT_TRUE(scene.input_notes().empty());
  s.objects[0].path = folder_.write("object.txt", "200.5 0" + moves + "201.5 0.5" + moves).string();
  ASSERT_EQ(kinds_of(made(s).input_notes()), Kinds{"unusual poses"});
  EXPECT_HAS(made(s).input_notes()[0].text, "each file counts from its own first line");
}

TEST_F(ScenesOfFiles, ThatTheirCameraDoesNotShowAreReported) {
  Settings s = box_alone();
  s.objects[0].position_m = {0.2, 0, 0.1};
  const RigidTransform down = look_at({0.1, 1, 0}, {0.2, 0, 0.1});
  const auto notes = [&](const RigidTransform& X, PoseDirection direction, bool real_part_first = false) {
    const Eigen::Quaterniond q(X.linear());
    const Vec3 t = X.translation();
    std::ostringstream path;
    path.precision(17);
    path << "0 " << t.x() << " " << t.y() << " " << t.z() << " ";
    if (real_part_first) path << q.w() << " ";
    path << q.x() << " " << q.y() << " " << q.z();
    if (!real_part_first) path << " " << q.w();
    s.camera_path = folder_.write("camera.txt", path.str() + "\n").string(), s.pose_direction = direction;
    std::string text;
    for (const Note& note : made(s).input_notes()) text += note.kind + ": " + note.text;
    return text;
  };
  EXPECT_EQ(notes(down, PoseDirection::camera_to_world), "");
  EXPECT_EQ(notes(down.inverse(), PoseDirection::world_to_camera), "");
  EXPECT_HAS(notes(down.inverse(), PoseDirection::camera_to_world),
             "not in view: box is at no time in the image");
  EXPECT_HAS(notes(down.inverse(), PoseDirection::camera_to_world),
             "; with the inverse poses of the camera it is");
  const RigidTransform aside = look_at({0.9, 0.6, -0.4}, {0.2, 0.06, 0.1});
  EXPECT_EQ(notes(aside, PoseDirection::camera_to_world), "");
  EXPECT_HAS(notes(aside, PoseDirection::camera_to_world, true),
             "with quaternions with qw first of the camera");
}

TEST_F(ScenesOfFiles, ObjectsHaveTheirColours) {
  Settings s = box_alone();
  s.table = true, s.objects[0].colour = "#C03020";
  const PointCloud cloud = made(s).cloud(0);
  std::set<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i)) {
      EXPECT_EQ(cloud.colour[i], cloud.y[i] > 1e-9 ? 0xC03020 : kNoColour);
      found.insert(cloud.colour[i]);
    }
  EXPECT_EQ(found.size(), 2u);
}

TEST_F(ScenesOfFiles, FramesArePureFunctions) {
  Settings s = box_alone();
  s.table = true, s.scene.sensor.camera.noise_per_m = 0.002;
  const PointCloud third = made(s).cloud(3);
  EXPECT_TRUE(scenes::same_clouds(made(s).cloud(3), third));
  EXPECT_FALSE(scenes::same_clouds(made(s, 2).cloud(3), third));
  EXPECT_FALSE(scenes::same_clouds(made(s).cloud(4), third));
}

// --- settings ---

TEST_F(ScenesOfFiles, TheDefaultsAreASceneWithoutFiles) {
  const Settings s;
  EXPECT_TRUE(input_files(s).empty());
  const MeshSceneFromFiles scene = made(s);
  EXPECT_HAS(scene.input(), "husky: ");
  EXPECT_GT(scene.cloud(0).size(), 0u);
}

TEST_F(ScenesOfFiles, EveryParameterHasANameOfItsOwn) {
  Settings s;
  std::set<std::string> names;
  for (const Parameter& parameter : parameters(s))
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
  for (const char* name : {"mesh", "second_mesh_size_m", "third_mesh_path", "camera_path", "sensor"})
    EXPECT_EQ(names.count(name), 1u) << name;
}

TEST_F(ScenesOfFiles, TheInputIsEveryFile) {
  Settings s = box_alone();
  s.objects[0].path = folder_.write("path.txt", "0 0 0 0 0 0 0 1\n").string();
  s.objects[1] = {.mesh = "bar"};
  s.objects[2] = {.mesh = write("ball.obj", sphere(0.1))};
  s.camera_path = folder_.write("camera.tum", "0 0 1 0 0 0 0 1\n").string();
  EXPECT_EQ(names_of(input_files(s)), "box.obj path.txt ball.obj camera.tum ");
}

TEST_F(ScenesOfFiles, SettingsThatContradictEachOtherAreInvalid) {
  const auto problem = [this](auto change) {
    Settings s = box_alone();
    change(s);
    return validate(s);
  };
  EXPECT_EQ(problem([](Settings&) {}), "");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].mesh = "wolf"; }), "mesh = wolf: expected ball, bar");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].mesh = ""; }), "mesh = \"\": expected an object");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].colour = "red"; }), "mesh_colour = red: expected #");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].colour = "#12345g"; }), "mesh_colour = #12345g");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].sheet = s.objects[0].repair = true; }),
             "mesh_sheet = false");
  EXPECT_HAS(problem([](Settings& s) { s.objects[0].motion = {1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}; }),
             "mesh_motion: row 1: expected a later time");
  EXPECT_HAS(problem([](Settings& s) {
               s.objects[1] = {.mesh = "bar", .motion = {0, 0, 0, 0, 0, 0, 0}, .path = "p.txt"};
             }),
             "second_mesh_motion: expected no motion beside second_mesh_path = p.txt");
  EXPECT_HAS(problem([](Settings& s) {
               s.scene.sensor.camera.camera_position_m = s.scene.sensor.camera.target_position_m;
             }),
             "expected two different positions");
}

}  // namespace
}  // namespace remote_touch::mesh_scene_from_files_test
