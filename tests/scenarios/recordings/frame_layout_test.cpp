// Properties that later frames of a recording must have in common with the first.
#include "scenarios/recordings/frame_layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/camera.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_layout_test {
namespace {

constexpr CameraIntrinsics kCamera = {4, 3, 10, 10, 1.5, 1};

PointCloud image(const CameraIntrinsics& camera, double depth_m) {
  DepthImage depth{camera.width, camera.height, {}};
  depth.z_m.assign(camera.pixels(), depth_m);
  return cloud_from_depth(depth, camera, RigidTransform::Identity());
}

PointCloud grid(int columns, int rows) {
  PointCloud cloud;
  for (int i = 0; i < columns * rows; ++i) cloud.append({-1.0, 0.1 * (i % columns), 0.1 * (i / columns)});
  cloud.grid_columns = columns;
  return cloud;
}

std::string problem(const PointCloud& first, PointCloud later) {
  return refusal([&] {
    conform(layout_of(first), "2.pcd", later);
    throw InputError("conforms");
  });
}

TEST(FrameLayout, ImagesOfAnotherSizeAreRefused) {
  const PointCloud first = image(kCamera, 1);
  EXPECT_EQ(problem(first, image(kCamera, 2)), "conforms");
  EXPECT_EQ(problem(first, image({2, 6, 10, 10, 1.5, 1}, 1)),
            "2.pcd: has 2 x 6 points: expected 4 x 3 points, as the first frame that is used has");
  EXPECT_HAS(problem(first, image({4, 2, 10, 10, 1.5, 1}, 1)), "has 4 x 2 points: expected 4 x 3");
}

// The corner pixel is 1.5 columns from the centre: with a focal length of 16 instead of 10 px its point is
// 0.9 px off, with 17 px 1.05 px.
TEST(FrameLayout, ImagesOfAnotherCameraAreRefused) {
  const PointCloud first = image({4, 3, 16, 16, 1.5, 1}, 1);
  const auto seen_with = [](double focal_px) { return image({4, 3, focal_px, focal_px, 1.5, 1}, 1); };
  EXPECT_EQ(problem(first, seen_with(10)), "conforms");
  EXPECT_HAS(problem(image({4, 3, 17, 17, 1.5, 1}, 1), seen_with(10)),
             "2.pcd: has another camera than the first");
}

TEST(FrameLayout, CloudsInNoOrderAndOrganisedOnesDoNotMix) {
  PointCloud unorganised = grid(4, 3);
  unorganised.grid_columns = 0;
  EXPECT_EQ(problem(image(kCamera, 1), unorganised),
            "2.pcd: has points in no order: expected an organised cloud, as the first frame that is used is");
  EXPECT_HAS(problem(grid(4, 3), unorganised), "2.pcd: has points in no order");
  EXPECT_EQ(problem(unorganised, grid(4, 3)),
            "2.pcd: is an organised cloud: expected points in no order, as the first frame that is used has");
  EXPECT_HAS(problem(unorganised, image(kCamera, 1)), "2.pcd: is an organised cloud");
  EXPECT_EQ(problem(unorganised, {}), "conforms");
}

TEST(FrameLayout, CloudsWithoutACameraMayChangeTheirSize) {
  PointCloud few = grid(5, 2), unorganised = grid(4, 3);
  unorganised.grid_columns = few.grid_columns = 0;
  EXPECT_EQ(problem(unorganised, few), "conforms");
  EXPECT_EQ(problem(grid(4, 3), grid(5, 2)), "conforms");
  EXPECT_HAS(problem(image(kCamera, 1), grid(4, 3)),
             "has another camera than the first frame that is used, or none");
}

// All frames are images, or none is: a camera that only later frames have is not used.
TEST(FrameLayout, HasNoCameraInAnyFrameIfTheFirstHasNone) {
  PointCloud later = image(kCamera, 1);
  later.grid_columns = 4;
  conform(layout_of(grid(4, 3)), "2.pcd", later);
  EXPECT_FALSE(later.image);
  EXPECT_EQ(later.columns(), 4);
}

// The frame has no measured point, or too few for a fit.
TEST(FrameLayout, FramesWithTooFewPointsForAFitHaveTheCameraOfTheFirst) {
  const FrameLayout layout = layout_of(image(kCamera, 1));
  PointCloud nothing, one_point = image(kCamera, 2);
  for (std::size_t i = 0; i < one_point.size(); ++i)
    if (i != 5) one_point.x[i] = one_point.y[i] = one_point.z[i] = std::nan("");
  one_point.image.reset(), one_point.grid_columns = 4;
  for (PointCloud* cloud : {&nothing, &one_point}) {
    conform(layout, "2.pcd", *cloud);
    ASSERT_TRUE(cloud->image);
    EXPECT_EQ(cloud->size(), 12u);
    EXPECT_EQ(cloud->image->camera.fx, 10);
    EXPECT_LT(cloud->image->pixel_slack, 1e-5);
  }
  EXPECT_TRUE(std::isnan(nothing.z[5]));
  EXPECT_EQ(one_point.z[5], 2);
  one_point.image.reset(), one_point.x[5] += 0.15;  // 0.75 px
  EXPECT_HAS(problem(image(kCamera, 1), one_point), "has another camera");
}

}  // namespace
}  // namespace remote_touch::frame_layout_test
