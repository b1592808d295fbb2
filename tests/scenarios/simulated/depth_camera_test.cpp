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

TEST(DepthCamera, RefusesToLookAtItself) {
  DepthCameraSettings s = small();
  EXPECT_EQ(validate(s), "");
  s.target_position_m = s.camera_position_m;
  EXPECT_NE(validate(s), "");
}

TEST(DepthCamera, APlaneIsSeenAtItsDepth) {
  DepthCameraSettings s = small();
  const IdealView from_above = made(s).view(table, false);
  for (const double z : from_above.depth.z_m) EXPECT_NEAR(z, 0.5, 1e-15);
  EXPECT_TRUE(from_above.colour.empty());

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
  EXPECT_EQ(DepthCameraSettings{}.edge_jump_m, 0.02);
  EXPECT_EQ(DepthCameraSettings{}.hole_px, 2);
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

}  // namespace
}  // namespace remote_touch::depth_camera_test

namespace remote_touch::camera_scene_test {
namespace {

using Profile = std::vector<std::array<double, 2>>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLow = -0.03, kHigh = 0.05;

const Profile kBox{{0.14, 0}, {0.26, 0}, {0.26, 0.08}, {0.14, 0.08}};
const Profile kRamp{{-0.05, 0}, {0.1, 0}, {0.1, 0.06}};
const Profile kOdd{{0.01, -0.02}, {0.06, 0.0}, {0.07, 0.05}, {0.03, 0.07}, {-0.02, 0.04}};

// Returns true if a level ray crosses the edges an odd number of times, which is valid for any polygon.
bool within(const Profile& profile, double z, double y) {
  bool odd = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    if ((a[1] > y) != (b[1] > y) && z < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) odd = !odd;
  }
  return odd;
}
bool within(const Profile& profile, const Vec3& p) {
  return p.x() > kLow && p.x() < kHigh && within(profile, p.z(), p.y());
}

// Returns points on the whole surface. No part of the surface is farther than spacing from one of them.
std::vector<Vec3> surface(const Profile& profile, double spacing) {
  std::vector<Vec3> points;
  const auto parts = [&](double length) { return static_cast<int>(std::ceil(length / spacing)); };
  const int along = parts(kHigh - kLow);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    const double dz = b[0] - a[0], dy = b[1] - a[1];
    const int across = parts(std::sqrt(dz * dz + dy * dy));
    for (int j = 0; j <= across; ++j)
      for (int k = 0; k <= along; ++k)
        points.emplace_back(kLow + (kHigh - kLow) * k / along, a[1] + dy * j / across,
                            a[0] + dz * j / across);
  }
  for (double z = -0.1; z < 0.3; z += spacing)
    for (double y = -0.1; y < 0.1; y += spacing)
      if (within(profile, z, y))
        for (const double x : {kLow, kHigh}) points.emplace_back(x, y, z);
  return points;
}

Vec3 middle(const Profile& profile) {
  Vec3 sum(0.5 * (kLow + kHigh), 0, 0);
  for (const auto& corner : profile)
    sum += Vec3(0, corner[1], corner[0]) / static_cast<double>(profile.size());
  return sum;
}

class ExtrusionTest : public testing::TestWithParam<Profile> {
 protected:
  const Profile& profile() const { return GetParam(); }
  const Extrusion solid_{GetParam(), kLow, kHigh};
};

TEST_P(ExtrusionTest, SignedDistanceIsToTheNearestSampleOfTheSurface) {
  const double spacing = 0.001;
  const std::vector<Vec3> samples = surface(profile(), spacing);
  const PointCloud at = scenes::random_cloud(300, 0.1, 1);
  int inside = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    // Every other point is drawn near the middle, where the inside is.
    const Vec3 p = middle(profile()) + (i % 2 == 0 ? 1.0 : 0.3) * at.point(i);
    double squared = kInfinity;
    for (const Vec3& s : samples) squared = std::min(squared, (s - p).squaredNorm());
    const double got = solid_.signed_distance(p), nearest = std::sqrt(squared);
    EXPECT_EQ(got < 0, within(profile(), p)) << p.transpose();
    // A sample lies within spacing of the foot and, on a face, at a right angle to the foot's line.
    EXPECT_LE(std::abs(got), nearest + 1e-15) << p.transpose();
    EXPECT_GE(std::sqrt(got * got + spacing * spacing), nearest - 1e-15) << p.transpose();
    inside += got < 0;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 250);
}

