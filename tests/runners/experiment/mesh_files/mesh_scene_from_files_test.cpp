// Scenes of mesh files: objects that are placed and moved against closed forms, the table, what the camera
// sees, and what is refused.
#include "runners/experiment/mesh_files/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "tests/support/meshes.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::mesh_scene_from_files_test {
namespace {

using Settings = MeshSceneFromFiles::Settings;

// A box in the middle of nowhere. Its coordinates have single precision.
const Vec3 kSides_m(0.25, 0.125, 0.5), kCentre_m(1, 2, -3);

std::string obj_of(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& v : mesh.vertices) text << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const auto& [a, b, c] : mesh.triangles) text << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  return text.str();
}

TriangleMesh sheet() {  // faces +y
  return {{{-0.25, 0, 0.25}, {0.25, 0, 0.25}, {0.25, 0, -0.25}, {-0.25, 0, -0.25}}, {{0, 1, 2}, {0, 2, 3}}};
}

double distance_to_box(const Vec3& p, const Vec3& centre, const Vec3& sides) {
  const Vec3 beyond = (p - centre).cwiseAbs() - 0.5 * sides;
  return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
}

// Positions around the box, inside of it, and at its corners.
std::vector<Vec3> positions_around(const Vec3& centre, const Vec3& sides) {
  std::vector<Vec3> positions;
  for (const double x : {-0.62, -0.3, 0.1, 0.7})
    for (const double y : {-0.6, 0.05, 0.45, 0.9})
      for (const double z : {-0.55, -0.4, 0.2, 0.53})
        positions.push_back(centre + sides.cwiseProduct(Vec3(x, y, z)));
  return positions;
}

RigidTransform turned(const Vec3& rotation_deg, const Vec3& position_m = Vec3::Zero()) {
  return Eigen::Translation3d(position_m) * rotation(kRadiansPerDegree * rotation_deg);
}

std::string names_of(const std::vector<InputPart>& parts) {
  std::string names;
  for (const InputPart& part : parts)
    for (const InputFile& file : files_of(part)) names += file.name + " ";
  return names;
}

class ScenesOfFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const TriangleMesh& mesh) const {
    return folder_.write(name, obj_of(mesh)).string();
  }
  // Writes a line 't tx ty tz qx qy qz qw' for each pose, or with qw first.
  std::string write_path(const std::string& name, const std::vector<StampedPose>& poses,
                         bool real_part_first = false) const {
    std::ostringstream text;
    text.precision(17);
    for (const StampedPose& pose : poses) {
      const Eigen::Quaterniond q(pose.X.linear());
      const Eigen::Vector4d first(q.w(), q.x(), q.y(), q.z()), last = q.coeffs();
      text << pose.time_s << " " << pose.X.translation().transpose() << " "
           << (real_part_first ? first : last).transpose() << "\n";
    }
    return folder_.write(name, text.str()).string();
  }
  // The box without a table and without errors of the sensor, in a small image.
  Settings box_alone() const {
    Settings s;
    s.objects[0] = {.mesh = write("box.obj", box_mesh(kSides_m, kCentre_m))};
    s.table = false;
    DepthCameraSettings& camera = s.scene.sensor.camera;
    camera.width = 96, camera.height = 72, camera.focal_px = 80;
    camera.noise_per_m = 0, camera.quantisation_per_m = 0, camera.hole_px = 0;
    return s;
  }
  static MeshSceneFromFiles made(const Settings& s) {
    EXPECT_EQ(validate(s), "");
    return {s, NoiseKey{1}, scenes::kernels()};
  }
  // Expects that the scene has the box at a pose X_WB of its middle, and nothing else.
  static void expect_box(const MeshSceneFromFiles& scene, double time_s, const RigidTransform& X_WB,
                         const Vec3& sides = kSides_m) {
    for (const Vec3& p_B : positions_around(Vec3::Zero(), sides))
      EXPECT_NEAR(scene.signed_distance(X_WB * p_B, time_s), distance_to_box(p_B, Vec3::Zero(), sides), 1e-9)
          << time_s << " s: " << p_B.transpose();
  }
  std::string refused(const Settings& s) const {
    return refusal([&] { made(s); });
  }
  // Returns the reason for which a mesh is refused as the second object.
  std::string refused(const std::string& name, const TriangleMesh& mesh) const {
    Settings s = box_alone();
    s.objects[1].mesh = write(name, mesh);
    return refused(s);
  }

  TestFolder folder_{"mesh_scene_from_files"};
};

