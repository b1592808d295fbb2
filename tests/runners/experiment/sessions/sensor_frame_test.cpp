#include "runners/experiment/sessions/sensor_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/points/vector.h"

namespace remote_touch::sensor_frame_test {
namespace {

// The positions of the points of a sensor's frame.

// The pixels are not square, and the centre is not in the middle.
const SensorView kView{{4, 3, 200, 250, 1.25, 0.75}, 0.0005, 30, false, RigidTransform::Identity()};

SensorFrame frame_of(std::uint16_t first_depth) {
  SensorFrame frame;
  for (std::uint16_t i = 0; i < 12; ++i)
    frame.depth.push_back(static_cast<std::uint16_t>(first_depth + 100 * i));
  return frame;
}

RigidTransform somewhere() {
  RigidTransform X_WC(Eigen::Translation3d(0.3, -0.7, 1.1));
  return X_WC.rotate(rotation({0.4, -1.1, 2.3}));
}

// x = (u - cx) z / fx, y = (v - cy) z / fy, with z along the optical axis.
TEST(SensorCloud, IsTheClosedFormOfItsPixels) {
  const SensorFrame frame = frame_of(1000);
  for (const RigidTransform& X_WC : {RigidTransform::Identity(), somewhere()}) {
    const PointCloud cloud = cloud_of(frame, kView, X_WC);
    ASSERT_EQ(cloud.size(), 12u);
    for (int v = 0; v < 3; ++v)
      for (int u = 0; u < 4; ++u) {
        const double z = 0.5 + 0.05 * (4 * v + u);
        const Vec3 p_C((u - 1.25) / 200 * z, (v - 0.75) / 250 * z, z);
        const Vec3 expected_W = X_WC.linear() * p_C + X_WC.translation();
        EXPECT_LT((cloud.point(static_cast<std::size_t>(4 * v + u)) - expected_W).norm(), 1e-15)
            << u << " " << v;
      }
  }
}

// The pose is the one that was given, not the one that the source knows.
TEST(SensorCloud, HasTheCameraAndTheGivenPose) {
  SensorView view = kView;
  view.X_WC = RigidTransform(Eigen::Translation3d(9, 9, 9));
  const PointCloud cloud = cloud_of(frame_of(1000), view, somewhere());
  ASSERT_TRUE(cloud.image);
  EXPECT_EQ(cloud.image->camera.width, 4);
  EXPECT_EQ(cloud.image->camera.fy, 250);
  EXPECT_EQ(cloud.image->X_WC.matrix(), somewhere().matrix());
  EXPECT_EQ(cloud.columns(), 4);
}

TEST(SensorCloud, ZeroIsAHoleAndOneIsTheNearestThereIs) {
  SensorFrame frame = frame_of(1000);
  frame.depth[0] = frame.depth[7] = 0;
  frame.depth[5] = 1, frame.depth[6] = 65535;
  const PointCloud cloud = cloud_of(frame, kView, RigidTransform::Identity());
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(cloud.is_measured(i), i != 0 && i != 7) << i;
  for (const std::size_t hole : {0u, 7u})
    EXPECT_TRUE(std::isnan(cloud.x[hole]) && std::isnan(cloud.y[hole]) && std::isnan(cloud.z[hole]));
  EXPECT_EQ(cloud.z[5], 0.0005);
  EXPECT_EQ(cloud.z[6], 65535 * 0.0005);
}

TEST(SensorCloud, KeepsTheColours) {
  SensorFrame frame = frame_of(1000);
  EXPECT_TRUE(cloud_of(frame, kView, somewhere()).colour.empty());
  for (std::uint32_t i = 0; i < 12; ++i) frame.colour.push_back(0xff8000u + i);
  EXPECT_EQ(cloud_of(frame, kView, somewhere()).colour, frame.colour);
}

// The statistics of a sensor's frames.

TEST(SensedPoints, CountTheMeasuredPixelsOfImages) {
  SensorView view{{4, 1, 100, 100, 2, 0.5}, 0.0005, 30, true, RigidTransform::Identity()};
  SensedPoints points;
  EXPECT_EQ(points.text(), "0 % of 0 points measured, without colours");
  points.add({0, 0, {0, 0, 0, 0}, {}}, view);
  EXPECT_EQ(points.text(), "0 % of 4 points measured, with colours");
  points.add({1, 0.1, {1000, 0, 2400, 65535}, {}}, view);
  EXPECT_EQ(points.frames(), 2);
  EXPECT_EQ(points.text(), "37.5 % of 8 points measured, depth 0.5 to 32.8 m, with colours");
  EXPECT_EQ(layout_text(view), "4 x 1 pixels");
}

TEST(SensedPoints, CountTheFinitePointsOfClouds) {
  SensorView view;
  view.cloud = CloudLayout{true, 0, 3};
  SensorFrame frame;
  frame.points = {0, 0, -0.25f, 0, 0, 1, NAN, NAN,      NAN, 0, 0, 1,
                  1, 1, 0.75f,  0, 0, 1, 1,   INFINITY, 9,   0, 0, 1};
  SensedPoints points;
  points.add(frame, view);
  EXPECT_EQ(points.text(), "50 % of 4 points measured, z -0.25 to 0.75 m, without colours");
  EXPECT_EQ(layout_text(view), "clouds of points");
}

}  // namespace
}  // namespace remote_touch::sensor_frame_test
