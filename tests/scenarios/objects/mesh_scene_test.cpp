// Scenes of meshes, whose points lie on the true surface; and the depth image of meshes against a plain ray
// cast over all triangles.
#include "scenarios/objects/mesh_scene.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "tests/support/depth_scenes.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace remote_touch::mesh_scene_test {
namespace {

constexpr double kTopHeight_m = 0.05, kSpeed_m_per_s = 0.1;

RigidTransform at(const Vec3& position, const Vec3& turn = Vec3::Zero()) {
  return Eigen::Translation3d(position) * rotation(turn);
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
               std::optional<PosePath> camera = {}) {
  return MeshScene(s, std::move(meshes), std::move(camera), NoiseKey{1}, scenes::kernels());
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
  const PointCloud& kept = *points->stored_cloud();
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

CameraIntrinsics small_camera() {
  return {90, 70, 80, 82, 44.3, 34.9};
}

RasterMesh before(const TriangleMesh& mesh, const RigidTransform& X_CO, bool is_closed) {
  return {mesh.vertices, mesh.triangles, X_CO, is_closed};
}

struct Hit {
  double depth = std::numeric_limits<double>::infinity();
  int mesh = -1, triangle = -1;
};

// The ray cast of T. Moeller and B. Trumbore (1997) over all triangles. Its depth is the ray's parameter,
// because the ray has z = 1.
Hit cast(const std::vector<RasterMesh>& meshes, const Vec3& ray_C) {
  Hit hit;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t t = 0; t < meshes[m].triangles.size(); ++t) {
      const auto& [i, j, k] = meshes[m].triangles[t];
      const Vec3 a = meshes[m].X_CO * meshes[m].vertices_O[i];
      const Vec3 ab = meshes[m].X_CO * meshes[m].vertices_O[j] - a;
      const Vec3 ac = meshes[m].X_CO * meshes[m].vertices_O[k] - a;
      const double determinant = ab.dot(ray_C.cross(ac));  // positive if the ray meets the outside
      if (determinant == 0 || (meshes[m].is_closed && determinant < 0)) continue;
      const Vec3 q = Vec3(-a).cross(ab);
      const double u = (-a).dot(ray_C.cross(ac)) / determinant, v = ray_C.dot(q) / determinant;
      const double depth = ac.dot(q) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || depth <= 0 || depth >= hit.depth) continue;
      hit = {depth, static_cast<int>(m), static_cast<int>(t)};
    }
  return hit;
}

// Compares every pixel. Returns the number of pixels that see a mesh.
int expect_that_of_ray_casting(const CameraIntrinsics& camera, const std::vector<RasterMesh>& meshes) {
  const RasterImage image = depth_raster(camera, meshes);
  int seen = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      const Hit hit = cast(meshes, scenes::ray(camera, u, v));
      EXPECT_EQ(std::isnan(image.depth.z_m[i]), hit.mesh < 0) << u << " " << v;
      EXPECT_EQ(image.mesh[i], hit.mesh) << u << " " << v;
      EXPECT_EQ(image.triangle[i], hit.triangle) << u << " " << v;
      if (hit.mesh < 0) continue;
      EXPECT_NEAR(image.depth.z_m[i], hit.depth, 1e-9) << u << " " << v;
      ++seen;
    }
  return seen;
}

// Triangles without order in a cube around a middle.
TriangleMesh triangle_soup(int count, double half_width, const Vec3& middle, unsigned seed) {
  const PointCloud corners = scenes::random_cloud(3 * count, half_width, seed);
  TriangleMesh soup;
  for (int t = 0; t < count; ++t) {
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    for (int k = 0; k < 3; ++k)
      soup.vertices.push_back(middle + corners.point(static_cast<std::size_t>(3 * t + k)));
  }
  return soup;
}