TEST_F(ScenesOfFiles, AnObjectStandsAtItsPosition) {
  Settings s = box_alone();
  s.objects[0].position_m = {0.1, -0.05, 0.2};
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0.1, -0.05 + 0.5 * kSides_m.y(), 0.2)));
  s.objects[0].origin = PlacedMesh::Origin::file;
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0.1, -0.05, 0.2) + kCentre_m));
}

TEST_F(ScenesOfFiles, AVertexWithoutTrianglesIsNotInTheSize) {
  Settings s = box_alone();
  TriangleMesh mesh = box_mesh(kSides_m);
  mesh.vertices.emplace_back(9, 9, 9);
  write("box.obj", mesh);
  s.objects[0].size_m = 0.5;
  expect_box(made(s), 0, turned(Vec3::Zero(), Vec3(0, 0.5 * kSides_m.y(), 0)));
}

TEST_F(ScenesOfFiles, ATurnedObjectStandsOnItsLowestPoint) {
  Settings s = box_alone();
  s.objects[0].rotation_deg = {-90, 0, 0};  // z of the file is up
  expect_box(made(s), 0, turned({-90, 0, 0}, Vec3(0, 0.5 * kSides_m.z(), 0)));
  s.objects[0].rotation_deg = {0, 0, 45};
  const double height = (kSides_m.x() + kSides_m.y()) / std::sqrt(2);
  expect_box(made(s), 0, turned({0, 0, 45}, Vec3(0, 0.5 * height, 0)));
}

