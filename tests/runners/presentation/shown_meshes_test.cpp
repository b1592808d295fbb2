// The true meshes that a page shows: on a grid, at their poses, and hidden where these are unknown.
#include "runners/presentation/result_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/points/vector.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "scenarios/objects/mesh_scene.h"
#include "tests/core/mesh/mesh_shapes.h"
#include "tests/support/meshes.h"
#include "tests/support/recorded_data.h"
#include "tests/support/scenes.h"

namespace remote_touch::shown_meshes_test {
namespace {

RigidTransform pose(const Vec3& position_m, const Vec3& turn) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation(turn).toRotationMatrix();
  X.translation() = position_m;
  return X;
}
// A ball with a radius of 0.1 m and about so many triangles.
TriangleMesh ball_of(int triangles) {
  const int rings = static_cast<int>(std::sqrt(triangles / 4.0));
  return meshes::moved(mesh_shapes::rough_ball(rings, 2 * rings, 0), 0.1 * Eigen::Matrix3d::Identity(),
                       Vec3::Zero());
}
PosedMesh posed(const TriangleMesh& mesh) {
  return {"part", mesh.vertices, mesh.triangles, RigidTransform::Identity()};
}
std::vector<double> ticks(double to_s) {
  std::vector<double> list;
  for (int i = 0; 0.001 * i <= to_s + 1e-9; ++i) list.push_back(0.001 * i);
  return list;
}

// The position of a vertex that the page draws, in the frame of the object.
Vec3 drawn_vertex(const MeshOnGrid& mesh, std::size_t i) {
  return mesh.low_O +
         mesh.step_m * Vec3(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]);
}

// The pose that the page draws at a time; nothing: the mesh is hidden.
std::optional<RigidTransform> drawn_pose(const ShownMesh& mesh, double time_s) {
  std::size_t i = 0;
  while (i + 1 < mesh.time_s.size() && mesh.time_s[i + 1] <= time_s) ++i;
  const auto& [x, y, z, qw, qx, qy, qz] = mesh.poses[i];
  if (std::isnan(x)) return {};
  return Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz);
}

double volume(const MeshOnGrid& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vec3 a = drawn_vertex(mesh, mesh.triangles[t]), b = drawn_vertex(mesh, mesh.triangles[t + 1]);
    sum += a.dot(b.cross(drawn_vertex(mesh, mesh.triangles[t + 2]))) / 6;
  }
  return sum;
}

TEST(MeshOnGrid, HasTheTrianglesOfTheMeshWithinHalfAStep) {
  const TriangleMesh ball = ball_of(3000);
  const MeshOnGrid grid = mesh_on_grid(posed(ball), ball.triangles.size());
  EXPECT_NEAR(grid.step_m, 0.2 / 65535, 1e-9);
  ASSERT_EQ(grid.triangles.size(), 3 * ball.triangles.size());
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = ball.vertices[static_cast<std::size_t>(ball.triangles[t][k])];
      const Vec3 error = drawn_vertex(grid, grid.triangles[3 * t + k]) - corner;
      ASSERT_LE(error.cwiseAbs().maxCoeff(), 0.5001 * grid.step_m) << t;
    }
}

TEST(MeshOnGrid, IsCoarserIfThereAreTooManyTriangles) {
  const TriangleMesh ball = ball_of(20000);
  ASSERT_GT(ball.triangles.size(), 10000u);
  const MeshOnGrid grid = mesh_on_grid(posed(ball), 3000);
  EXPECT_LE(grid.triangles.size(), 3 * 3000u);
  EXPECT_GE(grid.triangles.size(), 3 * 300u) << "it is not coarser than necessary";
  for (std::size_t t = 0; t < grid.triangles.size(); t += 3) {
    const auto a = grid.triangles[t], b = grid.triangles[t + 1], c = grid.triangles[t + 2];
    EXPECT_TRUE(a != b && b != c && c != a);
  }
  for (std::size_t i = 0; i < grid.vertices.size() / 3; ++i)
    ASSERT_NEAR(drawn_vertex(grid, i).norm(), 0.1, grid.step_m);
  EXPECT_NEAR(volume(grid), 4.0 / 3 * 3.14159265 * 0.001, 0.0003)
      << "it is closed, and its outside is outside";
}

