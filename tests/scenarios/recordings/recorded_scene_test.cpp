// The scene of a recording: its true surface, the layout of its frames, the depth limit and the rates; and
// which points a mask of its images selects.
#include "scenarios/recordings/recorded_scene.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/points/vector.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::image_mask_test {
namespace {

namespace fs = std::filesystem;
using Shares = std::vector<double>;

PointCloud image(int width, int height) {
  PointCloud cloud;
  cloud.image = ImageLayout{{width, height, 10, 10, 0, 0}, RigidTransform::Identity(), 0};
  for (int i = 0; i < width * height; ++i) cloud.append({0.1 * i, 0, 1});
  return cloud;
}

ImageMask::Settings settings(const fs::path& file) {
  ImageMask::Settings settings;
  settings.path = file.string();
  return settings;
}

Shares weights(const fs::path& file, const PointCloud& cloud) {
  return ImageMask(settings(file)).weights(cloud);
}

// A partly transparent pixel selects by its colour, like an opaque one.
TEST(ImageMask, SelectsPixelsThatAreNeitherBlackNorTransparentRowByRow) {
  const TestFolder folder("image_mask_test");
  const std::uint8_t grey[] = {0, 255, 0, 1, 0, 128}, rgb[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                     rgba[] = {0, 0, 0, 255, 9, 0, 0, 0, 9, 0, 0, 1};
  EXPECT_EQ(weights(folder.write_png("3x2.png", 3, 2, PNG_FORMAT_GRAY, grey), image(3, 2)),
            (Shares{0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(weights(folder.write_png("2x3.png", 2, 3, PNG_FORMAT_GRAY, grey), image(2, 3)),
            (Shares{0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(weights(folder.write_png("rgb.png", 2, 2, PNG_FORMAT_RGB, rgb), image(2, 2)),
            (Shares{0, 1, 1, 1}));
  EXPECT_EQ(weights(folder.write_png("rgba.png", 3, 1, PNG_FORMAT_RGBA, rgba), image(3, 1)),
            (Shares{0, 0, 1}));
}

TEST(ImageMask, IsRefusedIfItDoesNotFitOrCannotBeRead) {
  const TestFolder folder("image_mask_test");
  const std::uint8_t grey[6] = {};
  const std::uint16_t deep[2] = {0, 1};
  const fs::path mask = folder.write_png("grey.png", 3, 2, PNG_FORMAT_GRAY, grey),
                 text = folder.write("text.png", "no image at all"), missing = folder / "missing.png",
                 depth = folder.write_png("depth.png", 2, 1, PNG_FORMAT_LINEAR_Y, deep);
  const auto why = [](const fs::path& file, const PointCloud& cloud) {
    return refusal([&] { weights(file, cloud); });
  };
  for (const std::pair<int, int>& size : {std::pair{2, 3}, {6, 1}, {3, 3}, {4, 2}})
    EXPECT_EQ(why(mask, image(size.first, size.second)),
              mask.string() + ": 3 x 2 pixels: expected as many as the frames: " +
                  std::to_string(size.first) + " x " + std::to_string(size.second));
  PointCloud no_image = image(3, 2);
  no_image.image.reset();
  EXPECT_HAS(why(mask, no_image), "image-mask: the frame is not an image");
  EXPECT_HAS(why(missing, no_image), missing.string() + ": no such recording");
  EXPECT_THROW(ImageMask{settings(missing)}, MissingInput);
  for (const fs::path& file : {text, depth}) EXPECT_HAS(why(file, no_image), file.string() + ": ");
  EXPECT_HAS(validate(ImageMask::Settings{}), "path = \"\": expected a PNG file");
}

}  // namespace
}  // namespace remote_touch::image_mask_test

namespace remote_touch::recorded_scene_test {
namespace {

constexpr int kSide = 16;

class RecordedSceneTest : public testing::Test {
 protected:
  const TestFolder folder_{"recorded_scene_test"};
};

// Writes the camera of images of 3 x 2 pixels into this folder of the test's folder.
void write_camera(const TestFolder& folder, const std::string& rate_hz, const std::string& below = "") {
  folder.write(below + "camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 10, "cx": 1, "cy": 0.5,
                                      "depth_scale_m": 0.001, "frame_rate_hz": )" +
                                          rate_hz + "}");
}

// Two walls: 0.5 m away in columns 0 to 8, and 0.7 m away from column 9 on.
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

// Returns the position that pixel (u, v) sees at depth z.
Vec3 seen(double u, double v, double z) {
  return {(u - 7.5) / 100 * z, (v - 7.5) / 100 * z, z};
}

TEST_F(RecordedSceneTest, KnowsTheSurfaceExceptAtDepthEdges) {
  const RecordedScene scene(two_walls(folder_), {}, scenes::kernels());
  EXPECT_NEAR(scene.signed_distance(seen(4, 8, 0.49), 0), 0.01, 1e-12);
  EXPECT_NEAR(scene.signed_distance(seen(4, 8, 0.52), 0), -0.02, 1e-12);
  EXPECT_NEAR(scene.signed_distance(seen(13, 8, 0.69), 0), 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(scene.signed_distance(seen(9, 8, 0.5), 0)));
  EXPECT_EQ(scene.truth_time_s(0.03), 0) << "a slave must not take the step from frame to frame for a motion";
}

// Depth edges are found in the camera's depth and not in the base frame's z, which may be negative or lie in
// the wall.
TEST_F(RecordedSceneTest, KnowsTheSameSurfaceForAnyCameraPose) {
  RecordedScene::Settings settings = two_walls(folder_);
  const RecordedScene as_recorded(settings, {}, scenes::kernels());
  for (const Vec3& turn : {Vec3(180, 0, 0), Vec3(0, 90, 0), Vec3(-90, 0, 0), Vec3(30, 40, 50)})
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1, -2, -3), Vec3(0, 0, 2)}) {
      settings.camera_rotation_deg = turn, settings.camera_position_m = place;
      const RecordedScene moved(settings, {}, scenes::kernels());
      const RigidTransform X_WC(Eigen::Translation3d(place) * rotation(kRadiansPerDegree * turn));
      for (int u = 0; u < kSide; ++u)
        for (const double z : {0.48, 0.51, 0.53, 0.7}) {  // not 0.5: the patch would be just 2 pixels wide
          const Vec3 p_C = seen(u, 8, z);
          const double expected = as_recorded.signed_distance(p_C, 0),
                       got = moved.signed_distance(X_WC * p_C, 0);
          ASSERT_EQ(std::isnan(got), std::isnan(expected)) << "column " << u << " at " << z;
          if (std::isnan(expected)) continue;
          EXPECT_NEAR(got, expected, 1e-9);
        }
    }
}

// A sloping wall in 4 x 3 pixels, seen from (0, 0, 2) against the z axis. The points keep the coordinates of
// the file.
TEST_F(RecordedSceneTest, HasItsCameraAtTheViewpointOfAPcdFile) {
  std::string pcd = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", "4", "3", "12", "ascii");
  pcd = seen_from(pcd, "0 0 2 0 1 0 0");
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
  settings.path = folder_.write("x.pcd", pcd).string();
  settings.camera_position_m = {0, 1, 0};  // origin of the file's coordinates in the base frame
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

TEST_F(RecordedSceneTest, EveryViewpointThatIsNotUsedIsReported) {
  const std::string at_origin = organised_pcd({16, 12, 20, 25, 7.25, 5.5}, 0);
  const std::string elsewhere = seen_from(at_origin, "0 0.5 -2 1 0 0 0");
  folder_.write("r/0.pcd", at_origin), folder_.write("r/1.pcd", elsewhere),
      folder_.write("r/2.pcd", elsewhere);
  RecordedScene::Settings settings;
  settings.path = (folder_ / "r").string();
  const RecordedScene scene(settings, {}, scenes::kernels());
  for (const int frame : {0, 1, 1, 2}) scene.cloud(frame);
  const std::vector<Note> notes = scene.input_notes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].kind, "viewpoint unused");
  EXPECT_EQ(notes[0].text, settings.path +
                               ": the VIEWPOINT of 2 of 3 files is not used: seen from there their points "
                               "form no image");
}

// Points at NaN, at infinity or farther away than any room, as those of a map, cannot be touched, so such a
// first frame is refused. A single far point is not.
TEST_F(RecordedSceneTest, AFirstFrameWithoutUsablePointsIsRefused) {
  RecordedScene::Settings settings;
  const auto refused = [&] { return refusal([&] { RecordedScene(settings, {}, scenes::kernels()); }); };
  const auto of_points = [&](const std::string& points, const char* width, const char* height) {
    const std::string header = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", width, height, "4", "ascii");
    settings.path = folder_.write("x.pcd", header + points).string();
    return refused();
  };
  const auto four = [](const std::string& point) { return point + point + point + point; };
  const std::string nowhere = "x.pcd: its first frame has no point within 10000",
                    far_away = "x.pcd: frame 0 has all its points more than 1000 m from the origin",
                    of_map = "1001 0 1\n1001 1 1\n1002 0 1\n1002 1 1\n";
  const std::pair<std::string, std::string> rows[] = {
      {four("nan nan nan\n"), nowhere},
      {four("inf inf inf\n"), nowhere},
      {four("-inf -inf -inf\n"), nowhere},
      {four("1e30 1e30 1e30\n"), far_away},
      {of_map, far_away},
      {"0 0 1\n" + of_map.substr(of_map.find('\n') + 1), "no InputError"}};
  for (const auto& [points, text] : rows) {
    EXPECT_HAS(of_points(points, "2", "2"), text);
    EXPECT_HAS(of_points(points, "4", "1"), text);
  }
  settings.camera_position_m = Vec3(-2, 0, 0);  // the limit is for the cloud in its own coordinates, too
  EXPECT_HAS(of_points(of_map, "2", "2"), far_away);
  write_camera(folder_, "20", "empty/");
  settings = {};
  settings.path = (folder_ / "empty").string();
  for (const auto& [unit, text] :
       {std::pair(std::uint16_t{0},
                  "its first frame has no point within scenario.max_depth_m = 3.000000: 1 read: 0 % "
                  "of 6 points measured, without colours: expected a frame of measured points, in "
                  "metres"),
        {std::uint16_t{5000},
         "depth 5 to 5 m, without colours: expected a frame of measured points, in metres; the "
         "depth scale may be wrong"}}) {
    const std::vector<std::uint16_t> units(6, unit);
    folder_.write_png("empty/depth/0000.png", 3, 2, PNG_FORMAT_LINEAR_Y, units.data());
    EXPECT_HAS(refused(), text);
  }
}

// Writes a plane 0.5 m away in columns x rows pixels of a camera with a focal length of 100 px. With one row
// the points are in no order.
void write_plane(const TestFolder& folder, const std::string& name, int columns, int rows) {
  const std::string count = std::to_string(columns * rows);
  std::string pcd = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", std::to_string(columns),
                               std::to_string(rows), count, "ascii");
  for (int i = 0; i < columns * rows; ++i)
    pcd += std::to_string((i % columns - 2) * 0.005) + " " + std::to_string((i / columns - 2) * 0.005) +
           " 0.5\n";
  folder.write(name, pcd);
}

RecordedScene::Settings recording_in(const TestFolder& folder) {
  RecordedScene::Settings settings;
  settings.path = folder.path().string();
  return settings;
}

TEST_F(RecordedSceneTest, AFrameOfAnotherSizeIsRefusedByItsName) {
  write_plane(folder_, "1.pcd", 8, 6), write_plane(folder_, "2.pcd", 4, 3),
      write_plane(folder_, "3.pcd", 48, 1);
  RecordedScene::Settings settings = recording_in(folder_);
  const RecordedScene scene(settings, {}, scenes::kernels());
  EXPECT_EQ(refusal([&] { scene.cloud(1); }),
            (folder_ / "2.pcd").string() +
                ": has 4 x 3 points: expected 8 x 6 points, as the first frame "
                "that is used has");
  EXPECT_HAS(refusal([&] { scene.points(2); }), (folder_ / "3.pcd").string() + ": has points in no order");
  settings.first_frame = 1, settings.last_frame = 1;
  EXPECT_TRUE(RecordedScene(settings, {}, scenes::kernels()).cloud(0).image) << "alone it can be used";
}

// The axes are those of a lidar, x forward and z up. No point above 3 m may be lost, and a limit that the
// user has set is refused, because it cannot apply.
TEST_F(RecordedSceneTest, CloudsWithoutACameraAreNotCut) {
  folder_.write("1.pcd", xyz_header("3", "ascii") + "2 0 -1\n2 0 3.5\n2 0 -0.5\n");
  RecordedScene::Settings settings = recording_in(folder_);
  const RecordedScene scene(settings, {}, scenes::kernels());
  EXPECT_EQ(scene.cloud(0).z[1], 3.5);
  EXPECT_EQ(scene.points(0)->size(), 3u);
  EXPECT_HAS(scene.input(),
             "z -1 to 3.5 m, without colours; no camera, so that scenario.max_depth_m does not apply");
  EXPECT_TRUE(scene.input_notes().empty());
  settings.max_depth_m = 1;
  EXPECT_HAS(refusal([&] { RecordedScene(settings, {}, scenes::kernels()); }),
             "its points form no camera image and have no depth: expected scenario.max_depth_m = 3");
}

// Writes the same image for each of these times.
void write_stamped(const TestFolder& folder, const std::vector<std::string>& stamps) {
  write_camera(folder, "30");
  std::string list;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    folder.write_depth("depth/" + std::to_string(i) + ".png", 1000);
    list += stamps[i] + " depth/" + std::to_string(i) + ".png\n";
  }
  folder.write("depth.txt", list);
}

Kinds note_kinds_of(const RecordedScene& scene) {
  for (int i = 0; i < 4; ++i) scene.cloud(i);
  return kinds_of(scene.input_notes());
}

TEST_F(RecordedSceneTest, StampsInMillisecondsAreReportedWhereTheyAreUsed) {
  RecordedScene::Settings settings = recording_in(folder_);
  const auto scene = [&] { return RecordedScene(settings, {}, scenes::kernels()); };
  write_stamped(folder_, {"0", "33", "66", "100"});
  EXPECT_EQ(note_kinds_of(scene()), std::vector<std::string>{"unusual rate"});
  EXPECT_HAS(scene().input_notes().back().text,
             "0.0303 Hz: stamps are read as seconds, these may be milliseconds");
  EXPECT_HAS(scene().input(), " at 0.03 Hz, 3 x 2 pixels");
  settings.frame_rate_hz = 30;
  EXPECT_TRUE(note_kinds_of(scene()).empty());
  EXPECT_HAS(scene().input(), " at 30 Hz (recorded at 0.03 Hz), 3 x 2 pixels");
  settings.frame_rate_hz = 0;
  write_stamped(folder_, {"0", "0.033", "0.066", "100"});
  EXPECT_TRUE(note_kinds_of(scene()).empty()) << "one long pause";
  EXPECT_HAS(scene().input(), " at 30.303 Hz with pauses of up to 99.934 s (0.03 Hz on average)");
  EXPECT_EQ(scene().newest_frame(99.9), 2);
  EXPECT_EQ(scene().newest_frame(100.1), 3);
}

// camera.json states its rate in hertz, so no number is read as a stamp.
TEST_F(RecordedSceneTest, ARateThatIsGivenIsNotDoubted) {
  for (const char* rate : {"0.5", "1200", "1e-9"}) {
    write_camera(folder_, rate);
    folder_.write_depth("depth/0.png", 1000);
    EXPECT_TRUE(note_kinds_of(RecordedScene(recording_in(folder_), {}, scenes::kernels())).empty()) << rate;
  }
}

TEST_F(RecordedSceneTest, FramesThatWereNotUsedAreReportedForEveryPlayback) {
  write_stamped(folder_, {"0", "0.1", "0.2", "0.3"});
  RecordedScene::Settings settings = recording_in(folder_);
  const auto text_after = [&](const std::vector<int>& used) {
    const RecordedScene scene(settings, {}, scenes::kernels());
    for (const int frame : used) scene.cloud(frame);
    const std::vector<Note> notes = scene.input_notes();
    return notes.empty() ? std::string() : notes.front().text.substr(notes.front().text.find(": ") + 2);
  };
  for (const auto playback :
       {RecordedScene::Playback::hold, RecordedScene::Playback::loop, RecordedScene::Playback::ping_pong}) {
    settings.playback = playback;
    EXPECT_EQ(text_after({0, 1}), "2 of 4 frames were not used: the run ended before them");
    EXPECT_EQ(text_after({0, 1, 2, 3}), "");
    EXPECT_EQ(text_after({0, 3}),
              "2 of 4 frames were not used: newer frames replaced them, or they were lost");
    EXPECT_EQ(
        text_after({0, 2}),
        "2 of 4 frames were not used: the run ended before 1 of them; newer frames replaced the others, or "
        "they were lost");
  }
}

}  // namespace
}  // namespace remote_touch::recorded_scene_test
