// Recordings and scenarios that --depth names, in real time on a simulated clock.
#include "runners/live/sensors/sensor_table.h"

#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/clock.h"
#include "runners/live/sensors/depth_source.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sensor_table_test {
namespace {

// The pause of 5 s between the third frame and the fourth is kept, there and back.
TEST(SensorTable, ARecordingIsPlayedAtTheTimesOfItsStampsAndAsTheScenario) {
  const TestFolder folder("sensor_table");
  folder.write("camera.json", R"({"width": 32, "height": 24, "fx": 30, "fy": 30, "cx": 15.5, "cy": 11.5,
    "depth_scale_m": 0.001, "frame_rate_hz": 30})");
  folder.write("depth.txt",
               "100.000 depth/0.png\n100.033 depth/1.png\n100.067 depth/2.png\n105.100 depth/3.png\n");
  const std::vector<std::uint16_t> samples(32 * 24, 500);
  for (const char* name : {"depth/0.png", "depth/1.png", "depth/2.png", "depth/3.png"})
    folder.write_png(name, 32, 24, PNG_FORMAT_LINEAR_Y, samples.data());
  const Experiment experiment =
      Experiment::from_json(R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
                                R"(", "max_depth_m": 20}, "renderer": {"name": "proxy"},
          "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0.3, 0]]}})",
                            "test");
  SimulatedClock clock;
  const auto open = [&](const std::string& uri) {
    return open_sensor(uri, {experiment, scenes::kernels(), clock});
  };
  const auto sensor = open("tum:" + folder.path().string());
  SensorFrame frame;
  int number = 0;
  for (const double due_s : {0.0, 0.033, 0.067, 5.1, 10.133, 10.167, 10.2}) {
    while (sensor->next(frame, 0.001) == SensorState::waiting) continue;
    EXPECT_EQ(frame.number, number++);
    EXPECT_NEAR(frame.captured_s, due_s, 1e-6);
  }
  EXPECT_EQ(open("sim:")->view().metres_per_unit, 5e-4) << "65535 units of 0.2 mm are 13.1 m";
}

// Frames of scenarios as one sensor sends them: decoding gives the same points, or a refusal names the frame.

constexpr CameraIntrinsics kCamera{16, 12, 20, 21, 7.3, 5.6};

RigidTransform pose() {
  return RigidTransform(Eigen::Translation3d(0.1, 0.4, -0.2) * rotation(Vec3(0.3, -0.2, 0.5)));
}

// A wall across the axis of the camera; pixel 5 is a hole.
PointCloud wall(double depth_m, const CameraIntrinsics& camera = kCamera,
                const RigidTransform& X_WC = pose()) {
  DepthImage depth{camera.width, camera.height, {}};
  depth.z_m.assign(camera.pixels(), depth_m);
  depth.z_m[5] = std::nan("");
  return cloud_from_depth(depth, camera, X_WC);
}

PointCloud grid(int columns, bool has_normals = false) {
  PointCloud cloud;
  for (int i = 0; i < 12; ++i)
    has_normals ? cloud.append(Vec3(0.1 * i, 0, 0.3), Vec3::UnitZ()) : cloud.append(Vec3(0.1 * i, 0, 0.3));
  cloud.grid_columns = columns;
  return cloud;
}

PointCloud decoded(const FrameEncoder& encoder, const PointCloud& cloud) {
  SensorFrame frame;
  encoder.encode(cloud, 3, frame);
  EXPECT_TRUE(is_complete(frame, encoder.view()));
  return cloud_of(frame, encoder.view(), encoder.view().X_WC);
}

double largest_error_m(const PointCloud& a, const PointCloud& b) {
  double error_m = 0;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    EXPECT_EQ(a.is_measured(i), b.is_measured(i)) << i;
    if (a.is_measured(i)) error_m = std::max(error_m, (a.point(i) - b.point(i)).norm());
  }
  return error_m;
}

std::string problem_of(const PointCloud& first, const PointCloud& later) {
  const FrameEncoder encoder({.name = "./scene"}, first);
  SensorFrame frame;
  return refusal([&] { encoder.encode(later, 3, frame); });
}

// Half a unit of depth, along the longest ray of this camera: |(16 / 20, 12 / 21, 1)| < 1.5.
double tolerance_m(const FrameEncoder& encoder) {
  return 0.75 * encoder.view().metres_per_unit + 1e-12;
}

