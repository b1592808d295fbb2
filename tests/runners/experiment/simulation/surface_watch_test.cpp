// The notes on a hand that leaves what the camera sees, or flies behind it.
#include "runners/experiment/simulation/surface_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/camera.h"
#include "tests/runners/experiment/simulation/reported_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::surface_watch_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr CameraIntrinsics kCamera{100, 80, 100, 100, 49.5, 39.5};

// A plane in front of the camera, with a depth for each frame. The left half of the image has no measurement.
class MovingPlane final : public Scenario {
 public:
  explicit MovingPlane(std::vector<double> depths_m) : depths_m_(std::move(depths_m)) {}
  double frame_rate_hz() const override { return 10; }
  int frame_count() const override { return static_cast<int>(depths_m_.size()); }
  PointCloud cloud(int frame) const override {
    DepthImage image{kCamera.width, kCamera.height, {}};
    for (int i = 0; i < kCamera.width * kCamera.height; ++i)
      image.z_m.push_back(i % kCamera.width < 50 ? kNaN : depths_m_[static_cast<std::size_t>(frame)]);
    // The camera is at (1, 2, 3) and faces along x.
    RigidTransform X_WC = RigidTransform::Identity();
    X_WC.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    X_WC.translation() = Vec3(1, 2, 3);
    return cloud_from_depth(image, kCamera, X_WC);
  }
  double signed_distance(const Vec3&, double) const override { return kNaN; }

 private:
  const std::vector<double> depths_m_;
};

class Hand final : public Trajectory {
 public:
  explicit Hand(std::optional<SurfacePlan> plan) : plan_(plan) {}
  DeviceState at(double) const override { return {}; }
  double duration_s() const override { return 0; }
  std::optional<SurfacePlan> surface_plan(double) const override { return plan_; }

 private:
  const std::optional<SurfacePlan> plan_;
};

// A point of the camera's frame (x right, y down, z forward), see MovingPlane::cloud().
Vec3 in_world(double x, double y, double z) {
  return {1 + z, 2 + x, 3 + y};
}

constexpr SurfacePlan kTouches{true, -0.006, 0.016, 0.004}, kLifted{false, -0.006, 0.016, 0.004};

// Frames at 0, 0.1, ..., 0.5 s; a tick in the middle of each.
std::vector<Note> watched(const std::vector<double>& depths_m, const std::optional<SurfacePlan>& plan,
                          const Vec3& hand_C) {
  const MovingPlane scene(depths_m);
  const Hand hand(plan);
  SurfaceWatch watch(scene, hand);
  for (std::size_t i = 0; i < depths_m.size(); ++i)
    watch.add(in_world(hand_C.x(), hand_C.y(), hand_C.z()), 0.1 * static_cast<double>(i) + 0.05);
  return watch.notes();
}

TEST(SurfaceWatch, HasNoNoteOnAHandAtTheSurface) {
  EXPECT_EQ(kinds_of(watched({0.5, 0.496, 0.512}, kTouches, {0.1, 0, 0.51})), Kinds{});
}

TEST(SurfaceWatch, ReportsAHandThatFliesBehind) {
  const std::vector<double> depths{0.5, 0.49, 0.45, 0.428, 0.5};
  for (const auto& plan : {kTouches, kLifted}) {
    const std::vector<Note> notes = watched(depths, plan, {0.1, 0, 0.51});
    EXPECT_EQ(kinds_of(notes), Kinds{"behind the surface"});
    // The hand is 20, 60 and 82 mm behind in 3 of 5 ticks; up to 16 mm are planned.
    EXPECT_HAS(notes[0].text, "in 60 % of the ticks, first at 0.15 s, by up to 82 mm; at most 16 mm");
  }
}

