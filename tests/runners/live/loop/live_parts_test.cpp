// How much room a live run makes for the points of its camera.
#include "runners/live/loop/live_parts.h"

#include <gtest/gtest.h>

#include "core/tool/contact/tiled_cloud.h"

namespace remote_touch::live_parts_test {
namespace {

// The tiles of an image in which every pixel is measured are the most that a renderer keeps of it.
TEST(ExpectedPoints, EveryImageHasRoom) {
  for (const int width : {1, 7, 8, 17, 64, 100, 641})
    for (const int height : {1, 9, 16, 31, 97}) {
      PointCloud cloud;
      cloud.image = ImageLayout{{}, RigidTransform::Identity()};
      cloud.image->camera.width = width, cloud.image->camera.height = height;
      cloud.image->camera.fx = cloud.image->camera.fy = 500;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) cloud.append(Vec3(0.002 * u, 0.002 * v, 1));
      TiledCloud tiled;
      tiled.assign(cloud);
      SensorView view;
      view.camera = cloud.image->camera;
      EXPECT_GE(expected_points(view), tiled.padded_size()) << width << " x " << height;
    }
}

TEST(ExpectedPoints, ACloudMayGrowToTwiceItsSize) {
  SensorView view;
  view.cloud.emplace();
  view.cloud->expected_points = 1000;
  EXPECT_GE(expected_points(view), 2000u);
}

}  // namespace
}  // namespace remote_touch::live_parts_test
