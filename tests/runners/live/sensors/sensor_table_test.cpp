// Recordings and scenarios that --depth names, in real time on a simulated clock.
#include "runners/live/sensors/sensor_table.h"

#include <gtest/gtest.h>

#include <vector>

#include "runners/experiment/sessions/sensor_frame.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sensor_table_test {
namespace {

constexpr int kWidth = 32, kHeight = 24;

class SensorTable : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("camera.json", R"({"width": 32, "height": 24, "fx": 30, "fy": 30, "cx": 15.5, "cy": 11.5,
      "depth_scale_m": 0.001, "frame_rate_hz": 30})");
  }
  void write_image(const std::string& name, std::uint16_t depth) const {
    const std::vector<std::uint16_t> samples(kWidth * kHeight, depth);
    folder_.write_png(name, kWidth, kHeight, PNG_FORMAT_LINEAR_Y, samples.data());
  }
  // A proxy over the folder as a scenario.
  Experiment experiment(const std::string& scenario_settings = "",
                        const std::string& renderer = "proxy") const {
    return Experiment::from_json(
        R"({"scenario": {"name": "recording", "path": ")" + folder_.path().string() + "\"" +
            scenario_settings + R"(}, "renderer": {"name": ")" + renderer +
            R"("}, "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0.3, 0]]}})",
        "test");
  }
  std::unique_ptr<DepthSource> open(const std::string& uri, const Experiment& of) {
    return open_sensor(uri, {of, scenes::kernels(), clock_});
  }

  const TestFolder folder_{"sensor_table"};
  SimulatedClock clock_;
};

// The pause of 5 s between the third frame and the fourth is kept, there and back.
TEST_F(SensorTable, ARecordingIsPlayedAtTheTimesOfItsStamps) {
  folder_.write("depth.txt",
                "100.000 depth/0.png\n100.033 depth/1.png\n100.067 depth/2.png\n105.100 depth/3.png\n");
  for (const char* name : {"depth/0.png", "depth/1.png", "depth/2.png", "depth/3.png"})
    write_image(name, 500);
  const Experiment of = experiment();
  const auto sensor = open("tum:" + folder_.path().string(), of);
  SensorFrame frame;
  int number = 0;
  for (const double due_s : {0.0, 0.033, 0.067, 5.1, 10.133, 10.167, 10.2}) {
    while (sensor->next(frame, 0.001) == SensorState::waiting) continue;
    EXPECT_EQ(frame.number, number++);
    EXPECT_NEAR(frame.captured_s, due_s, 1e-6);
  }
}

// Each live frame is the offline one, within half a unit along the longest ray: |(15.5 / 30, 11.5 / 30, 1)| <
// 1.2.
TEST_F(SensorTable, TheScenarioHasTheFramesOfASimulatedRun) {
  for (int i = 0; i < 3; ++i)
    write_image("depth/" + std::to_string(i) + ".png", static_cast<std::uint16_t>(7000 + i));
  const Experiment of = experiment(R"(, "max_depth_m": 20)");
  const auto offline = of.build_scenario(scenes::kernels());
  const auto sensor = open("sim:", of);
  EXPECT_EQ(sensor->view().metres_per_unit, 5e-4) << "65535 units of 0.2 mm are 13.1 m";
  for (int i = 0; i < 3; ++i) {
    SensorFrame frame;
    while (sensor->next(frame, 0.001) == SensorState::waiting) continue;
    const PointCloud live = cloud_of(frame, sensor->view(), sensor->view().X_WC),
                     expected = offline->cloud(i);
    ASSERT_EQ(live.size(), expected.size());
    for (std::size_t p = 0; p < live.size(); ++p)
      ASSERT_LE((live.point(p) - expected.point(p)).norm(), 0.6 * 5e-4) << "frame " << i << ", point " << p;
  }
}

TEST_F(SensorTable, ARecordingThatIsNoImageIsRefusedAsInASimulatedRun) {
  folder_.write("points.pcd",
                "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
                "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n0 0 0.5\n0.001 0 0.5\n");
  const Experiment of = Experiment::from_json(
      R"({"scenario": {"name": "recording", "path": ")" + (folder_ / "points.pcd").string() +
          R"("}, "renderer": {"name": "god-object"}, "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0.3, 0]]}})",
      "test");
  EXPECT_HAS(refusal([&] { open("sim:", of); }), "renderer.name = \"god-object\": needs organised points");
}

TEST(SensorInputs, AreTheRecordingsThatSensorsRead) {
  for (const std::string scheme : {"dir:", "tum:", "pcd:", "replay:"}) {
    ASSERT_EQ(sensor_inputs(scheme + "a").size(), 1u) << scheme;
    EXPECT_EQ(sensor_inputs(scheme + "a")[0].path, "a");
  }
  for (const std::string uri : {"sim:", "k4a:0", "freenect:0", "realsense:", "oni:any"})
    EXPECT_TRUE(sensor_inputs(uri).empty()) << uri;
}

}  // namespace
}  // namespace remote_touch::sensor_table_test
