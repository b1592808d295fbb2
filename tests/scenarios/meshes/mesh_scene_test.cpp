// Scenes of meshes: what the cameras see lies on the true surface, objects and camera move along their paths,
// and frames are pure functions.
#include "scenarios/meshes/mesh_scene.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/colour.h"
#include "core/geometry/rotation.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace remote_touch::mesh_scene_test {
namespace {

constexpr double kTopHeight_m = 0.05, kSpeed_m_per_s = 0.1;

RigidTransform at(const Vec3& position, const Vec3& turn = Vec3::Zero()) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation(turn).toRotationMatrix();
  X.translation() = position;
  return X;
}
SceneMesh object(const TriangleMesh& mesh, PosePath path, bool is_closed = true,
                 std::optional<std::uint32_t> colour = {}) {
  return {{"object", std::make_shared<const MeshDistance>(mesh), is_closed}, std::move(path), colour};
}
// A plate of 1 m x 1 m at height 0, seen from above.
SceneMesh table(std::optional<std::uint32_t> colour = {}) {
  const TriangleMesh plate = {{{-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}, {-0.5, 0, -0.5}},
                              {{0, 1, 2}, {0, 2, 3}}};
  return object(plate, PosePath(RigidTransform::Identity()), false, colour);
}
TriangleMesh box() {  // its top is at kTopHeight_m
  return box_mesh({0.12, kTopHeight_m, 0.08}, {0, 0.5 * kTopHeight_m, 0});
}
// Half a second at kSpeed_m_per_s, upwards, and a quarter of a radian about y.
PosePath rise() {
  return PosePath(
      std::vector<StampedPose>{{0, at({0, 0, 0})}, {0.5, at({0, 0.5 * kSpeed_m_per_s, 0}, {0, 0.25, 0})}});
}

MeshScene::Settings small() {
  MeshScene::Settings s;
  s.sensor.camera.width = 96, s.sensor.camera.height = 72, s.sensor.camera.focal_px = 80;
  return s;
}
MeshScene::Settings ideal() {
  MeshScene::Settings s = small();
  s.sensor.camera.noise_per_m = 0, s.sensor.camera.quantisation_per_m = 0, s.sensor.camera.hole_px = 0;
  return s;
}
MeshScene made(const MeshScene::Settings& s, std::vector<SceneMesh> meshes,
               std::optional<PosePath> camera = {}, std::uint64_t seed = 1) {
  return MeshScene(s, std::move(meshes), std::move(camera), NoiseKey{seed}, scenes::kernels());
}

// Every measured point of the frames is on the true surface. Returns the number of points.
int expect_points_on_surface(const MeshScene& scene, const std::vector<int>& frames) {
  int measured = 0;
  for (const int frame : frames) {
    const PointCloud cloud = scene.cloud(frame);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!cloud.is_measured(i)) continue;
      EXPECT_LT(std::abs(scene.signed_distance(cloud.point(i), scene.captured_s(frame))), 1e-6)
          << frame << ": " << cloud.point(i).transpose();
      ++measured;
    }
  }
  return measured;
}

TEST(MeshScene, PointsOfANoiselessViewLieOnTheTrueSurface) {
  MeshScene::Settings near = ideal();
  near.sensor.camera.camera_position_m = {0.1, 0.15, 0.05};
  near.sensor.camera.target_position_m = {0.03, 0.03, 0.03};
  const MeshScene body = made(near, {object(meshes::any_body(), PosePath(at({0.02, 0.05, 0}, {0.3, 0, 1})))});
  EXPECT_GT(expect_points_on_surface(body, {0}), 20);
  EXPECT_GT(expect_points_on_surface(made(ideal(), {object(box(), rise()), table()}), {0, 7, 15, 40}), 5000);
}

TEST(MeshScene, TheTruthMovesAlsoBetweenFrames) {
  const MeshScene scene = made(ideal(), {object(box(), rise()), table()});
  for (const double time : {0.0, 0.0123, 0.25, 0.4999, 0.5, 3.0}) {
    const double top = kTopHeight_m + kSpeed_m_per_s * std::min(time, 0.5);
    EXPECT_NEAR(scene.signed_distance({0.01, top + 0.02, 0.01}, time), 0.02, 1e-12) << time;
    EXPECT_NEAR(scene.signed_distance({0.01, top - 0.004, 0.01}, time), -0.004, 1e-12) << time;
    EXPECT_NEAR(scene.signed_distance({0.4, 0.03, 0.4}, time), 0.03, 1e-12) << "the table rests";
  }
  EXPECT_NEAR(scene.signed_distance({0.8, 0.03, 0}, 0), 0.74, 1e-12) << "the box; the table ends before";
  EXPECT_TRUE(std::isnan(made(ideal(), {table()}).signed_distance({0.8, 0.03, 0}, 0)));
  EXPECT_TRUE(std::isnan(scene.signed_distance({0, 1.2, 0}, 0))) << "farther than 1 m";
}

