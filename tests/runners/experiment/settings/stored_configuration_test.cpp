#include "runners/experiment/settings/stored_configuration.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "analysis/storage/hdf5_file.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/text_files/text_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_configuration_test {
namespace {

TEST(StoredConfiguration, AnEntryIsRenamedInItsSectionOnly) {
  EXPECT_EQ(renamed_entry("scenario", "sheet"), "panel");
  EXPECT_EQ(renamed_entry("trajectory", "random-walk"), "random-motion");
  EXPECT_EQ(renamed_entry("renderer", "sheet"), std::nullopt);
  EXPECT_EQ(renamed_entry("scenario", "random-walk"), std::nullopt);
  EXPECT_EQ(renamed_entry("scenario", "panel"), std::nullopt);
}

// Configurations of older results: lifts that were given in frames, and settings and values with other names.

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

TEST(StoredConfiguration, OnlyStoredResultsMayCountFrames) {
  const std::string old =
      R"({"scenario": {"name": "moving-lift", "rise_frames": 15, "acceleration_frames": 10,
      "acceleration_m_per_s2": 3}, "renderer": {"name": "proxy"}, "trajectory": {"name": "press"}, "duration_s": 0.8})";
  EXPECT_EQ(Experiment::from_json(stored_configuration(old), "old").to_json(),
            Experiment::from_json(R"({"scenario": {"name": "moving-lift"}, "renderer": {"name": "proxy"},
                                      "trajectory": {"name": "press"}, "duration_s": 0.8})",
                                  "new")
                .to_json());
  EXPECT_HAS(refusal([&] { Experiment::from_json(old, "old"); }), "scenario.rise_frames: unknown");
}

// --- names of schema /2 ---

TEST(StoredConfiguration, OldNamesBecomePresentOnesInTheirPlaces) {
  EXPECT_EQ(
      stored_configuration(R"({"scenario": {"name": "plates", "true_motion": true, "noise_sigma_m": 0.0},
      "renderer": {"name": "proxy", "free_root": "smallest_magnitude", "contact_rule": "tangent_plane",
      "exit_rule": "towards_hip", "force_gate": "contact_now"}, "trajectory": {"name": "random-walk", "seed": 1}})"),
      R"({"scenario":{"name":"plates","truth":"moving","noise_sigma_m":0.0},)"
      R"("renderer":{"name":"proxy","free_root":"smallest-magnitude","contact_motion":"tangent-plane",)"
      R"("exit_rule":"towards-hip","force_gate":"contact-now"},"trajectory":{"name":"random-motion","seed":1}})");
  EXPECT_EQ(present(R"({"trajectory": {"name": "press", "per_frame": false}})")["trajectory"].dump(),
            R"({"name":"press","surface":"moving"})");
  EXPECT_EQ(present(R"({"scenario": {"name": "sheet"}})")["scenario"]["name"], "panel");
  const Json shape = present(
      R"({"scenario": {"name": "moving-shape", "sheets": 2, "sheet_spacing_m": 0.01, "truth": "newest_frame"}})");
  EXPECT_EQ(shape["scenario"].dump(),
            R"({"name":"moving-shape","layers":2,"layer_spacing_m":0.01,"truth":"newest-frame"})");
}

TEST(StoredConfiguration, OldNamesOnAxesBecomePresentOnes) {
  const Json sweep =
      present(R"({"experiment": {"scenario": {"name": "plates"}, "renderer": {"name": "surfels"}},
      "axes": [{"parameter": "scenario.true_motion", "values": [true, false]},
               {"parameter": "renderer.view.1", "from": -1, "to": -0.5, "count": 2},
               {"parameter": "renderer", "values": [{"name": "proxy", "contact_rule": "regions"},
                                                    {"name": "tool", "contact_rule": "voxels"}]}]})");
  EXPECT_EQ(sweep["axes"][0].dump(), R"({"parameter":"scenario.truth","values":["moving","newest-frame"]})");
  EXPECT_EQ(sweep["axes"][1]["parameter"], "renderer.view_direction.1");
  EXPECT_EQ(sweep["axes"][2]["values"].dump(),
            R"([{"name":"proxy","contact_motion":"regions"},{"name":"tool","contact_rule":"voxels"}])");
}

TEST(StoredConfiguration, EntriesOnAxesHavePresentNames) {
  const Json sweep = present(R"({"experiment": {"scenario": {"name": "sheet"}, "renderer": {"name": "proxy"}},
      "axes": [{"parameter": "scenario", "values": [{"name": "sheet"}, {"name": "plates", "true_motion": true}]},
               {"parameter": "scenario.name", "values": ["sheet", 3]},
               {"parameter": "renderer", "values": [{"name": "sheet"}]},
               {"parameter": "scenario", "from": 0, "to": 1, "count": 2}]})");
  EXPECT_EQ(sweep["experiment"]["scenario"]["name"], "panel");
  EXPECT_EQ(sweep["axes"][0]["values"].dump(), R"([{"name":"panel"},{"name":"plates","truth":"moving"}])");
  EXPECT_EQ(sweep["axes"][1]["values"].dump(), R"(["panel",3])");
  EXPECT_EQ(sweep["axes"][2]["values"].dump(), R"([{"name":"sheet"}])");
  EXPECT_EQ(stored_configuration(sweep.dump()), sweep.dump()) << "a second time changes nothing";
}

