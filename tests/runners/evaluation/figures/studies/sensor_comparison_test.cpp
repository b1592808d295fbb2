// A simulated sensor before recorded scenes: the scenes that are made of recordings against known
// ones, and errors against true objects that are known.
#include "runners/evaluation/figures/studies/sensor_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/dissertation/tool_shape/generated_tools.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sensor_comparison_test {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
const CameraIntrinsics kCamera{80, 60, 100, 100, 39.5, 29.5};

DepthImage wall(double z_m) {
  return {kCamera.width, kCamera.height, std::vector<double>(kCamera.pixels(), z_m)};
}

TEST(FilledScene, FillsHolesWithTheFartherDepthOfTheRow) {
  const DepthScene scene = filled_scene({6, 2, {kHole, 1, kHole, kHole, 2, kHole, 2, kHole, 1, 1, kHole, 1}});
  const std::vector<double> expected{kHole, 1, 2, 2, 2, kHole, 2, 2, 1, 1, 1, 1};
  EXPECT_TRUE(scene.cosine.empty());
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (std::isnan(expected[i]))
      EXPECT_TRUE(std::isnan(scene.depth.z_m[i])) << i;
    else
      EXPECT_EQ(scene.depth.z_m[i], expected[i]) << i;
}

TEST(PlanarScene, HasTheDepthsAndAnglesOfThePlanes) {
  const Vec3 normal = Vec3(0.5, -0.3, -0.8).normalized();
  DepthImage plane = wall(0);
  std::vector<double> cosine;
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Vec3 ray = unproject(kCamera, u, v, 1);
      plane.z_m[static_cast<std::size_t>(v * kCamera.width + u)] = -0.7 / normal.dot(ray);
      cosine.push_back(std::abs(normal.dot(ray)) / ray.norm());
    }
  plane.z_m[0] = kHole;
  const DepthScene scene = planar_scene(fitted_windows(plane, 20), kCamera);
  for (std::size_t i = 0; i < kCamera.pixels(); ++i) {
    const bool is_in_first_window = i % 80 < 20 && i / 80 < 20;
    EXPECT_EQ(std::isnan(scene.depth.z_m[i]), is_in_first_window) << i;
    if (is_in_first_window) continue;
    EXPECT_NEAR(scene.depth.z_m[i], plane.z_m[i], 1e-9) << i;
    EXPECT_NEAR(scene.cosine[i], cosine[i], 1e-9) << i;
  }
}

TEST(SimulatedFrames, HaveThePublishedNoise) {
  DepthSensorSettings settings = sensor_settings(DepthSensorKind::active_stereo, kCamera);
  settings.disparity_step_px = 0, settings.window_px = 1;
  const auto noise = temporal_noise(simulated_frames(settings, {wall(0.8)}, 40, scenes::kernels()));
  double squares = 0;
  for (const DepthNoise& pixel : noise) squares += pixel.per_m * pixel.per_m;
  const double noise_px = std::sqrt(squares / static_cast<double>(noise.size())) * 100 * 0.05;
  EXPECT_NEAR(noise_px, 0.08, 0.001);
}

TEST(OwnFocalLength, ScalesTheWindow) {
  const DepthSensorSettings settings = sensor_settings(DepthSensorKind::active_stereo, kCamera);
  const Triangulation published = triangulation(settings);
  const Triangulation scaled = triangulation(with_own_focal_length(settings, 62.5));
  EXPECT_EQ(scaled.focal_px, 62.5);
  EXPECT_EQ(scaled.window_px, 11);  // 1.6 * 7 = 11.2
  EXPECT_EQ(scaled.baseline_m, published.baseline_m);
  EXPECT_EQ(triangulation(with_own_focal_length(settings, 100)).window_px, published.window_px);
}