TEST(MeshScene, TheTrueNormalIsThatOfTheNearestFace) {
  const MeshScene scene = made(ideal(), {object(box(), rise()), table()});
  EXPECT_LT((scene.true_normal({0.01, kTopHeight_m + 0.01, 0}, 0) - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((scene.true_normal({0.4, 0.01, 0.1}, 0) - Vec3::UnitY()).norm(), 1e-9);
  const Vec3 turned = rotation(Vec3(0, 0.125, 0)) * Vec3::UnitX();  // half of the way
  const Vec3 beside = Vec3(0, 0.5 * kTopHeight_m + 0.025, 0) + 0.065 * turned;
  EXPECT_LT((scene.true_normal(beside, 0.25) - turned).norm(), 1e-9);
  // Equally far from the box and from the table.
  EXPECT_FALSE(scene.true_normal({0.06 + 0.01, 0.01, 0}, 0).allFinite());
}

// Hand and renderer use the same frame.
TEST(MeshScene, AFrameIsMadeOnceAndKeepsItsPoints) {
  const MeshScene scene = made(small(), {object(box(), rise()), table(0x102030)});
  const std::shared_ptr<const NeighbourSearch> points = scene.points(3);
  const PointCloud cloud = scene.cloud(3);
  EXPECT_EQ(scene.points(3), points);
  scene.cloud(2), scene.cloud(4), scene.cloud(5);
  EXPECT_EQ(scene.points(3), points) << "frames that are in transit";
  const PointCloud& kept = dynamic_cast<const CloudSearch&>(*points).cloud();
  const MeshScene other = made(small(), {object(box(), rise()), table(0x102030)});
  EXPECT_TRUE(scenes::same_clouds(kept, cloud));
  EXPECT_TRUE(scenes::same_clouds(other.cloud(3), cloud));
  EXPECT_FALSE(scenes::same_clouds(scene.cloud(2), cloud));
}

TEST(MeshScene, FramesEndWithTheMotion) {
  constexpr int kForEver = std::numeric_limits<int>::max();
  EXPECT_EQ(made(ideal(), {table()}).frame_count(), 1);
  EXPECT_TRUE(made(ideal(), {table()}).phases().empty());
  EXPECT_EQ(made(small(), {table()}).frame_count(), kForEver) << "noise";
  const MeshScene scene = made(ideal(), {object(box(), rise()), table()});
  EXPECT_EQ(scene.frame_count(), 16);
  ASSERT_EQ(scene.phases().size(), 1u);
  EXPECT_EQ(scene.phases()[0].ends_s, 0.5);
  EXPECT_TRUE(scenes::same_clouds(scene.cloud(15), scene.cloud(99)));
  EXPECT_FALSE(scenes::same_clouds(scene.cloud(14), scene.cloud(15)));
  MeshScene::Settings shorter = ideal();
  shorter.duration_s = 0.2;
  const MeshScene stops = made(shorter, {object(box(), rise()), table()});
  EXPECT_EQ(stops.frame_count(), 7);
  EXPECT_TRUE(scenes::same_clouds(stops.cloud(6), scene.cloud(6)));
  EXPECT_TRUE(scenes::same_clouds(stops.cloud(15), stops.cloud(6)));
  EXPECT_NEAR(stops.signed_distance({0, 0.1, 0}, 0.5), 0.1 - kTopHeight_m - 0.2 * kSpeed_m_per_s, 1e-12);
}

TEST(MeshScene, ColoursAreThoseOfTheObjects) {
  EXPECT_TRUE(made(ideal(), {table()}).cloud(0).colour.empty());
  const MeshScene scene =
      made(ideal(), {object(box(), PosePath(RigidTransform::Identity()), true, 0xC03020), table()});
  const PointCloud cloud = scene.cloud(0);
  ASSERT_EQ(cloud.colour.size(), cloud.size());
  std::set<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    found.insert(cloud.colour[i]);
    if (!cloud.is_measured(i)) {
      EXPECT_EQ(cloud.colour[i], 0u);
    } else {
      EXPECT_EQ(cloud.colour[i], cloud.y[i] > 1e-9 ? 0xC03020 : kNoColour);
    }
  }
  EXPECT_EQ(found, (std::set<std::uint32_t>{0, 0xC03020, kNoColour}));
}

TEST(MeshScene, ACameraThatMovesSeesTheSameSurface) {
  const RigidTransform from = look_at({0, 0.5, 0.35}, {0, 0.03, 0}), to = look_at({0.2, 0.4, 0.1}, {0, 0, 0});
  const PosePath path(std::vector<StampedPose>{{0, from}, {0.3, to}});
  const MeshScene scene = made(ideal(), {object(box(), PosePath(at({0, 0, 0}))), table()}, path);
  EXPECT_EQ(scene.frame_count(), 10);
  EXPECT_GT(expect_points_on_surface(scene, {0, 4, 9}), 5000);
  for (const int frame : {0, 4, 9, 12}) {
    const RigidTransform X_WC = path.at(frame / 30.0);
    EXPECT_TRUE(scene.cloud(frame).image->X_WC.isApprox(X_WC, 1e-15)) << frame;
  }
}

TEST(MeshScene, TheMiddleOfTheImageIsWhereTheCameraLooks) {
  MeshScene::Settings s = ideal();
  s.sensor.camera.width = 97, s.sensor.camera.height = 73;
  s.sensor.camera.target_position_m = {0.02, kTopHeight_m, 0.01};
  const PointCloud cloud = made(s, {object(box(), PosePath(at({0, 0, 0}))), table()}).cloud(0);
  EXPECT_LT((cloud.point(36 * 97 + 48) - s.sensor.camera.target_position_m).norm(), 1e-12);
}

TEST(MeshScene, MeasuredPointsAreNearTheSurface) {
  for (const DepthSensorKind kind : {DepthSensorKind::structured_light, DepthSensorKind::active_stereo}) {
    MeshScene::Settings s;
    s.sensor.camera.width = 240, s.sensor.camera.height = 180, s.sensor.camera.focal_px = 250;
    s.sensor.sensor = kind;
    const MeshScene scene = made(s, {object(box(), rise()), table()});
    EXPECT_EQ(scene.frame_count(), std::numeric_limits<int>::max());
    double squares = 0;
    int measured = 0, lost = 0;
    for (const int frame : {0, 30}) {
      const PointCloud cloud = scene.cloud(frame);
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double distance = scene.signed_distance(cloud.point(i), scene.captured_s(frame));
        if (!cloud.is_measured(i)) ++lost;
        if (std::isnan(distance)) continue;
        squares += distance * distance, ++measured;
      }
    }
    EXPECT_GT(measured, 50000);
    EXPECT_GT(lost, 200);
    // The noise of the disparity is 0.3 to 8 mm of depth between 0.5 and 1.1 m.
    EXPECT_LT(std::sqrt(squares / measured), 0.008);
    EXPECT_GT(std::sqrt(squares / measured), 0.0003);
  }
}

TEST(MeshScene, FramesArePureFunctions) {
  for (const DepthSensorKind kind : {DepthSensorKind::simple, DepthSensorKind::active_stereo}) {
    MeshScene::Settings s = small();
    s.sensor.sensor = kind;
    const auto fresh = [&](std::uint64_t seed) {
      return made(s, {object(box(), rise(), true, 0x10A020), table()}, {}, seed);
    };
    const MeshScene scene = fresh(1);
    const PointCloud seventh = scene.cloud(7), third = scene.cloud(3);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(threads == 1 ? 3 : 1);
    const MeshScene again = fresh(1);
    EXPECT_TRUE(scenes::same_clouds(again.cloud(3), third));
    EXPECT_TRUE(scenes::same_clouds(again.cloud(7), seventh));
    omp_set_num_threads(threads);
    EXPECT_FALSE(scenes::same_clouds(scene.cloud(8), seventh));
    EXPECT_FALSE(scenes::same_clouds(fresh(2).cloud(7), seventh));
  }
}

}  // namespace
}  // namespace remote_touch::mesh_scene_test
