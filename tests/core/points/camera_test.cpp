#include "core/points/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace remote_touch::camera_test {
namespace {

constexpr CameraIntrinsics kCamera{4, 3, 10, 20, 1.5, 1};

PointCloud cloud_of(int width, int height, std::size_t depths, const CameraIntrinsics& camera = kCamera) {
  return cloud_from_depth({width, height, std::vector<double>(depths, 0.5)}, camera,
                          RigidTransform::Identity());
}

std::string error_of(int width, int height, std::size_t depths) {
  try {
    cloud_of(width, height, depths);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(CloudFromDepth, EveryPixelIsAPointOnItsRay) {
  const PointCloud cloud = cloud_of(4, 3, 12);
  ASSERT_EQ(cloud.size(), 12u);
  EXPECT_LT((cloud.point(11) - Vec3(0.075, 0.025, 0.5)).norm(), 1e-15);
  DepthImage hole{4, 3, std::vector<double>(12, 0.5)};
  hole.z_m[5] = std::nan("");
  EXPECT_FALSE(cloud_from_depth(hole, kCamera, RigidTransform::Identity()).is_measured(5));
}

TEST(CloudFromDepth, RefusesAnImageOfAnotherSize) {
  EXPECT_EQ(error_of(4, 3, 12), "");
  EXPECT_EQ(error_of(3, 4, 12), "depth image: 3 x 4 pixels: expected the camera's 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 11), "depth image: 11 depths: expected one for each of 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 13), "depth image: 13 depths: expected one for each of 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 0), "depth image: 0 depths: expected one for each of 4 x 3 pixels");
}

TEST(CloudFromDepth, AnImageWithoutPixelsIsAnEmptyCloud) {
  EXPECT_EQ(cloud_of(0, 0, 0, {}).size(), 0u);
}

}  // namespace
}  // namespace remote_touch::camera_test
