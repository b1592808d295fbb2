// Names of earlier versions: the hint that a key or a value has another name now, and settings of results of
// schema /2.
#include "runners/experiment/settings/renamed_names.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/test_files.h"

namespace remote_touch::renamed_names_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::renamed_names_test
