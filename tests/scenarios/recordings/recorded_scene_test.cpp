// What a recording tells of the true surface, wherever its camera stands.
#include "scenarios/recordings/recorded_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/rotation.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::recorded_scene_test {
namespace {

constexpr int kSide = 16;

// A wall 0.5 m away, and from column 9 on one 0.7 m away.
RecordedScene::Settings two_walls(const TestFolder& folder) {
  std::vector<std::uint16_t> samples;
  for (int i = 0; i < kSide * kSide; ++i) samples.push_back(i % kSide < 9 ? 500 : 700);
  folder.write_png("depth/0000.png", kSide, kSide, PNG_FORMAT_LINEAR_Y, samples.data());
  folder.write("camera.json", R"({"width": 16, "height": 16, "fx": 100, "fy": 100, "cx": 7.5, "cy": 7.5,
                                  "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  RecordedScene::Settings settings;
  settings.path = folder.path().string();
  settings.truth_radius_m = 0.0105;
  return settings;
}

// Where pixel (u, v) looks, so far away.
Vec3 seen(double u, double v, double z) {
  return {(u - 7.5) / 100 * z, (v - 7.5) / 100 * z, z};
}

TEST(RecordedSceneTest, KnowsTheSurfaceButForDepthEdges) {
  const TestFolder folder("recorded_scene_test");
  const RecordedScene scene(two_walls(folder), {}, scenes::kernels());
  EXPECT_NEAR(scene.signed_distance(seen(4, 8, 0.49), 0), 0.01, 1e-12);
  EXPECT_NEAR(scene.signed_distance(seen(4, 8, 0.52), 0), -0.02, 1e-12);
  EXPECT_NEAR(scene.signed_distance(seen(13, 8, 0.69), 0), 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(scene.signed_distance(seen(9, 8, 0.5), 0)));
}

// Depth edges are those of the camera, not of the base frame's z, which may be negative or lie in the wall.
TEST(RecordedSceneTest, KnowsTheSameWhereverItsCameraStands) {
  const TestFolder folder("recorded_scene_test");
  RecordedScene::Settings settings = two_walls(folder);
  const RecordedScene as_recorded(settings, {}, scenes::kernels());
  for (const Vec3& turn : {Vec3(180, 0, 0), Vec3(0, 90, 0), Vec3(-90, 0, 0), Vec3(30, 40, 50)})
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1, -2, -3), Vec3(0, 0, 2)}) {
      settings.camera_rotation_deg = turn, settings.camera_position_m = place;
      const RecordedScene moved(settings, {}, scenes::kernels());
      const RigidTransform X_WC(Eigen::Translation3d(place) * rotation(kRadiansPerDegree * turn));
      for (int u = 0; u < kSide; ++u)
        for (const double z : {0.48, 0.51, 0.53, 0.7}) {  // at 0.5 the patch is 2 pixels wide to the last bit
          const Vec3 p_C = seen(u, 8, z);
          const double expected = as_recorded.signed_distance(p_C, 0),
                       got = moved.signed_distance(X_WC * p_C, 0);
          ASSERT_EQ(std::isnan(got), std::isnan(expected)) << "column " << u << " at " << z;
          if (std::isnan(expected)) continue;
          EXPECT_NEAR(got, expected, 1e-9);
        }
    }
}