// 65535 units of 0.1, 0.2, 0.5, 1 and 2 mm are 6.55, 13.1, 32.8, 65.5 and 131 m. A depth below one unit is
// rounded up to it, so that it stays measured.
TEST(FrameEncoder, SendsDepthsInTheLeastUnitThatReachesTheMaximum) {
  for (const auto& [max_depth_m, first_m, unit_m] : {std::tuple{3.0, 0.5, 1e-4},
                                                     {0.0, 6.5, 1e-4},
                                                     {6.6, 0.5, 2e-4},
                                                     {3.0, 7.0, 2e-4},
                                                     {20.0, 0.5, 5e-4},
                                                     {40.0, 0.5, 1e-3},
                                                     {100.0, 0.5, 2e-3},
                                                     {0.0, 130.0, 2e-3}}) {
    const FrameEncoder encoder({.max_depth_m = max_depth_m}, wall(first_m));
    EXPECT_EQ(encoder.view().metres_per_unit, unit_m) << max_depth_m << ", " << first_m;
    EXPECT_FALSE(encoder.view().cloud);
    for (const double depth_m : {0.00003, 0.41237, std::max(max_depth_m, first_m)}) {
      const double rounded_up_m = depth_m < unit_m ? 1.5 * unit_m : 0;
      EXPECT_LE(largest_error_m(decoded(encoder, wall(depth_m)), wall(depth_m)),
                tolerance_m(encoder) + rounded_up_m);
    }
  }
  EXPECT_EQ(FrameEncoder({.unit_m = 1e-3}, wall(0.5)).view().metres_per_unit, 1e-3);
}

TEST(FrameEncoder, RefusesFramesThatTheSensorOfTheFirstOneCannotSend) {
  const RigidTransform shifted = pose() * Eigen::Translation3d(0, 0, 0.2);
  const RigidTransform turned(pose() * rotation(Vec3(0, kRadiansPerDegree, 0)));
  CameraIntrinsics wider = kCamera;
  wider.fx = 10, wider.fy = 10.5;
  PointCloud shuffled = wall(0.4), regions = grid(0), stiff = grid(0);
  shuffled.image.reset();
  std::reverse(shuffled.x.begin(), shuffled.x.end());
  regions.fixture_radius_m.assign(12, 0.01), stiff.stiffness_N_per_m.assign(12, 100);
  struct Refused {
    PointCloud first, later;
    const char* message;
  };
  for (const auto& [first, later, message] :
       {Refused{wall(0.5), wall(7),
                "has a point at a depth of 7 m: expected at most 6.5535 m, 65535 units of 0.1 mm"},
        Refused{wall(0.5), wall(-0.5), "has a point behind its camera"},
        Refused{wall(0.4), wall(0.4, kCamera, shifted),
                "was captured from another pose (0.2 m and 0 deg from the first frame)"},
        Refused{wall(0.4), wall(0.4, kCamera, turned), "(0 m and 1 deg from the first frame)"},
        Refused{wall(0.4), wall(0.4, wider), "has another camera than the first frame"},
        Refused{wall(0.4), wall(0.4, {16, 6, 20, 21, 7.3, 5.6}),
                "has 16 x 6 pixels: expected 16 x 12 pixels"},
        Refused{wall(0.4), shuffled, "has another camera"},
        Refused{wall(0.4), grid(0), "has 12 points: expected 16 x 12 pixels"},
        Refused{grid(4), grid(0),
                "has no rows and columns: expected rows of 4 points, as the first frame has"},
        Refused{grid(0), grid(4), "has rows of 4 points: expected no rows and columns"},
        Refused{grid(4), grid(3), "has rows of 3 points: expected rows of 4 points"},
        Refused{grid(4), wall(0.4), "has rows of 16 points"},
        Refused{grid(0), grid(0, true), "has normals, and the first frame has no normals"},
        Refused{grid(0, true), grid(0), "has no normals, and the first frame has normals"},
        Refused{grid(0), regions, "has forbidden regions or stiffnesses of its own"},
        Refused{grid(0), stiff, "has forbidden regions or stiffnesses of its own"}}) {
    const std::string problem = problem_of(first, later);
    EXPECT_TRUE(problem.starts_with("./scene: frame 3 ")) << problem;
    EXPECT_HAS(problem, message);
  }
  // The fit of a pinhole to the points of a frame may differ by less than a pixel.
  CameraIntrinsics fitted = kCamera;
  fitted.fx *= 1.01, fitted.cx += 0.01;
  EXPECT_EQ(problem_of(wall(0.4), wall(0.4, fitted)), "no InputError");
  EXPECT_EQ(problem_of(grid(4), grid(4)), "no InputError");
}