// A ball of rings, with its poles on its axis y; counter-clockwise seen from outside.
TriangleMesh ring_ball(double radius, int rings, int columns) {
  TriangleMesh ball;
  for (int ring = 0; ring <= rings; ++ring)
    for (int column = 0; column < columns; ++column) {
      const auto [s, c] = sin_cos(3.14159265358979 * ring / rings);
      const auto [t, d] = sin_cos(2 * 3.14159265358979 * column / columns);
      ball.vertices.push_back(radius * Vec3(s * d, c, s * t));
    }
  const auto vertex = [columns](int ring, int column) { return ring * columns + column % columns; };
  for (int ring = 0; ring < rings; ++ring)
    for (int column = 0; column < columns; ++column) {
      const int a = vertex(ring, column), b = vertex(ring, column + 1), c = vertex(ring + 1, column),
                d = vertex(ring + 1, column + 1);
      if (ring > 0) ball.triangles.push_back({a, b, d});
      if (ring + 1 < rings) ball.triangles.push_back({a, d, c});
    }
  for (int column = 0; column < columns; ++column)  // one vertex for each pole, up to rounding
    ball.vertices[vertex(0, column)] = {0, radius, 0}, ball.vertices[vertex(rings, column)] = {0, -radius, 0};
  return ball;
}

// The part of a triangle behind the camera is not drawn.
TEST(DepthRaster, IsThatOfRayCastingOverTrianglesWithoutOrder) {
  for (const unsigned seed : {1u, 2u}) {
    const TriangleMesh soup = triangle_soup(60, 0.7, {0, 0, 1.5}, seed);
    const int open = expect_that_of_ray_casting(small_camera(), {before(soup, at(Vec3::Zero()), false)});
    const int closed = expect_that_of_ray_casting(small_camera(), {before(soup, at(Vec3::Zero()), true)});
    EXPECT_GT(open, closed);
    EXPECT_GT(closed, 1000);
    const TriangleMesh around = triangle_soup(8, 2, {0.3, 0.2, 0}, 10 + seed);
    EXPECT_GT(expect_that_of_ray_casting(small_camera(), {before(around, at(Vec3::Zero()), false)}), 500);
    expect_that_of_ray_casting(small_camera(), {before(around, at(Vec3::Zero()), true)});
  }
}

TEST(DepthRaster, IsThatOfRayCastingOverSeveralBodiesAtPoses) {
  const TriangleMesh body = ring_ball(0.06, 5, 9), box = box_mesh({0.1, 0.06, 0.08}, {0.02, 0, 0});
  for (const double turn : {0.0, 2.0}) {
    const std::vector<RasterMesh> seen = {
        before(body, at({0.01, 0.02, 0.4}, {0.3, turn, 0.1}), true),
        before(box, at({-0.02, 0.01, 0.41 + 0.02 * turn}, {turn, 0.4, -0.2}), true),
        before(body, at({0.02, -0.05, 0.5}, {turn, 0, 0.5 * turn}), false)};
    EXPECT_GT(expect_that_of_ray_casting(small_camera(), seen), 300);
  }
}

TEST(DepthRaster, ACameraInsideABoxSeesItsWallsEverywhere) {
  const TriangleMesh room = meshes::inside_out(box_mesh({3, 2, 4}));
  for (const double turn : {0.0, 0.7, 1.9}) {
    const RigidTransform X_CO = at({0.2, -0.3, 0.4}, {turn, -0.5 * turn, 0.2});
    const int pixels = static_cast<int>(small_camera().pixels());
    EXPECT_EQ(expect_that_of_ray_casting(small_camera(), {before(room, X_CO, true)}), pixels);
    EXPECT_EQ(expect_that_of_ray_casting(small_camera(), {before(box_mesh({3, 2, 4}), X_CO, true)}), 0);
    EXPECT_EQ(expect_that_of_ray_casting(small_camera(), {before(box_mesh({3, 2, 4}), X_CO, false)}), pixels);
  }
}

