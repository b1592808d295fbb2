// The simple depth camera and its scene: poses, depths, holes and noise against closed forms.
#include "scenarios/simulated/depth_camera.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::depth_camera_test {
namespace {

constexpr std::uint32_t kTable = 0x204060, kBlock = 0xC03020;
constexpr double kBlockTop_m = 0.1;

DepthCameraSettings small() {
  return {.width = 64,
          .height = 48,
          .focal_px = 60,
          .camera_position_m = {0, 0.5, 0},
          .noise_per_m = 0,
          .quantisation_per_m = 0};
}
DepthCamera made(const DepthCameraSettings& settings, std::uint64_t seed = 1) {
  return DepthCamera(settings, NoiseKey{seed}, scenes::kernels());
}
std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * 64 + static_cast<std::size_t>(u);
}

RayHit table(const Vec3& origin, const Vec3& ray) {
  return ray.y() < 0 ? RayHit{-origin.y() / ray.y(), kTable} : RayHit{};
}
// A block on the table fills the half-space above 0 along the axis (0: x, 2: z), below its top.
RayCast table_and_block(int axis) {
  return [axis](const Vec3& origin, const Vec3& ray) {
    const RayHit top = {(kBlockTop_m - origin.y()) / ray.y(), kBlock};
    return origin[axis] + top.t * ray[axis] > 0 ? top : table(origin, ray);
  };
}

TEST(LookAt, AxesAreRightHandedAndTheWorldsUpIsUpInTheImage) {
  const PointCloud at = scenes::random_cloud(100, 1, 1);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const RigidTransform X_WC = look_at(at.point(i), at.point(i + 1));
    EXPECT_LT((X_WC.linear().transpose() * X_WC.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(X_WC.linear().determinant(), 1, 1e-14);
    EXPECT_EQ(X_WC.translation(), at.point(i));
    const Vec3 target_C = X_WC.inverse() * at.point(i + 1);
    EXPECT_LT(target_C.head<2>().norm(), 1e-14);
    EXPECT_GT(target_C.z(), 0);
    EXPECT_NEAR(X_WC.linear()(1, 0), 0, 1e-16) << "image rows are level";
    EXPECT_LT(X_WC.linear()(1, 1), 0) << "image down goes down";
  }
}

TEST(LookAt, TheImagesRightIsXIfTheCameraLooksStraightDownOrUp) {
  const RigidTransform down = look_at({0.1, 0.5, 0.2}, {0.1, 0, 0.2}), up = look_at({0, 0, 0}, {0, 2, 0});
  EXPECT_EQ(down.linear().col(0), Vec3(1, 0, 0));
  EXPECT_EQ(down.linear().col(1), Vec3(0, 0, 1)) << "the image's up is -z";
  EXPECT_EQ(down.linear().col(2), Vec3(0, -1, 0));
  EXPECT_EQ(up.linear().col(0), Vec3(1, 0, 0));
  EXPECT_EQ(up.linear().col(1), Vec3(0, 0, -1));
  // A camera that has moved a little towards +z sees nearly the same image.
  EXPECT_LT((look_at({0.1, 0.5, 0.2 + 1e-6}, {0.1, 0, 0.2}).linear() - down.linear()).norm(), 1e-5);
}

TEST(DepthCamera, APlaneIsSeenAtItsDepth) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0.4, 0.3, 0}, s.hole_px = 0;  // looks down at an angle whose sine is 3 / 5
  const DepthCamera slanting = made(s);
  const IdealView view = slanting.view(table, false);
  const PointCloud cloud = slanting.measured(view, 0);
  for (const int v : {0, 20, 47}) {
    const double down = (v - 23.5) / 60;
    EXPECT_NEAR(view.depth.z_m[pixel(5, v)], 0.3 / (0.6 + 0.8 * down), 1e-14) << v;
    EXPECT_NEAR(cloud.y[pixel(5, v)], 0, 1e-15);
  }
}

TEST(DepthCamera, ColumnsAreAlongXAndRowsAlongZSeenFromAbove) {
  const DepthCamera camera = made(small());
  const PointCloud cloud = camera.measured(camera.view(table, false), 0);
  ASSERT_TRUE(cloud.image.has_value());
  for (const int v : {0, 17, 47})
    for (const int u : {0, 31, 63}) {
      const Vec3 expected((u - 31.5) / 60 * 0.5, 0, (v - 23.5) / 60 * 0.5);
      EXPECT_LT((cloud.point(pixel(u, v)) - expected).norm(), 1e-15) << u << " " << v;
    }
}

TEST(DepthCamera, MeasuresNothingBeyondThreeMetres) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0, 0.5, 0}, s.target_position_m = {1, 0.5, 0};
  const IdealView view = made(s).view(table, true);
  for (int v = 0; v < 48; ++v) {
    const double depth = 0.5 * 60 / (v - 23.5);
    EXPECT_EQ(std::isnan(view.depth.z_m[pixel(9, v)]), !(v > 23 && depth <= 3)) << v;
    EXPECT_EQ(view.colour[pixel(9, v)], v > 23 ? kTable : 0) << "the colour camera sees the far table too";
  }
}

