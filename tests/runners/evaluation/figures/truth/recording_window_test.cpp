#include "runners/evaluation/figures/truth/recording_window.h"

#include <gtest/gtest.h>

#include "tests/runners/evaluation/figures/truth/true_wall.h"

namespace remote_touch::recording_window_test {
namespace {

using namespace true_wall;

TEST(TrueImage, ShowsTheFrontAtItsDepthWithItsNormal) {
  const TestFolder folder("true_image_test");
  write(folder);
  const WallScene scene(folder);
  const RecordedTruth& truth = *(*scene).truth();
  const CameraIntrinsics camera{kWidth, kHeight, kFocal_px, kFocal_px, 80, 60};
  const RasterImage image = true_image(truth, 0, camera);
  const std::size_t middle = 60 * kWidth + 80;
  EXPECT_EQ(image.mesh[middle], 0);
  EXPECT_NEAR(image.depth.z_m[middle], kFront_m, 1e-6);
  EXPECT_TRUE(true_normal_C(truth, 0, image, middle).isApprox(-Vec3::UnitZ(), 1e-9));
  EXPECT_EQ(image.mesh[0], -1);
}

TEST(TouchedPoints, AreOnTheMeshInTheMiddleOfTheObject) {
  const TestFolder folder("touched_points_test");
  write(folder);
  const WallScene scene(folder);
  const std::vector<TouchedPoint> points = touched_points(*scene, 0, 3);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].object, "box");
  EXPECT_NEAR(points[0].p_O.x(), 0, 0.01);
  EXPECT_NEAR(points[0].p_O.y(), 0, 0.01);
  EXPECT_NEAR(points[0].p_O.z(), 0, 1e-6) << "on the true surface, not on the measured one";
  EXPECT_TRUE(points[0].outwards_O.isApprox(-Vec3::UnitZ(), 1e-9));
  EXPECT_TRUE(touched_points(*scene, 0, 0).empty());
}

TEST(RecordingWindow, HasThePointsOfTheRecordingAroundAPointThatMoves) {
  const TestFolder folder("recording_window_test");
  write(folder, 0.004);
  const WallScene scene(folder);
  const auto windows = windows_around(touched_points(*scene, 0, 1), *scene, kFrames);
  ASSERT_EQ(windows.size(), 1u);
  const RecordingWindow& window = *windows[0];
  ASSERT_EQ(window.frame_count(), kFrames);
  EXPECT_NEAR(window.p_W(5).x() - window.p_W(0).x(), 5 * 0.004, 1e-9);
  for (const int frame : {0, 5}) {
    const PointCloud cloud = window.cloud(frame), whole = (*scene).cloud(frame);
    const CameraIntrinsics& camera = cloud.image->camera;
    // A pixel is at the same place by either camera.
    const int left = static_cast<int>(80 - camera.cx), top = static_cast<int>(60 - camera.cy);
    EXPECT_LT(camera.width, kWidth);
    for (const int row : {0, camera.height - 1})
      for (const int column : {0, camera.width - 1}) {
        const auto in_window = static_cast<std::size_t>(row * camera.width + column);
        const auto in_whole = static_cast<std::size_t>((row + top) * kWidth + column + left);
        EXPECT_EQ(cloud.z[in_window], whole.z[in_whole]) << frame;
        EXPECT_EQ(cloud.x[in_window], whole.x[in_whole]) << frame;
      }
  }
}

TEST(RecordingWindow, MeasuresTheDistancesOfTheRecording) {
  const TestFolder folder("window_distance_test");
  write(folder, 0.004);
  const WallScene scene(folder);
  const auto windows = windows_around(touched_points(*scene, 0, 1), *scene, kFrames);
  for (const int frame : {0, 3}) {
    const double time_s = windows[0]->captured_s(frame);
    const Vec3 p_W = windows[0]->p_W(frame) - Vec3(0.002, 0.003, 0.004);
    EXPECT_EQ(windows[0]->measured_distance(p_W, time_s), (*scene).measured_distance(p_W, time_s));
    EXPECT_EQ(windows[0]->signed_distance(p_W, time_s), (*scene).signed_distance(p_W, time_s));
    EXPECT_NEAR(windows[0]->signed_distance(p_W, time_s), 0.004, 1e-6);
  }
}

}  // namespace
}  // namespace remote_touch::recording_window_test