TEST_F(ScenesOfFiles, SeveralObjectsCountAsTheirUnion) {
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

TEST_F(ScenesOfFiles, AMotionMovesTheTrueSurfaceAtAllTimes) {
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

TEST_F(ScenesOfFiles, APathIsThatOfItsFile) {
  Settings s = box_alone();
  s.objects[0].path = write_path("path.txt", {{100, turned(Vec3::Zero())},
                                              {100.5, turned(Vec3::Zero(), {0.2, 0, 0})},
                                              {101.5, turned({0, 90, 0}, {0.2, 0.1, 0})}});
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

TEST_F(ScenesOfFiles, AnObjectOnAPathStandsAtItsPositionAtTheStart) {
  Settings s = box_alone();
  s.objects[0].path = folder_.write("path.txt", "0 0.7 0.4 0 0 0 0 1\n2 0.7 0.6 0 0 0 0 1\n").string();
  s.objects[0].position_m = {0, 0.05, 0};
  const MeshSceneFromFiles scene = made(s);
  for (const double time : {0.0, 1.0, 2.0})
    expect_box(scene, time, turned(Vec3::Zero(), Vec3(0, 0.05 + 0.1 * time + 0.5 * kSides_m.y(), 0)));
}

// One row for each refusal: a change of the settings of box_alone(), and what is wrong then.
TEST_F(ScenesOfFiles, RefuseWhatIsNotClear) {
  const TriangleMesh box = box_mesh(kSides_m);
  TriangleMesh open = box;
  open.triangles.pop_back();
  write("open.obj", open);
  write("mm.obj", meshes::moved(box, 1000 * Eigen::Matrix3d::Identity(), Vec3::Zero()));
  for (const char* name : {"no.obj", "no.ply", "no.stl"}) folder_.write(name, "no mesh\n");
  folder_.write("empty.txt", "");
  using Change = std::function<void(Settings&)>;
  const auto second = [&](const std::string& name) -> Change {
    return [file = (folder_ / name).string()](Settings& s) { s.objects[1].mesh = file; };
  };
  const std::pair<Change, std::string> rows[] = {
      {[](Settings& s) { s.objects[1].mesh = "none.obj"; },
       "scenario.second_mesh = none.obj: no such mesh: expected ball, bar"},
      {[](Settings& s) { s.objects[1].mesh = "bar", s.objects[1].path = "none.txt"; }, "none.txt"},
      {[](Settings& s) { s.camera_path = "none.tum"; }, "none.tum"},
      {[&](Settings& s) { s.objects[0].path = (folder_ / "empty.txt").string(); }, "empty.txt: has no pose"},
      {second("open.obj"), "open.obj: not closed: 3 boundary edges"},
      {second("open.obj"), "expected a closed mesh, scenario.second_mesh_repair=true or"},
      {second("mm.obj"), "mm.obj: its bounding box has a diagonal of 572.8"},
      {second("mm.obj"), "may be millimetres; scenario.second_mesh_size_m scales the mesh"},
      {second("no.obj"), "no.obj"},
      {second("no.ply"), "no.ply"},
      {second("no.stl"), "no.stl"},
      {[](Settings& s) { s.objects[0].mesh = "wolf"; }, "mesh = wolf: expected ball, bar"},
      {[](Settings& s) { s.objects[0].mesh = ""; }, "mesh = \"\": expected an object"},
      {[](Settings& s) { s.objects[0].colour = "red"; }, "mesh_colour = red: expected #"},
      {[](Settings& s) { s.objects[0].colour = "#12345g"; }, "mesh_colour = #12345g"},
      {[](Settings& s) { s.objects[0].sheet = s.objects[0].repair = true; }, "mesh_sheet = false"},
      {[](Settings& s) { s.objects[0].motion = std::vector<double>(14); },
       "mesh_motion: row 1: expected a later time"},
      {[](Settings& s) {
         s.objects[1].mesh = "bar", s.objects[1].motion.assign(7, 0), s.objects[1].path = "p.txt";
       },
       "second_mesh_motion: expected no motion beside second_mesh_path = p.txt"},
      {[](Settings& s) {
         DepthCameraSettings& camera = s.scene.sensor.camera;
         camera.camera_position_m = camera.target_position_m;
       },
       "expected two different positions"},
  };
  for (const auto& row : rows) {
    Settings s = box_alone();
    row.first(s);
    const std::string invalid = validate(s);
    EXPECT_HAS(invalid.empty() ? refused(s) : invalid, row.second);
  }
  Settings s = box_alone();
  s.objects[1].mesh = "none.obj";
  EXPECT_THROW(made(s), MissingInput);
}

TEST_F(ScenesOfFiles, RefusesAPartThatIsInsideOutUnlessItIsAHollow) {
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

TEST_F(ScenesOfFiles, ARepairClosesAndTurnsMeshes) {
  TriangleMesh open = box_mesh(kSides_m, kCentre_m);
  open.triangles.pop_back();
  const RigidTransform standing = turned(Vec3::Zero(), Vec3(0, 0.5 * kSides_m.y(), 0));
  for (const TriangleMesh& mesh : {open, meshes::inside_out(box_mesh(kSides_m, kCentre_m))}) {
    Settings s = box_alone();
    s.objects[0].mesh = write("broken.obj", mesh), s.objects[0].repair = true;
    expect_box(made(s), 0, standing);
  }
}

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

// The camera is where its settings say if it is not fitted.
TEST_F(ScenesOfFiles, PointsLieOnTheTrueSurfaceInTheirColours) {
  Settings s = box_alone();
  s.table = true, s.objects[0].colour = "#C03020", s.camera_fit = false;
  s.objects[0].motion = {0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0.1, 0, 0, 20, 0};
  s.scene.sensor.camera.camera_position_m = {0.3, 0.6, 0},
  s.scene.sensor.camera.target_position_m = {0, 0, 0};
  const MeshSceneFromFiles scene = made(s);
  for (const int frame : {0, 4, 15}) {
    const PointCloud cloud = scene.cloud(frame);
    EXPECT_TRUE(cloud.image->X_WC.isApprox(look_at({0.3, 0.6, 0}, {0, 0, 0}), 1e-15));
    int on_box = 0, on_table = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!cloud.is_measured(i)) continue;
      EXPECT_LT(std::abs(scene.signed_distance(cloud.point(i), scene.captured_s(frame))), 1e-6);
      EXPECT_EQ(cloud.colour[i], cloud.y[i] > 1e-9 ? 0xC03020 : kNoColour);
      ++(cloud.y[i] > 1e-9 ? on_box : on_table);
    }
    EXPECT_GT(std::min(on_box, on_table), 30) << frame;
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

// Object and camera move in the same way on one clock, so that the image stays the same from the moment on
// from which both move.
TEST_F(ScenesOfFiles, PathsWhoseTimesOverlapHaveOneClock) {
  Settings s = box_alone();
  s.objects[0].origin = PlacedMesh::Origin::file, s.objects[0].position_m = -kCentre_m;
  const auto object = [&](double first_s) {
    return write_path("object.txt",
                      {{first_s, turned(Vec3::Zero())}, {first_s + 1, turned(Vec3::Zero(), {0.5, 0, 0})}});
  };
  const RigidTransform before = look_at({0, 1, 0}, {0, 0, 0}), after = look_at({0.5, 1, 0}, {0.5, 0, 0});
  s.camera_path = write_path("camera.txt", {{100, before}, {100.5, before}, {101.5, after}});
  s.objects[0].path = object(100.5);
  const MeshSceneFromFiles scene = made(s);
  EXPECT_TRUE(scene.true_meshes(0.5)[0].X_WO->translation().isApprox(-kCentre_m, 1e-12));
  EXPECT_TRUE(scene.true_meshes(1.0)[0].X_WO->translation().isApprox(Vec3(0.25, 0, 0) - kCentre_m, 1e-12));
  EXPECT_TRUE(scene.cloud(30).image->X_WC.translation().isApprox(Vec3(0.25, 1, 0), 1e-12));
  EXPECT_HAS(scene.input(),
             "; object.txt: 2 poses over 1 s at 1 Hz, 0.5 m long, at most 0.5 m/s; camera.txt: 3 poses");
  EXPECT_TRUE(scene.input_notes().empty());
  s.objects[0].path = object(200.5);
  ASSERT_EQ(kinds_of(made(s).input_notes()), Kinds{"unusual poses"});
  EXPECT_HAS(made(s).input_notes()[0].text, "each file counts from its own first line");
}

TEST_F(ScenesOfFiles, ThatTheirCameraDoesNotShowAreReported) {
  Settings s = box_alone();
  s.objects[0].position_m = {0.2, 0, 0.1};
  const RigidTransform down = look_at({0.1, 1, 0}, {0.2, 0, 0.1});
  const auto notes = [&](const RigidTransform& X, PoseDirection direction, bool real_part_first = false) {
    s.camera_path = write_path("camera.txt", {{0, X}}, real_part_first), s.pose_direction = direction;
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

TEST_F(ScenesOfFiles, TheInputIsEveryFile) {
  EXPECT_TRUE(input_files(Settings{}).empty());
  Settings s = box_alone();
  s.objects[0].path = folder_.write("path.txt", "0 0 0 0 0 0 0 1\n").string();
  s.objects[1] = {.mesh = "bar"};
  s.objects[2] = {.mesh = write("ball.obj", box_mesh(kSides_m))};
  s.camera_path = folder_.write("camera.tum", "0 0 1 0 0 0 0 1\n").string();
  EXPECT_EQ(names_of(input_files(s)), "box.obj path.txt ball.obj camera.tum ");
}

}  // namespace
}  // namespace remote_touch::mesh_scene_from_files_test