TEST(SurfaceWatch, ReportsAHandThatLeavesTheSurface) {
  const Vec3 on_plane(0.1, 0, 0.51), over_hole(-0.1, 0, 0.51), outside(0.4, 0, 0.51),
      behind_camera(0, 0, -0.2);
  const std::vector<double> rests{0.5, 0.5}, recedes{0.5, 0.52};
  EXPECT_EQ(kinds_of(watched(recedes, kLifted, on_plane)), Kinds{});
  EXPECT_HAS(watched(recedes, kTouches, on_plane).at(0).text, "in 50 % of the ticks, first at 0.15 s");
  for (const Vec3& hand : {over_hole, outside, behind_camera}) {
    EXPECT_EQ(kinds_of(watched(rests, kTouches, hand)), Kinds{"off the surface"}) << hand.transpose();
    EXPECT_EQ(kinds_of(watched(rests, kLifted, hand)), Kinds{}) << hand.transpose();
  }
}

// The ray of the hand passes the last measured column at up to 4 mm, which is 0.8 of a pixel: one pixel
// counts.
TEST(SurfaceWatch, BridgesToWhatIsMeasuredNearTheRay) {
  const auto column = [](double u) { return Vec3((u - kCamera.cx) * 0.51 / kCamera.fx, 0, 0.51); };
  EXPECT_EQ(kinds_of(watched({0.5}, kTouches, column(49))), Kinds{});
  EXPECT_EQ(kinds_of(watched({0.5}, kTouches, column(48))), Kinds{"off the surface"});
}

TEST(SurfaceWatch, IgnoresMotionsWithoutAPlan) {
  EXPECT_EQ(kinds_of(watched({0.5, 0.2}, std::nullopt, {0.1, 0, 0.51})), Kinds{});
}

// Steps of 30, 60 and 90 mm; 50 mm are planned. 0: no limit is stated.
TEST(SurfaceWatch, ReportsAHandThatJumps) {
  for (const double max_step_m : {0.05, 0.0}) {
    const MovingPlane scene({0.5});
    const Hand hand(SurfacePlan{false, -1, 1, 0.004, max_step_m});
    SurfaceWatch watch(scene, hand);
    double z = 0.3;
    for (const double step_m : {0.0, 0.03, 0.06, -0.09}) {
      z += step_m;
      watch.add(in_world(0.1, 0, z), z);
    }
    const std::vector<Note> notes = watch.notes();
    if (max_step_m == 0) {
      EXPECT_EQ(kinds_of(notes), Kinds{});
    } else {
      ASSERT_EQ(kinds_of(notes), Kinds{"hand jumped"});
      EXPECT_EQ(
          notes[0].text,
          "the hand jumped by 60 mm at 0.39 s, because its pixel then showed another surface; it jumped 2 "
          "times, by up to 90 mm");
    }
  }
}

// Frames that a camera recorded: depth in units of 0.1 mm, 320 x 240 pixels, at 30 Hz. depth_m: at the ray
// (x, y, 1) of a frame.
void record(const TestFolder& folder, int frames, const std::function<double(int, double, double)>& depth_m) {
  folder.write("camera.json", R"({"width": 320, "height": 240, "fx": 300, "fy": 300, "cx": 159.5, "cy": 119.5,
    "depth_scale_m": 0.0001, "frame_rate_hz": 30})");
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<std::uint16_t> samples;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u)
        samples.push_back(
            static_cast<std::uint16_t>(0.5 + 1e4 * depth_m(frame, (u - 159.5) / 300, (v - 119.5) / 300)));
    folder.write_png("depth/" + std::to_string(frame) + ".png", 320, 240, PNG_FORMAT_LINEAR_Y,
                     samples.data());
  }
}

constexpr const char* kHalf_s = R"("duration_s": 0.5)";

ReportedRun run_on(const std::string& path, const std::string& trajectory, const std::string& rest = "") {
  return run_of(R"({"name": "recording", "path": ")" + path + R"("})", trajectory, rest);
}