// A sloping wall in 4 x 3 pixels, seen from (0, 0, 2) against the z axis: the coordinates stay those of the
// file.
TEST(RecordedSceneTest, HasItsCameraAtTheViewpointOfAPcdFile) {
  const TestFolder folder("recorded_scene_test");
  std::string pcd = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", "4", "3", "12", "ascii");
  const std::string at_origin = "VIEWPOINT 0 0 0 1 0 0 0";
  pcd.replace(pcd.find(at_origin), at_origin.size(), "VIEWPOINT 0 0 2 0 1 0 0");
  const auto point = [](int u, int v) {
    const double depth = 1.5 + 0.05 * u;
    return Vec3((u - 1.5) / 100 * depth, -(v - 1) / 100.0 * depth, 2 - depth);
  };
  for (int i = 0; i < 12; ++i) {
    const Vec3 p = point(i % 4, i / 4);
    for (const double value : {p.x(), p.y(), p.z()}) pcd += std::to_string(value) + " ";
    pcd += "\n";
  }
  RecordedScene::Settings settings;
  settings.path = folder.write("x.pcd", pcd).string();
  settings.camera_position_m = {0, 1, 0};  // of the file, registered in the base frame
  settings.truth_radius_m = 0.03;          // the wall is steep
  const RecordedScene scene(settings, {}, scenes::kernels());
  const PointCloud cloud = scene.cloud(0);
  EXPECT_TRUE(cloud.point(6).isApprox(point(2, 1) + Vec3(0, 1, 0), 1e-6));
  ASSERT_TRUE(cloud.image);
  EXPECT_TRUE(cloud.image->X_WC.translation().isApprox(Vec3(0, 1, 2)));
  const Vec3 to_viewpoint = (Vec3(0, 0, 2) - point(2, 1)).normalized();
  EXPECT_GT(scene.signed_distance(cloud.point(6) + 0.01 * to_viewpoint, 0), 0.001);
  EXPECT_LT(scene.signed_distance(cloud.point(6) - 0.01 * to_viewpoint, 0), -0.001);
}

// NaN, infinity and what is farther than any room: nothing to touch, which is said at once.
TEST(RecordedSceneTest, AFirstFrameOfNothingIsRefused) {
  const TestFolder folder("recorded_scene_test");
  RecordedScene::Settings settings;
  for (const char* value : {"nan", "inf", "1e30", "-inf"}) {
    std::string rows;
    for (int i = 0; i < 4; ++i) rows += std::string(value) + " " + value + " " + value + "\n";
    for (const char* height : {"2", "1"}) {
      const char* width = *height == '2' ? "2" : "4";
      settings.path =
          folder
              .write("x.pcd",
                     pcd_header("x y z", "4 4 4", "F F F", "1 1 1", width, height, "4", "ascii") + rows)
              .string();
      EXPECT_HAS(refusal([&] { RecordedScene(settings, {}, scenes::kernels()); }),
                 "x.pcd: its first frame has no point within scenario.max_depth_m = 3")
          << value;
    }
  }
  folder.write_png("empty/depth/0000.png", 3, 2, PNG_FORMAT_LINEAR_Y, std::vector<std::uint16_t>(6).data());
  folder.write("empty/camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 10, "cx": 1, "cy": 0.5,
                                        "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  settings.path = (folder / "empty").string();
  EXPECT_HAS(refusal([&] { RecordedScene(settings, {}, scenes::kernels()); }),
             "its first frame has no point");
}

// A cloud in the coordinates of a map is refused. A single far point is not.
TEST(RecordedSceneTest, ASceneFarFromTheOriginIsRefused) {
  const TestFolder folder("recorded_scene_test");
  RecordedScene::Settings settings;
  const std::string far = "1001 0 1\n1001 1 1\n1002 0 1\n1002 1 1\n";
  const auto problem = [&](const std::string& rows) {
    settings.path =
        folder.write("x.pcd", pcd_header("x y z", "4 4 4", "F F F", "1 1 1", "2", "2", "4", "ascii") + rows)
            .string();
    return refusal([&] {
      RecordedScene(settings, {}, scenes::kernels());
      throw InputError("read");
    });
  };
  EXPECT_HAS(problem(far), "x.pcd: frame 0 has all its points farther than 1000 m from the origin");
  EXPECT_EQ(problem("0 0 1\n" + far.substr(far.find('\n') + 1)), "read");
  settings.camera_position_m = Vec3(-2, 0, 0);  // the limit is for the cloud in its own coordinates, too
  EXPECT_HAS(problem(far), "farther than 1000 m");
}

}  // namespace
}  // namespace remote_touch::recorded_scene_test