// Recordings have depth images to which no colour image belongs.
TEST(FrameEncoder, SendsColoursIfTheFirstFrameHasSome) {
  for (const PointCloud& plain : {wall(0.4), grid(0)}) {
    PointCloud coloured = plain;
    coloured.colour.assign(plain.size(), 0x123456);
    EXPECT_EQ(decoded(FrameEncoder({}, coloured), coloured).colour, coloured.colour);
    EXPECT_EQ(decoded(FrameEncoder({}, coloured), plain).colour,
              std::vector<std::uint32_t>(plain.size(), kNoColour));
    EXPECT_TRUE(decoded(FrameEncoder({}, plain), coloured).colour.empty());
  }
}

// A rule by hue finds nothing in a frame without colours, which would leave a region out.
TEST(FrameEncoder, RefusesAFrameThatTheRulesCannotUse) {
  PointCloud coloured = wall(0.4);
  coloured.colour.assign(coloured.size(), 0x123456);
  const auto require = [](const PointCloud& cloud) {
    if (cloud.colour.empty()) throw InputError("fixtures.0", "needs colours");
  };
  const FrameEncoder encoder({.require = require}, coloured);
  SensorFrame frame;
  encoder.encode(coloured, 0, frame);
  EXPECT_HAS(refusal([&] { encoder.encode(wall(0.4), 1, frame); }), "fixtures.0: needs colours");
}

// No point was measured, so no point can be at a wrong position.
TEST(FrameEncoder, AFrameWithoutMeasuredPointsFitsEveryView) {
  PointCloud holes = grid(4);
  holes.x.assign(12, std::nan(""));
  for (const PointCloud& nothing : {PointCloud{}, holes}) {
    const PointCloud image = decoded(FrameEncoder({}, wall(0.4)), nothing);
    EXPECT_EQ(image.size(), 192u);
    for (std::size_t i = 0; i < image.size(); ++i) EXPECT_FALSE(image.is_measured(i));
    EXPECT_EQ(decoded(FrameEncoder({}, grid(0)), nothing).size(), 0u);
  }
}

// A lens bends the rays by up to 3 px. The points of a pinhole image would be at other positions.
TEST(FrameEncoder, SendsAnImageThatIsNoPinholesAsPoints) {
  PointCloud bent = wall(0.4);
  for (std::size_t i = 0; i < bent.size(); ++i) bent.x[i] += 0.4 / 20 * 3 * static_cast<double>(i) / 192;
  const FrameEncoder encoder({}, bent);
  ASSERT_TRUE(encoder.view().cloud);
  EXPECT_EQ(encoder.view().cloud->grid_columns, 16);
  EXPECT_LT(largest_error_m(decoded(encoder, bent), bent), 1e-7);
  for (const double depth_m : {140.0, -0.4})
    EXPECT_LT(largest_error_m(decoded(FrameEncoder({}, wall(depth_m)), wall(depth_m)), wall(depth_m)), 1e-4);
}

// A scenario as a sensor in real time, on a simulated clock.

// A recording of a host that was slow to start and got fewer frames than the sensor's rate.
class SlowRecording : public Scenario {
 public:
  static constexpr double kFirst_s = 0.12, kPeriod_s = 0.05;

  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 8; }
  double captured_s(int frame) const override { return kFirst_s + kPeriod_s * frame; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override { return scene_->points(frame); }
  PointCloud cloud(int frame) const override { return scene_->cloud(frame); }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scene_->signed_distance(p_W, time_s);
  }

 private:
  const std::unique_ptr<Scenario> scene_ =
      Experiment::from_json(R"({"scenario": {"name": "camera-scene", "width": 16, "height": 12},
                                "renderer": {"name": "proxy"}, "trajectory": {"name": "follow-surface"}})",
                            "test")
          .build_scenario(scenes::kernels());
};

// The camera repeats its last frame at 30 Hz.
TEST(ScenarioCamera, FramesComeAtTheTimesAtWhichTheyWereCaptured) {
  SimulatedClock clock;
  clock.sleep_s(5);
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  SensorFrame frame;
  for (int number = 0; number < 20; ++number) {
    while (camera.next(frame, 0.02) == SensorState::waiting) continue;
    const double after_s = SlowRecording::kFirst_s + SlowRecording::kPeriod_s * std::min(number, 7) +
                           std::max(0, number - 7) / 30.0;
    EXPECT_EQ(frame.number, number);
    EXPECT_NEAR(frame.captured_s, 5 + after_s, 1e-9);
    EXPECT_NEAR(clock.now_s(), 5 + after_s, 1e-9);
  }
}