TEST(DepthCamera, HolesAreOnlyNearEdgesAndKeepTheirColour) {
  for (const int axis : {0, 2})
    for (const int reach : {0, 1, 3}) {
      DepthCameraSettings s = small();
      s.hole_px = reach;
      const DepthCamera camera = made(s);
      const IdealView view = camera.view(table_and_block(axis), true);
      const PointCloud cloud = camera.measured(view, 0);
      // The block's edge meets the optical axis: it is between the middle columns or rows.
      for (int v = 0; v < 48; ++v)
        for (int u = 0; u < 64; ++u) {
          const std::size_t i = pixel(u, v);
          const int beyond = axis == 0 ? u - 32 : v - 24;
          EXPECT_EQ(view.hole[i] != 0, beyond >= -reach && beyond < reach) << reach << ": " << beyond;
          for (const double c : {cloud.x[i], cloud.y[i], cloud.z[i]})
            EXPECT_EQ(std::isnan(c), view.hole[i] != 0);
          EXPECT_EQ(cloud.colour[i], beyond < 0 ? kTable : kBlock);
        }
    }
  DepthCameraSettings blind = small();
  blind.edge_jump_m = kBlockTop_m + 1e-9;
  for (const char hole : made(blind).view(table_and_block(0), false).hole) EXPECT_EQ(hole, 0);
}

TEST(DepthCamera, DepthsAreWholeDisparities) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0.4, 0.3, 0}, s.quantisation_per_m = 0.01;
  const DepthCamera camera = made(s);
  const IdealView view = camera.view(table, false);
  const PointCloud cloud = camera.measured(view, 0);
  const RigidTransform X_CW = camera.pose().inverse();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::isnan(cloud.x[i])) continue;
    const double z = (X_CW * cloud.point(i)).z(), level = 100 / z;
    EXPECT_NEAR(level, std::round(level), 1e-9);
    EXPECT_LE(std::abs(level - 100 / view.depth.z_m[i]), 0.5 + 1e-9) << "the nearest one";
  }
}

TEST(DepthCamera, ADepthWhoseDisparityIsRoundedToZeroIsLost) {
  DepthCameraSettings s = small();
  s.noise_per_m = 0, s.quantisation_per_m = 0.1;
  const DepthImage far{s.width, s.height,
                       std::vector<double>(static_cast<std::size_t>(s.width * s.height), 30)};
  for (const double z : made(s).measured_depth(made(s).view(far, {}), 0).z_m) EXPECT_TRUE(std::isnan(z));
}

TEST(DepthCamera, NoiseHasTheSetDeviationAndDependsOnTheFrame) {
  DepthCameraSettings s = small();
  s.noise_per_m = 0.01;
  for (const double z : {0.5, 1.0}) {
    s.camera_position_m = {0, z, 0};
    const DepthCamera camera = made(s), other = made(s, 2);
    const IdealView view = camera.view(table, false);
    double sum = 0, squares = 0, count = 0;
    for (int frame = 0; frame < 20; ++frame)
      for (const double y : camera.measured(view, frame).y) sum += y, squares += y * y, ++count;
    const double sigma = 0.01 * z * z;
    EXPECT_NEAR(sum / count, 0, 5 * sigma / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count), sigma, 5 * sigma / std::sqrt(2 * count));

    EXPECT_EQ(camera.measured(view, 7).y, camera.measured(view, 7).y);
    EXPECT_NE(camera.measured(view, 7).y, camera.measured(view, 8).y);
    EXPECT_NE(camera.measured(view, 7).y, other.measured(view, 7).y);
  }
}

TEST(CameraScene, NoiseFreePointsLieOnTheSurfaceInSight) {
  CameraScene::Settings s;
  s.camera.noise_per_m = s.camera.quantisation_per_m = 0;
  const CameraScene scene(s, NoiseKey{1}, scenes::kernels());
  const PointCloud cloud = scene.cloud(0);
  int on_solids = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    if (std::isnan(cloud.x[i])) continue;
    const Vec3 p = cloud.point(i);
    ASSERT_LT(std::abs(scene.signed_distance(p, 0)), 1e-12) << p.transpose();
    for (const double fraction : {0.7, 0.9, 0.99, 0.999})
      ASSERT_GT(scene.signed_distance(Vec3(0.3, 0.6, -0.02) + fraction * (p - Vec3(0.3, 0.6, -0.02)), 0), 0);
    on_solids += p.y() > 0.001;
  }
  EXPECT_GT(on_solids, 5000);
}

}  // namespace
}  // namespace remote_touch::depth_camera_test