TEST(OwnFocalLength, GivesTheStepsOfTheSensorThatSeesThem) {
  const DepthSensorSettings settings = sensor_settings(DepthSensorKind::structured_light, kCamera);
  DepthImage slope = wall(0);
  for (std::size_t i = 0; i < slope.z_m.size(); ++i)
    slope.z_m[i] = 1 / (0.5 + static_cast<double>(i) / static_cast<double>(slope.z_m.size()));
  const std::vector<DepthImage> frames =
      simulated_frames(with_own_focal_length(settings, 80), {slope}, 1, scenes::kernels());
  EXPECT_NEAR(depth_step_per_m(frames, 0.7, 1.5), 0.125 / (80 * 0.075), 1e-9);
}

class TrueObjects : public testing::Test {
 protected:
  // A sheet of 0.4 m at 0.8 m and a block in front of it, whose front face is at 0.5 m.
  RecordedTruth read() const {
    const std::string sheet = "1 0 0 0 0 1 0 0 0 0 1 0.8 0 0 0 1\n",
                      block = "1 0 0 0 0 1 0 0 0 0 1 0.6 0 0 0 1\n";
    const std::string nowhere = "nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan\n";
    TruthFolder truth;
    truth.objects.push_back(
        {"sheet", folder_ / "sheet.obj", folder_.write("sheet.txt", sheet + nowhere), false});
    truth.objects.push_back(
        {"block", folder_ / "block.obj", folder_.write("block.txt", block + block), true});
    const auto reader = [](const std::filesystem::path& file) {
      if (file.stem() == "block") return box_mesh({0.1, 0.1, 0.2});
      return TriangleMesh{{{-0.2, -0.2, 0}, {0.2, -0.2, 0}, {0.2, 0.2, 0}, {-0.2, 0.2, 0}},
                          {{0, 2, 1}, {0, 3, 2}}};
    };
    return RecordedTruth(truth, std::vector<std::string>(2), 0.03, reader, kCamera);
  }
  const TestFolder folder_{"simulated_sensor_test"};
};

TEST_F(TrueObjects, HaveTheErrorOfTheRecordedDepth) {
  const RecordedTruth truth = read();
  DepthImage recorded = recorded_objects(truth, 0, {}, kCamera).true_depth;
  for (double& z : recorded.z_m) z += z < 0.6 ? 0.004 : -0.001;
  const ObjectImage image = recorded_objects(truth, 0, recorded, kCamera);
  const std::vector<double> on_block = depth_errors_of(image, 1), on_sheet = depth_errors_of(image, 0);
  // The block fills 20 x 20 pixels. Those within 3 of its border are left out.
  EXPECT_EQ(on_block.size(), std::size_t{14 * 14});
  EXPECT_FALSE(on_sheet.empty());
  for (const double error_m : on_block) EXPECT_NEAR(error_m, 0.004, 1e-9);
  for (const double error_m : on_sheet) EXPECT_NEAR(error_m, -0.001, 1e-9);
}

TEST_F(TrueObjects, LeaveOutOtherSurfacesAndObjectsWithoutAPose) {
  const RecordedTruth truth = read();
  EXPECT_TRUE(depth_errors_of(recorded_objects(truth, 0, wall(0.3), kCamera), 1).empty());
  EXPECT_TRUE(depth_errors_of(recorded_objects(truth, 1, wall(0.8), kCamera), 0).empty());
  EXPECT_EQ(depth_errors_of(recorded_objects(truth, 1, wall(0.5), kCamera), 1).size(), std::size_t{14 * 14});
}

TEST_F(TrueObjects, AreMeasuredBySensorsWithoutNoiseAsTheyAre) {
  DepthSensorSettings settings = sensor_settings(DepthSensorKind::active_stereo, kCamera);
  settings.noise_px = 0, settings.disparity_step_px = 0;
  const ObjectImage image = simulated_objects(read(), 0, settings, scenes::kernels());
  for (const int object : {0, 1}) {
    const std::vector<double> errors_m = depth_errors_of(image, object);
    EXPECT_GT(errors_m.size(), 50u);
    for (const double error_m : errors_m) EXPECT_NEAR(error_m, 0, 1e-9);
  }
}

}  // namespace
}  // namespace remote_touch::sensor_comparison_test
