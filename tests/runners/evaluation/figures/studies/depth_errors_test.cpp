#include "runners/evaluation/figures/studies/depth_errors.h"

#include <gtest/gtest.h>

#include "tests/runners/evaluation/figures/studies/true_wall.h"

namespace remote_touch::depth_errors_test {
namespace {

using namespace true_wall;

// A filter changes nothing on a flat wall without noise.
TEST(DepthErrors, OfAFlatWallAreTheErrorOfTheCamera) {
  const TestFolder folder("depth_errors_test");
  write(folder, 0.002);
  const WallScene scene(folder);
  DepthPipelineSettings unfiltered;
  unfiltered.filter = false;
  const auto errors = depth_errors(*scene, {0}, {unfiltered, DepthPipelineSettings()}, {kFrames, 2, 2},
                                   kernels_for(best_isa()));
  ASSERT_EQ(errors.size(), 1u);
  ASSERT_EQ(errors[0].size(), 2u);
  for (const DepthErrors& of_setting : errors[0]) {
    EXPECT_GT(of_setting.pixels, 1000);
    EXPECT_NEAR(of_setting.to_measured_m, 0, 1e-5);
    EXPECT_NEAR(of_setting.to_true_m, kError_m, 1e-5);
    EXPECT_NEAR(of_setting.true_mean_m, kError_m, 1e-5);
    EXPECT_NEAR(of_setting.to_true_90_m, kError_m, 1e-5);
    EXPECT_NEAR(of_setting.normal_deg, 0, 0.1);
  }
  EXPECT_EQ(errors[0][0].pixels, errors[0][1].pixels);
}

// Every pixel of the box is farther than 30 mm from an object that is not there.
TEST(DepthErrors, LeaveOutPixelsFarFromTheTrueDepth) {
  const TestFolder folder("far_depth_test");
  write(folder);
  std::string poses;
  for (int frame = 0; frame < kFrames; ++frame) poses += "1 0 0 0 0 1 0 0 0 0 1 0.54 0 0 0 1\n";
  folder.write("wall/truth/poses.txt", poses);
  const WallScene scene(folder);
  const auto errors =
      depth_errors(*scene, {0}, {DepthPipelineSettings()}, {kFrames, 3, 4}, kernels_for(best_isa()));
  EXPECT_EQ(errors[0][0].pixels, 0);
  EXPECT_TRUE(std::isnan(errors[0][0].to_true_m));
}

}  // namespace
}  // namespace remote_touch::depth_errors_test