TEST(DepthRaster, AClosedBallSeenFromInsideHasNoGaps) {
  const TriangleMesh ball = ring_ball(0.8, 120, 240);
  const CameraIntrinsics camera{200, 150, 90, 90, 100, 75};  // a pixel is on the optical axis
  for (const Vec3& position : {Vec3(0, 0, 0), Vec3(0.1, -0.2, 0.3), Vec3(0, 0.79, 0)})
    for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(1.5707963267948966, 0, 0), Vec3(0.4, 1.1, -2)}) {
      const RasterImage image = depth_raster(camera, std::vector{before(ball, at(position, turn), false)});
      int gaps = 0;
      for (const double z : image.depth.z_m) gaps += std::isnan(z);
      EXPECT_EQ(gaps, 0) << position.transpose() << "; " << turn.transpose();
    }
}

// Rounding decides on which side of an edge such a ray is.
TEST(DepthRaster, RaysThroughVerticesMeetTheMesh) {
  const CameraIntrinsics camera{120, 90, 131, 127, 59.3, 44.9};
  const PointCloud wave = scenes::random_cloud(120 * 90, 0.01, 5);
  TriangleMesh mesh;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      mesh.vertices.push_back(
          unproject(camera, u, v, 0.7 + 0.01 * u / camera.width + 0.02 * wave.x[mesh.vertices.size()]));
  for (int v = 0; v + 1 < camera.height; ++v)
    for (int u = 0; u + 1 < camera.width; ++u) {
      const int i = v * camera.width + u, below = i + camera.width;
      mesh.triangles.push_back({i, below, i + 1}), mesh.triangles.push_back({i + 1, below, below + 1});
    }
  const RasterImage image = depth_raster(camera, std::vector{before(mesh, at(Vec3::Zero()), false)});
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    ASSERT_NEAR(image.depth.z_m[i], mesh.vertices[i].z(), 1e-12) << i;
}

// The first of equal depths is seen; a triangle in the plane of the rays of a column is not.
TEST(DepthRaster, EqualEdgeOnAndMissingTrianglesHaveAnAnswer) {
  const TriangleMesh plate = {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const RasterMesh seen = before(plate, at(Vec3::Zero()), false);
  for (const int mesh : depth_raster(small_camera(), std::vector{seen, seen}).mesh) EXPECT_EQ(mesh, 0);
  const TriangleMesh wall = {{{0, -1, 0.5}, {0, 1, 0.5}, {0, 0, 2}}, {{0, 1, 2}}};
  const CameraIntrinsics camera{21, 21, 20, 20, 10, 10};  // the middle column is in the wall's plane
  for (const auto& meshes : {std::vector{before(wall, at(Vec3::Zero()), false)}, std::vector<RasterMesh>()}) {
    const RasterImage image = depth_raster(camera, meshes);
    ASSERT_EQ(image.depth.z_m.size(), camera.pixels());
    for (std::size_t i = 0; i < image.mesh.size(); ++i) {
      EXPECT_TRUE(std::isnan(image.depth.z_m[i]));
      EXPECT_EQ(image.mesh[i], -1);
      EXPECT_EQ(image.triangle[i], -1);
    }
  }
}

TEST(DepthRaster, TheBitsDoNotDependOnTheNumberOfThreads) {
  const TriangleMesh soup = triangle_soup(500, 1, {0, 0, 1}, 21), body = ring_ball(0.06, 30, 60);
  const std::vector<RasterMesh> seen = {before(soup, at(Vec3::Zero()), false),
                                        before(body, at({0, 0, 0.3}), true)};
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const RasterImage expected = depth_raster(scenes::kinect(160, 120), seen);
  for (const int count : {2, 3, 7}) {
    omp_set_num_threads(count);
    const RasterImage image = depth_raster(scenes::kinect(160, 120), seen);
    EXPECT_TRUE(scenes::same_bits(image.depth.z_m, expected.depth.z_m));
    EXPECT_EQ(image.mesh, expected.mesh);
    EXPECT_EQ(image.triangle, expected.triangle);
  }
  omp_set_num_threads(threads);
}

}  // namespace
}  // namespace remote_touch::mesh_scene_test
