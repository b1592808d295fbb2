// Scenes of mesh files: the table, what the camera sees, and settings that contradict each other.
#include "runners/experiment/mesh_files/mesh_scene_from_files.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>

#include "core/geometry/colour.h"
#include "tests/runners/experiment/mesh_files/box_scene.h"
#include "tests/support/note_kinds.h"

namespace remote_touch::mesh_scene_from_files_test {
namespace {

using namespace box_scene;

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