// The time that setting up takes before the first frame moves no frame in time.
TEST(ScenarioCamera, CountsFromTheStartOfTheRun) {
  SimulatedClock clock;
  clock.sleep_s(5);
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  camera.start_at(clock.now_ns());
  clock.sleep_s(SlowRecording::kFirst_s + 1.5 * SlowRecording::kPeriod_s);
  SensorFrame frame;
  ASSERT_EQ(camera.next(frame, 1), SensorState::frame);
  EXPECT_EQ(frame.number, 1);
  EXPECT_NEAR(frame.captured_s, 5 + SlowRecording::kFirst_s + SlowRecording::kPeriod_s, 1e-9);
}

// Depths are rounded to 0.1 mm, and lie on the ray of their pixel. The points of clouds are rounded to
// floats.
TEST(ScenarioCamera, ShowsEveryScenarioOfTheCatalog) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto factory = entry.make();
    if (!factory->inputs().empty()) continue;  // it reads files and is tested with those
    const auto scenario = factory->build(NoiseKey{7}, scenes::kernels());
    const PointCloud truth = scenario->cloud(0);
    SimulatedClock clock;
    ScenarioCamera camera(factory->build(NoiseKey{7}, scenes::kernels()), clock);
    EXPECT_EQ(camera.view().cloud.has_value(), !truth.image) << entry.name;
    SensorFrame frame;
    ASSERT_EQ(camera.next(frame, 1), SensorState::frame) << entry.name;
    ASSERT_TRUE(is_complete(frame, camera.view())) << entry.name;
    const PointCloud seen = cloud_of(frame, camera.view(), camera.view().X_WC);
    ASSERT_EQ(seen.size(), truth.size()) << entry.name;
    EXPECT_EQ(seen.columns(), truth.columns()) << entry.name;
    EXPECT_EQ(seen.has_normals(), truth.has_normals() && !truth.image) << entry.name;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_EQ(seen.is_measured(i), truth.is_measured(i)) << entry.name << ", point " << i;
      if (!truth.is_measured(i)) continue;
      ASSERT_LT((seen.point(i) - truth.point(i)).norm(), truth.image ? 2e-4 : 1e-6) << entry.name;
      if (truth.image || !truth.has_normals() || !truth.normal(i).allFinite()) continue;
      ASSERT_LT((seen.normal(i) - truth.normal(i)).norm(), 1e-6) << entry.name;
      ASSERT_NEAR(seen.normal(i).norm(), 1, 1e-12) << entry.name;
    }
  }
}

TEST(ScenarioCamera, WaitsNoLongerThanTheGivenTimeAndALateReaderGetsTheNewestFrame) {
  SimulatedClock clock;
  ScenarioCamera camera(std::make_unique<SlowRecording>(), clock);
  SensorFrame frame;
  EXPECT_EQ(camera.next(frame, 0), SensorState::waiting);
  EXPECT_EQ(clock.now_ns(), 0);
  EXPECT_EQ(camera.next(frame, 0.1), SensorState::waiting);
  EXPECT_EQ(clock.now_ns(), 100'000'000);
  EXPECT_EQ(camera.next(frame, 0.1), SensorState::frame);
  EXPECT_EQ(clock.now_ns(), 120'000'000);
  clock.sleep_s(3.5 * SlowRecording::kPeriod_s);
  ASSERT_EQ(camera.next(frame, 0), SensorState::frame);
  EXPECT_EQ(frame.number, 3);
  EXPECT_EQ(camera.next(frame, 0), SensorState::waiting);
}

// The adapter on the real libfreenect without a Kinect plugged in.

TEST(FreenectAbsent, IsRefused) {
  const Availability availability = freenect_availability();
  if (availability.found) GTEST_SKIP() << "a Kinect is plugged in: " << availability.detail;
  const std::string message = refusal([] { open_freenect("0", steady_clock()); });
  if (availability.compiled_in) {
    EXPECT_HAS(message, "freenect");
    EXPECT_HAS(message, ": expected ");
    EXPECT_HAS(message, "that this user may open");
  } else {
    EXPECT_EQ(message, "freenect: not compiled in: install libfreenect-dev and build again");
    EXPECT_EQ(message, "freenect: " + availability.detail);
  }
}

}  // namespace
}  // namespace remote_touch::sensor_table_test
