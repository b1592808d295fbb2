// Configurations of older results, whose lifts were given in frames.
#include "runners/experiment/settings/stored_configuration.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "runners/experiment/catalog/experiment.h"
#include "scenarios/text_files/json_text.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_configuration_test {
namespace {

Json present(const std::string& text) {
  return Json::parse(stored_configuration(text));
}

TEST(StoredConfiguration, CountsOfFramesBecomeTimesInTheirPlaces) {
  EXPECT_EQ(
      stored_configuration(R"({"scenario": {"name": "moving-shape", "frame_rate_hz": 60.0, "wait_frames": 6,
      "rise_frames": 45, "acceleration_m_per_s2": 0.0, "acceleration_frames": 27, "vanish_at_frame": -1,
      "empty_frame": 15}, "seed": 1})"),
      R"({"scenario":{"name":"moving-shape","frame_rate_hz":60.0,"wait_s":0.1,"rise_s":0.75,)"
      R"("acceleration_m_per_s2":0.0,"acceleration_s":0.45,"vanish_at_s":-1.0,"empty_frame_at_s":0.25},"seed":1})");
}

// The motion of older lifts was updated with the frames and linear between them.
TEST(StoredConfiguration, TheMotionKeepsItsUpdates) {
  const std::string lift =
      R"({"experiment": {"scenario": {"name": "moving-lift", "frame_rate_hz": 90, "rise_frames": 45,
      "acceleration_m_per_s2": 3, "acceleration_frames": 27, "truth": "moving"}}})";
  const Json scenario = present(lift)["experiment"]["scenario"];
  EXPECT_EQ(scenario["update_rate_hz"], 90);
  EXPECT_EQ(scenario["between_updates"], "line");
  EXPECT_EQ(scenario["rise_s"], 0.5);
  const Json at_rest =
      present(R"({"scenario": {"name": "moving-shape", "frame_rate_hz": 90, "rise_frames": 45}})");
  EXPECT_FALSE(at_rest["scenario"].contains("update_rate_hz"));
}

TEST(StoredConfiguration, OtherTextIsReturnedAsItIs) {
  for (
      const std::string text :
      {"", "no JSON", "[1, 2]", R"({"scenario": {"name": "plates", "rise_frames": 3}})",
       R"({"scenario": {"name": "moving-lift", "rise_s": 0.5, "acceleration_m_per_s2": 3, "truth": "moving"}})",
       R"({"scenario": {"name": "moving-lift", "rise_frames": "many"}})"})
    EXPECT_EQ(stored_configuration(text), text);
}

// A stored result can be made again; a file that a user writes gets the new name as a hint.
TEST(StoredConfiguration, OnlyStoredResultsMayCountFrames) {
  const std::string old =
      R"({"scenario": {"name": "moving-lift", "rise_frames": 15, "acceleration_frames": 10,
      "acceleration_m_per_s2": 3}, "renderer": {"name": "proxy"}, "trajectory": {"name": "press"}, "duration_s": 0.8})";
  EXPECT_EQ(Experiment::from_json(stored_configuration(old), "old").to_json(),
            Experiment::from_json(R"({"scenario": {"name": "moving-lift"}, "renderer": {"name": "proxy"},
                                      "trajectory": {"name": "press"}, "duration_s": 0.8})",
                                  "new")
                .to_json());
  EXPECT_HAS(refusal([&] { Experiment::from_json(old, "old"); }),
             "scenario.rise_frames: unknown; did you mean scenario.rise_s");
}

}  // namespace
}  // namespace remote_touch::stored_configuration_test