// A box that rises and turns beside one at rest.
MeshScene two_boxes() {
  const auto shape = std::make_shared<const MeshDistance>(box_mesh({0.12, 0.05, 0.08}, {0, 0.025, 0}));
  const PosePath rise(std::vector<StampedPose>{{0.1, pose({0, 0, 0}, {0, 0, 0})},
                                               {0.4, pose({0.01, 0.03, 0}, {0.3, 0.25, 0})}});
  return MeshScene({},
                   {{{"moving", shape}, rise}, {{"resting", shape}, PosePath(pose({0.5, 0, 0}, {0, 1, 0}))}},
                   {}, NoiseKey{}, scenes::kernels());
}

// Every drawn vertex lies on the surface from which the column signed_distance measures.
void expect_vertices_on_the_surface(const Scenario& scene, const ShownMesh& mesh, double time_s) {
  const auto X_WO = drawn_pose(mesh, time_s);
  ASSERT_TRUE(X_WO) << mesh.name;
  const std::size_t count = mesh.mesh.vertices.size() / 3, every = count / 50 + 1;
  for (std::size_t i = 0; i < count; i += every) {
    const Vec3 p_W = *X_WO * drawn_vertex(mesh.mesh, i);
    ASSERT_NEAR(scene.signed_distance(p_W, time_s), 0, 2 * mesh.mesh.step_m + 1e-6) << mesh.name << time_s;
  }
}

TEST(ShownMeshes, AreThoseFromWhichTheColumnMeasures) {
  const MeshScene scene = two_boxes();
  const std::vector<double> times = ticks(0.5);
  const std::vector<ShownMesh> meshes = shown_meshes(scene, times);
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "moving");
  EXPECT_EQ(meshes[1].name, "resting");
  EXPECT_EQ(meshes[1].poses.size(), 1u);
  EXPECT_GE(meshes[0].poses.size(), 299u) << "a pose for each tick at which it moves";
  EXPECT_LE(meshes[0].poses.size(), 302u);
  for (const double t : times)
    for (const ShownMesh& mesh : meshes)
      ASSERT_NO_FATAL_FAILURE(expect_vertices_on_the_surface(scene, mesh, t));
}

// A scene whose meshes move in every tick, or only the first of them. All are unknown from 1 s to 2 s.
class Moving final : public Scenario {
 public:
  explicit Moving(std::size_t meshes, bool only_first = false) : meshes_(meshes), only_first_(only_first) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3&, double) const override { return 0; }
  std::vector<PosedMesh> true_meshes(double time_s) const override {
    std::vector<PosedMesh> all(meshes_, posed(box_));
    for (std::size_t i = 0; i < meshes_; ++i)
      if (time_s >= 1 && time_s < 2)
        all[i].X_WO.reset();
      else if (i == 0 || !only_first_)
        all[i].X_WO = pose({0.1 * time_s, 0, 0}, Vec3::Zero());
    return all;
  }

 private:
  const std::size_t meshes_;
  const bool only_first_;
  const TriangleMesh box_ = box_mesh({0.1, 0.1, 0.1}, {0, 0, 0});
};

TEST(ShownMeshes, AreHiddenWhileTheirPoseIsUnknown) {
  const std::vector<ShownMesh> meshes = shown_meshes(Moving(1), ticks(3));
  EXPECT_TRUE(drawn_pose(meshes[0], 0.999));
  EXPECT_FALSE(drawn_pose(meshes[0], 1.0));
  EXPECT_FALSE(drawn_pose(meshes[0], 1.9995));
  EXPECT_TRUE(drawn_pose(meshes[0], 2.0));
  EXPECT_EQ(meshes[0].poses.size(), 1000u + 1 + 1001);
}

TEST(ShownMeshes, OfALongRunHaveNotEveryPoseIfTheyMoveAllTheTime) {
  const std::vector<ShownMesh> meshes = shown_meshes(Moving(3), ticks(12));
  for (const ShownMesh& mesh : meshes) {
    EXPECT_EQ(mesh.time_s.size(), mesh.poses.size());
    EXPECT_LE(mesh.poses.size(), kMaxShownPoses / 3);
    EXPECT_GT(mesh.poses.size(), kMaxShownPoses / 6);
    EXPECT_EQ(mesh.time_s.front(), 0);
    EXPECT_NEAR(drawn_pose(mesh, 11)->translation().x(), 1.1, 0.0003);
  }
}

TEST(ShownMeshes, KeepTheirFewPosesBesideOneWithMany) {
  const std::vector<ShownMesh> meshes = shown_meshes(Moving(2, true), ticks(25));
  EXPECT_LE(meshes[0].poses.size(), kMaxShownPoses);
  EXPECT_EQ(meshes[1].poses.size(), 3u);
  EXPECT_FALSE(drawn_pose(meshes[1], 1.5));
}

