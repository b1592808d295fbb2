#include "runners/experiment/settings/stored_configuration.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "analysis/storage/hdf5_file.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/text_files/text_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_configuration_test {
namespace {

// Names of earlier versions: the hint that a key or a value has another name now, and settings of results of
// schema /2.

TEST(RenamedNames, AreSortedAndDifferent) {
  for (std::size_t i = 0; i < renamed_names().size(); ++i) {
    const RenamedName& name = renamed_names()[i];
    EXPECT_STRNE(name.old_name, name.new_name);
    if (i == 0) continue;
    const RenamedName& before = renamed_names()[i - 1];
    EXPECT_LT(std::pair(std::string(before.old_name), std::string(before.new_name)),
              std::pair(std::string(name.old_name), std::string(name.new_name)));
  }
}

TEST(RenamedNames, OneOldNameHasTheNewNameThatIsKnownThere) {
  EXPECT_EQ(new_name("turn_deg", {"max_rotation_deg", "seed"}), "max_rotation_deg");
  EXPECT_EQ(new_name("turn_deg", {"seed", "rotation_deg"}), "rotation_deg");
  EXPECT_EQ(new_name("turn_deg", {"seed"}), std::nullopt);
  EXPECT_EQ(new_name("seed", {"seed"}), std::nullopt);
}

TEST(RenamedNames, ValuesAreSortedAndDifferent) {
  const auto key = [](const RenamedValue& value) {
    return std::pair(std::string(value.setting), std::string(value.old_value));
  };
  for (std::size_t i = 0; i < renamed_values().size(); ++i) {
    EXPECT_STRNE(renamed_values()[i].old_value, renamed_values()[i].new_value);
    if (i == 0) continue;
    EXPECT_LT(key(renamed_values()[i - 1]), key(renamed_values()[i]));
  }
}

TEST(RenamedNames, ValuesAreThoseOfASetting) {
  EXPECT_EQ(new_value("exit_rule", "towards_hip", {"towards-hip", "out-of-contact"}), "towards-hip");
  EXPECT_EQ(new_value("exit_rule", "towards_hip", {"out-of-contact"}), std::nullopt);
  EXPECT_EQ(new_value("playback", "towards_hip", {"towards-hip"}), std::nullopt);
  EXPECT_EQ(new_value("exit_rule", "towards-hip", {"towards-hip"}), std::nullopt);
}

TEST(RenamedNames, AreNoHintForAnEntryThatNeverHadThem) {
  EXPECT_EQ(new_name("view", {"view_direction"}, ""), std::nullopt) << "a section without entries";
  EXPECT_EQ(new_name("view", {"view_direction"}, "surfels"), "view_direction");
  EXPECT_EQ(new_name("true_motion", {"truth"}, "moving-lift"), std::nullopt);
  EXPECT_EQ(new_name("true_motion", {"truth"}, "plates"), "truth");
  EXPECT_EQ(new_name("largest_force_N", {"max_force_N"}, ""), "max_force_N") << "a name of version 0.1";
  EXPECT_EQ(new_value("truth", "true", {"newest-frame", "moving"}, "moving-lift"), std::nullopt);
  EXPECT_EQ(new_value("truth", "true", {"newest-frame", "moving"}, "plates"), "moving");
}

TEST(RenamedNames, StoredNamesAreThoseOfAnEntry) {
  EXPECT_EQ(stored_name("proxy", "contact_rule"), "contact_motion");
  EXPECT_EQ(stored_name("tracked-sheet", "contact_rule"), "contact_motion");
  EXPECT_EQ(stored_name("tool", "contact_rule"), "contact_rule");
  EXPECT_EQ(stored_name("", "contact_rule"), "contact_rule");
  EXPECT_EQ(stored_name("oracle", "contact_rule"), "contact_rule") << "a part of a name is another name";
  EXPECT_EQ(stored_name("surfels", "view"), "view_direction");
  EXPECT_EQ(stored_name("moving-lift", "rise_frames"), "rise_frames") << "a name of version 0.1";
  EXPECT_EQ(stored_value("recording", "playback", "ping_pong"), "ping-pong");
  EXPECT_EQ(stored_value("plates", "truth", "true"), "moving");
  EXPECT_EQ(stored_value("moving-lift", "truth", "true"), std::nullopt);
  EXPECT_EQ(stored_value("moving-shape", "truth", "newest_frame"), "newest-frame");
}

TEST(RenamedNames, AnEntryIsRenamedInItsSectionOnly) {
  EXPECT_EQ(renamed_entry("scenario", "sheet"), "panel");
  EXPECT_EQ(renamed_entry("trajectory", "random-walk"), "random-motion");
  EXPECT_EQ(renamed_entry("renderer", "sheet"), std::nullopt);
  EXPECT_EQ(renamed_entry("scenario", "random-walk"), std::nullopt);
  EXPECT_EQ(renamed_entry("scenario", "panel"), std::nullopt);
}

TEST(RenamedNames, AreTheHintOfAnOldValue) {
  enum class Rule { towards_hip, out_of_contact } rule = Rule::towards_hip;
  const Parameters parameters = {
      {"exit_rule", choice(rule, {"towards-hip", "out-of-contact"}), 0, 0, "the step in contact"}};
  const auto why = [&](const char* value, const char* entry = "proxy") {
    return refusal([&] { read_parameters({{"exit_rule", value}}, parameters, "renderer", {}, entry); });
  };
  EXPECT_EQ(
      why("out_of_contact"),
      "renderer.exit_rule = \"out_of_contact\": expected towards-hip, out-of-contact; out_of_contact is now "
      "out-of-contact");
  EXPECT_EQ(why("out_of_order"),
            "renderer.exit_rule = \"out_of_order\": expected towards-hip, out-of-contact");
  EXPECT_EQ(why("out_of_contact", "another"),
            "renderer.exit_rule = \"out_of_contact\": expected towards-hip, out-of-contact");
}

// The new name is the hint even if another name is nearer in spelling.
TEST(RenamedNames, AreTheHintOfAnOldKey) {
  double max_force_N = 0, longest_force_N = 0;
  const Parameters parameters = {{"longest_force_N", &longest_force_N, 0, 1, "another"},
                                 {"max_force_N", &max_force_N, 0, 1, "as it is called now"}};
  EXPECT_EQ(refusal([&] {
              read_parameters({{"largest_force_N", 1}}, parameters, "safety");
            }),
            "safety.largest_force_N: unknown; it is now safety.max_force_N");
  EXPECT_EQ(refusal([&] {
              read_parameters({{"largest_force_N", 1}}, parameters, "method mine: safety");
            }),
            "method mine: safety.largest_force_N: unknown; it is now safety.max_force_N");
  EXPECT_EQ(refusal([&] {
              read_parameters({{"longst_force_N", 1}}, parameters, "safety");
            }),
            "safety.longst_force_N: unknown; did you mean safety.longest_force_N");
  EXPECT_EQ(refusal([&] {
              read_parameters({{"largest_force_N", 1}}, {}, "safety");
            }),
            "safety.largest_force_N: unknown; no parameters here");
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
             "scenario.rise_frames: unknown; it is now scenario.rise_s");
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
  EXPECT_HAS(refusal([&] { Experiment::from_json(old, "old"); }),
             "scenario.sheets: unknown; it is now scenario.layers");
  const auto why = [](const std::string& assignment) {
    return refusal([&] { Experiment::load("fig4.12", {assignment}); });
  };
  EXPECT_HAS(why("renderer.contact_rule=regions"),
             "renderer.contact_rule: unknown; it is now renderer.contact_motion");
  EXPECT_HAS(why("renderer.contact_motion=tangent_plane"), "; tangent_plane is now tangent-plane");
  EXPECT_HAS(why("trajectory.name=random-walk"), "; random-walk is now random-motion");
  EXPECT_HAS(why("faults.view=[0, 0, 1]"), "faults.view: unknown; did you mean ") << "never had that name";
  EXPECT_HAS(why("scenario.true_motion=true"), "scenario.true_motion: unknown; did you mean ");
  EXPECT_TRUE(why("scenario.truth=true").ends_with("expected newest-frame, moving"));
}

}  // namespace
}  // namespace remote_touch::stored_configuration_test