// A name is translated only in the settings of an entry that had it.
TEST(StoredConfiguration, NamesOfOtherEntriesAreReturnedAsTheyAre) {
  for (
      const std::string text :
      {R"({"renderer": {"name": "tool", "contact_rule": "voxels"}})",
       R"({"renderer": {"name": "my-proxy", "contact_rule": "tangent_plane", "exit_rule": "towards_hip"}})",
       R"({"scenario": {"name": "my-scene", "sheets": 2, "truth": true, "playback": "ping_pong"}})",
       R"({"title": "sheet", "contact_rule": "tangent_plane"})",
       R"({"renderer": {"name": "sheet"}, "trajectory": {"name": "sheet"}, "scenario": {"name": "random-walk"}})",
       R"({"experiment": {"renderer": {"name": "tool"}}, "axes": [{"parameter": "renderer.contact_rule",)"
       R"( "values": ["voxels"]}, {"parameter": "seed", "values": [1]}, 3, {"parameter": 4}]})"})
    EXPECT_EQ(stored_configuration(text), text);
}

TEST(StoredConfiguration, EachTranslatedNameIsListedOnce) {
  EXPECT_EQ(translated_names(R"([{"scenario": {"name": "sheet"}, "renderer": {"name": "proxy",
      "contact_rule": "tangent_plane", "view": 1}}, {"renderer": {"name": "proxy", "contact_rule": "regions"}},
      {"scenario": {"name": "moving-lift", "rise_frames": 15}, "trajectory": {"name": "press", "per_frame": true}}])"),
            (std::vector<std::string>{"contact_rule to contact_motion", "per_frame to surface",
                                      "rise_frames to rise_s", "sheet to panel",
                                      "tangent_plane to tangent-plane"}));
  EXPECT_EQ(translated_names(R"({"experiment": {"renderer": {"name": "proxy"}},
      "axes": [{"parameter": "renderer.exit_rule", "values": ["towards_hip"]},
               {"parameter": "renderer.contact_rule", "values": ["regions"]}]})"),
            (std::vector<std::string>{"renderer.contact_rule to renderer.contact_motion",
                                      "towards_hip to towards-hip"}));
  for (const std::string text :
       {"", "no JSON", R"({"renderer": {"name": "tool", "contact_rule": "voxels"}})"})
    EXPECT_TRUE(translated_names(text).empty()) << text;
}

TEST(StoredConfiguration, AttributesOfAnEarlierSchemaSayThatTheyAreTranslated) {
  const std::string old = R"({"renderer":{"contact_rule":"tangent_plane","name":"proxy"}})",
                    now = R"({"renderer":{"contact_motion":"tangent-plane","name":"proxy"}})";
  const TextAttributes present =
      present_attributes({{"schema", "remote-touch-trace/2"}, {"config", old}, {"git_commit", "1234567"}});
  EXPECT_EQ(attribute(present, "schema"), schema_name("trace"));
  EXPECT_EQ(Json::parse(attribute(present, "config")), Json::parse(now));
  EXPECT_EQ(attribute(present, "git_commit"), "1234567");
  EXPECT_EQ(attribute(present, "translated_from"), "remote-touch-trace/2");
  EXPECT_EQ(present_attributes(present), present) << "a second time changes nothing";
  const TextAttributes another = {{"schema", schema_name("figure")}, {"config", old}};
  EXPECT_EQ(present_attributes(another), another);
}

TEST(StoredConfiguration, OnlyStoredResultsMayHaveOldNames) {
  const std::string old =
      R"({"scenario": {"name": "moving-shape", "sheets": 2}, "renderer": {"name": "proxy",
      "contact_rule": "tangent_plane"}, "trajectory": {"name": "press"}, "duration_s": 0.8})";
  EXPECT_EQ(Experiment::from_json(stored_configuration(old), "old").to_json(),
            Experiment::from_json(R"({"scenario": {"name": "moving-shape", "layers": 2},
                                      "renderer": {"name": "proxy", "contact_motion": "tangent-plane"},
                                      "trajectory": {"name": "press"}, "duration_s": 0.8})",
                                  "new")
                .to_json());
  EXPECT_HAS(refusal([&] { Experiment::from_json(old, "old"); }), "scenario.sheets: unknown");
}

}  // namespace
}  // namespace remote_touch::stored_configuration_test