// A live run may last longer than the motion of the scene.
TEST(ShownMeshes, OfALiveRunMoveUntilTheSceneRests) {
  const MeshScene scene = two_boxes();
  const std::vector<ShownMesh> meshes = shown_meshes_of_live(scene, 1000);
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_GE(meshes[0].poses.size(), 299u);
  EXPECT_LE(meshes[0].poses.size(), 302u);
  EXPECT_EQ(meshes[1].poses.size(), 1u);
  for (const double t : {0.0, 0.2 + 1e-9, 0.35 + 1e-9, 0.4, 1.0, 1e4})
    for (const ShownMesh& mesh : meshes)
      ASSERT_NO_FATAL_FAILURE(expect_vertices_on_the_surface(scene, mesh, t));
}

TEST(ShownMeshes, OfALongMotionOfALiveRunEndAtItsLastPose) {
  const PosePath slow(
      std::vector<StampedPose>{{0, pose({0, 0, 0}, {0, 0, 0})}, {500, pose({0.5, 0, 0}, {0, 0, 0})}});
  const auto shape = std::make_shared<const MeshDistance>(box_mesh({0.1, 0.1, 0.1}, {0, 0, 0}));
  const MeshScene scene({}, {{{"slow", shape}, slow}}, {}, NoiseKey{}, scenes::kernels());
  const std::vector<ShownMesh> meshes = shown_meshes_of_live(scene, 1000);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_LE(meshes[0].poses.size(), 2001u);
  EXPECT_NEAR(drawn_pose(meshes[0], 600)->translation().x(), 0.5, 1e-6);
  EXPECT_NEAR(drawn_pose(meshes[0], 250)->translation().x(), 0.25, 0.0003);
}

TEST(ShownMeshes, AreNoneIfTheSurfaceIsNotOneOfMeshes) {
  EXPECT_TRUE(shown_meshes(Moving(0), ticks(1)).empty());
  EXPECT_TRUE(shown_meshes_of_live(Moving(0), 1000).empty());
}

TEST(ShownMeshes, ANoteSaysWhichAreCoarse) {
  const auto ball = std::make_shared<const MeshDistance>(ball_of(250000));
  const auto box = std::make_shared<const MeshDistance>(box_mesh({0.1, 0.1, 0.1}, {0, 0, 0}));
  ASSERT_GT(ball->triangles().size(), kMaxShownTriangles);
  const MeshScene scene({}, {{{"ball", ball}}, {{"box", box}}}, {}, NoiseKey{}, scenes::kernels());
  const std::vector<ShownMesh> meshes = shown_meshes(scene, ticks(0));
  EXPECT_LE(meshes[0].mesh.triangles.size() + meshes[1].mesh.triangles.size(), 3 * kMaxShownTriangles);
  const std::string note = note_on(meshes);
  EXPECT_NE(note.find("The mesh of ball is drawn with vertices on a grid of "), std::string::npos) << note;
  EXPECT_EQ(note.find("box"), std::string::npos) << note;
  EXPECT_EQ(note_on({meshes[1]}), "");
}

// The cube of the recording, with a camera that is registered to another frame.
TEST(RecordedData, TrueMeshesAreAtTheirPosesInEveryFrame) {
  const std::filesystem::path recording = data_root() / "rgbd/visp_cube_dragon";
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << "recorded data are missing: " << recording;
  RecordingWithTruth::Settings settings;
  settings.path = recording;
  settings.last_frame = 9;
  settings.camera_position_m = {0.1, 0.2, -0.3};
  settings.camera_rotation_deg = {170, 10, 0};
  const RecordingWithTruth scene(settings, NoiseKey{}, scenes::kernels());
  const std::vector<double> times = ticks(0.4);
  const std::vector<ShownMesh> meshes = shown_meshes(scene, times);
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_TRUE(shown_meshes_of_live(scene, 1000).empty()) << "a recording may be repeated";
  for (const ShownMesh& mesh : meshes) {
    EXPECT_GE(mesh.poses.size(), 5u) << "one for each frame in which it moves";
    EXPECT_LE(mesh.poses.size(), 10u);
  }
  const auto cube =
      std::find_if(meshes.begin(), meshes.end(), [](const ShownMesh& m) { return m.name == "cube"; });
  ASSERT_NE(cube, meshes.end());
  for (std::size_t i = 0; i < times.size(); i += 7)
    ASSERT_NO_FATAL_FAILURE(expect_vertices_on_the_surface(scene, *cube, times[i]));
}

}  // namespace
}  // namespace remote_touch::shown_meshes_test