// Returns the first t at which the ray enters the solid, by small steps and bisection; infinite if there is
// none.
double walked_cast(const Extrusion& solid, const Vec3& origin, const Vec3& direction, double end) {
  const auto inside = [&](double t) { return solid.signed_distance(origin + t * direction) <= 0; };
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    double high = end * i / kSteps, low = end * (i - 1) / kSteps;
    if (!inside(high)) continue;
    if (i == 0) return 0;
    for (int k = 0; k < 60; ++k) (inside(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return high;
  }
  return kInfinity;
}

TEST_P(ExtrusionTest, CastMeetsTheSurfaceWhereAWalkDoes) {
  const PointCloud from = scenes::random_cloud(600, 0.25, 2), displacement = scenes::random_cloud(600, 1, 3);
  int hits = 0, misses = 0, inside = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 origin = middle(profile()) + (i % 5 == 0 ? 0.1 : 1.0) * from.point(i);
    // Some directions point to the solid, others are random. Their lengths differ, because t is in units of
    // the direction.
    const Vec3 towards = middle(profile()) + 0.05 * displacement.point(i) - origin;
    const Vec3 direction = (i % 2 == 0 ? towards : displacement.point(i)) * (1 + static_cast<double>(i % 7));
    const double end = 1 / direction.norm();  // 1 m, beyond everything here
    const double got = solid_.cast(origin, direction);
    const double walked = walked_cast(solid_, origin, direction, end);
    if (got < kInfinity) {
      const double there = solid_.signed_distance(origin + got * direction);
      if (got > 0) {
        EXPECT_LT(std::abs(there), 1e-12) << i;
      }
      if (got == 0) {
        EXPECT_LE(there, 0) << i;
      }
      for (int k = 0; k < 100; ++k)
        EXPECT_GT(solid_.signed_distance(origin + got * k / 100 * direction), got > 0 ? 0 : -kInfinity);
      // The walk may step over a corner shorter than its steps, and then finds nothing.
      if (walked < kInfinity) {
        EXPECT_NEAR(got * direction.norm(), walked * direction.norm(), 1e-10) << i;
      }
      if (walked < kInfinity) ++hits;
      inside += got == 0;
    } else {
      EXPECT_EQ(walked, kInfinity) << i;
      ++misses;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 100);
  EXPECT_GT(inside, 50);
}

TEST_P(ExtrusionTest, HeightIsTheUpperOutline) {
  for (double z = -0.1005; z < 0.3; z += 0.003) {
    double top = -kInfinity;
    for (std::size_t i = 0; i < profile().size(); ++i) {
      const auto &a = profile()[i], &b = profile()[(i + 1) % profile().size()];
      if ((z - a[0]) * (z - b[0]) < 0) top = std::max(top, a[1] + (z - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
    }
    // height() casts a ray from 1 km above, so its result has the rounding error of that distance.
    if (top > -kInfinity)
      EXPECT_NEAR(solid_.height(0.01, z), top, 1e-12) << z;
    else
      EXPECT_EQ(solid_.height(0.01, z), -kInfinity) << z;
    EXPECT_EQ(solid_.height(kLow - 1e-6, z), -kInfinity);
    EXPECT_EQ(solid_.height(kHigh + 1e-6, z), -kInfinity);
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, ExtrusionTest, testing::Values(kBox, kRamp, kOdd),
                         [](const auto& profile) {
                           return profile.param == kBox ? "box" : profile.param == kRamp ? "ramp" : "odd";
                         });

TEST(Extrusion, ABoxHasTheValuesComputedByHand) {
  const Extrusion box(kBox, kLow, kHigh);
  EXPECT_NEAR(box.signed_distance({0, 0.1, 0.2}), 0.02, 1e-16);
  EXPECT_NEAR(box.signed_distance({0.08, 0.12, 0.2}), 0.05, 1e-16);     // an edge: 3-4-5
  EXPECT_NEAR(box.signed_distance({0.07, 0.09, 0.28}), 0.03, 1e-16);    // a corner: 2-1-2
  EXPECT_NEAR(box.signed_distance({0.045, 0.04, 0.2}), -0.005, 1e-16);  // nearest to a cap
  EXPECT_NEAR(box.cast({0, 0.5, 0.2}, {0, -2, 0}), 0.21, 1e-15);        // t is in units of the direction
  EXPECT_EQ(box.cast({0, 0.5, 0.2}, {0, 1, 0}), kInfinity);             // behind
  EXPECT_EQ(box.cast({0, 0.1, 0.2}, {1, 0, 0}), kInfinity);             // level, above the top
  EXPECT_NEAR(box.cast({-1, 0.04, 0.2}, {1, 0, 0}), 0.97, 1e-15);       // through a cap
}

}  // namespace
}  // namespace remote_touch::camera_scene_test