// A box of 16 cm before a wall. It comes nearer by 5 cm in frame 10, while the hand follows the first frame.
TEST(SurfaceWatch, ReportsAScanOfASceneThatMoves) {
  const TestFolder folder("moving_box");
  record(folder, 20, [](int frame, double x, double y) {
    const double z = frame < 10 ? 0.6 : 0.55;
    return std::max(std::abs(x), std::abs(y)) * z < 0.08 ? z : 0.8;
  });
  const ReportedRun moved = run_on(folder.path().string(), R"({"name": "image-scan", "row": 120,
    "first_column": 130, "last_column": 190})");
  EXPECT_EQ(moved.kinds(), Kinds{"behind the surface"});
  EXPECT_HAS(moved.report.notes[0].text, "by up to 60 mm; at most 16 mm were planned");
  EXPECT_EQ(run_on(folder.path().string(), R"({"name": "image-press"})", kHalf_s).kinds(),
            Kinds{"frames unused"});
}

// A box before a wall is removed in frame 5. The pixel then sees the wall, which is 0.4 m farther away. The
// hand has nothing to lift off from, and jumps.
TEST(SurfaceWatch, ReportsAPressWhosePixelSeesAnotherPosition) {
  const TestFolder folder("box_taken_away");
  record(folder, 10, [](int frame, double x, double y) {
    return frame < 5 && std::max(std::abs(x), std::abs(y)) * 0.5 < 0.08 ? 0.5 : 0.9;
  });
  const RunReport report =
      run_on(folder.path().string(), R"({"name": "image-press"})", R"("duration_s": 0.31)").report;
  ASSERT_EQ(kinds_of(report.notes), Kinds{"hand jumped"});
  EXPECT_HAS(report.notes[0].text, "jumped by 400 mm at 0.167 s");
  EXPECT_HAS(report.hand, "image-press, row ");
  EXPECT_HAS(report.hand, " at depth 0.500 m");
  EXPECT_HAS(text_of(report), "\n  hand: image-press, row ");
  TextAttributes attributes;
  add_report(attributes, report);
  EXPECT_EQ(attribute(attributes, "hand"), report.hand);
}

// A mug as one cloud: an organised cloud is scanned without a note, and an unorganised one is refused in one
// line.
TEST(SurfaceWatch, HasNoNoteOnAScanOfOneCloudOfAMug) {
  const TestFolder folder("mug");
  const auto write = [&](const char* name, bool is_organised) {
    std::string points;
    int count = 0;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u) {
        const double x = (u - 159.5) / 300, y = (v - 119.5) / 300, a = x * x + 1;
        const double z = (0.54 - std::sqrt(0.54 * 0.54 - a * (0.54 * 0.54 - 0.04 * 0.04))) / a;
        const bool is_seen = std::abs(z * y) < 0.05;  // a half cylinder, front at 0.5 m
        if (!is_seen && !is_organised) continue;
        char line[80];
        std::snprintf(line, sizeof line, "%.6f %.6f %.6f\n", x * z, y * z, z);
        points += is_seen ? line : "nan nan nan\n";
        ++count;
      }
    const std::string size =
        is_organised ? "WIDTH 320\nHEIGHT 240\n" : "WIDTH " + std::to_string(count) + "\nHEIGHT 1\n";
    return folder
        .write(name, "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + size +
                         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(count) + "\nDATA ascii\n" +
                         points)
        .string();
  };
  EXPECT_EQ(run_on(write("image.pcd", true), R"({"name": "image-scan"})").kinds(), Kinds{});
  const std::string unorganised = write("points.pcd", false);
  EXPECT_HAS(refusal([&] { run_on(unorganised, R"({"name": "image-scan"})"); }), "are not images");
  EXPECT_HAS(refusal([&] { run_on(unorganised, R"({"name": "image-press"})", kHalf_s); }), "are not images");
}

}  // namespace
}  // namespace remote_touch::surface_watch_test
