// The memory that a live run reserves for the points of its camera, and its end if a frame cannot be used.
#include "runners/live/loop/live_parts.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/dissertation/tool/contact/tiled_cloud.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_parts_test {
namespace {

// An image in which every pixel is measured gives the most tiles that a renderer keeps.
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

// The simulated hand follows the recording, whose fourth image has another size.
TEST(LiveParts, ReportTheFrameThatTheSimulatedHandCannotUse) {
  const TestFolder folder("live_size_changes");
  folder.write("camera.json", R"({"width": 80, "height": 60, "fx": 75, "fy": 75, "cx": 39.5, "cy": 29.5,
    "depth_scale_m": 0.001, "frame_rate_hz": 30})");
  for (int i = 0; i < 6; ++i) {
    const int width = i == 3 ? 40 : 80;
    const std::vector<std::uint16_t> samples(static_cast<std::size_t>(width) * 60, 500);
    folder.write_png("depth/" + std::to_string(i) + ".png", width, 60, PNG_FORMAT_LINEAR_Y, samples.data());
  }
  const std::string text = R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
                           R"("}, "renderer": {"name": "proxy"}, "trajectory": {"name": "image-press",
                           "margin_m": 0.02}})";
  for (const double duration_s : {0.05, 0.3}) {
    SimulatedClock clock;
    // The camera of the run sees another scene, so that only the hand reads the recording.
    SimulatedRun run(clock, Experiment::from_json(text, "test"), SimulatedRun::simulated_device,
                     [](const Experiment&, Clock& with) {
                       return SimulatedRun::scenario_camera(press_experiment(), with);
                     });
    run.options.duration_s = duration_s;
    const LiveResult result = run.run();
    EXPECT_EQ(result.failed, duration_s > 0.1);
    if (!result.failed) {
      EXPECT_EQ(result.refused, "");
    } else {
      EXPECT_HAS(result.refused, "depth/3.png");
      EXPECT_HAS(result.ended, "the device failed: " + result.refused);
    }
  }
}

}  // namespace
}  // namespace remote_touch::live_parts_test
