#include "runners/experiment/settings/changed_settings.h"

#include <gtest/gtest.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "tests/support/test_files.h"

namespace remote_touch {
namespace {

// Reads the stored table without second_number().
nlohmann::json stored_chapter_4() {
  std::ifstream file(REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json");
  return nlohmann::json::parse(file);
}

TEST(SecondImplementation, GivesTheNumberAtAPlace) {
  EXPECT_EQ(second_number("chapter_4", "/lifts/noisy/survived"),
            stored_chapter_4()["lifts"]["noisy"]["survived"].get<double>());
}

// A loop over a part of a table that no longer exists would read wrong values, or none.
TEST(SecondImplementation, GivesAColumnOfEveryRow) {
  const nlohmann::json table = stored_chapter_4(), rows = table["map"]["regions"];
  ASSERT_GT(rows.size(), 20U);
  for (const auto& [name, value] : rows[0].items()) {
    if (!value.is_number()) continue;
    const std::vector<double> column = second_column("chapter_4", "/map/regions", name);
    ASSERT_EQ(column.size(), rows.size()) << name;
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_EQ(column[i], rows[i][name].get<double>()) << name << " " << i;
  }
}

// A number of a claim comes from the program itself, whatever files there are.
TEST(SecondImplementation, ReadsNoFile) {
  const char* const file = REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json";
  EXPECT_THROW(second_number(file, "/lifts/noisy/survived"), InputError);
}

TEST(SecondImplementation, RefusesWhatIsNotThere) {
  EXPECT_THROW(second_number("chapter_0", "/lifts"), InputError);
  EXPECT_THROW(second_number("chapter_4", "/lifts/nothing"), std::exception);
  EXPECT_THROW(second_column("chapter_4", "/map/regions", "nothing"), std::exception);
}

}  // namespace
}  // namespace remote_touch

namespace remote_touch::changed_settings_test {
namespace {

// Changes that --set and the like make to a configuration: refused, named, and stated in the title.

using Texts = std::vector<std::string>;

constexpr const char* kScene = R"(scenario={"name": "flat-grid", "columns": 30})";
const std::string kNone = "no InputError";

std::string why(const Texts& assignments) {
  return refusal([&] { refuse_discarded(assignments); });
}

TEST(DiscardedSettings, AreRefusedWithBothPaths) {
  EXPECT_EQ(why({"scenario.noise_sigma_m=0.01", kScene}),
            "--set scenario.noise_sigma_m=0.01: is overwritten by --set scenario: expected one of them");
  EXPECT_HAS(why({"scenario.columns=40", kScene}), "--set scenario.columns=40: is overwritten by ");
  EXPECT_HAS(why({"seed=3", "faults.dropout_probability=0.5", "faults=null"}),
             "--set faults.dropout_probability=0.5: is overwritten by --set faults: ");
  EXPECT_HAS(why({"fixtures.0.radius_m=0.1", "fixtures=[]"}),
             "--set fixtures.0.radius_m=0.1: is overwritten by --set fixtures: ");
  EXPECT_HAS(why({"set.seed=1", "set={}"}), "--set set.seed=1: is overwritten by --set set: ");
  EXPECT_HAS(why({"trajectory.start_m.01=1", "trajectory.start_m=[0, 2, 0]"}), "is overwritten by ");
}

TEST(DiscardedSettings, AreNoneWhereTheLaterOneKeepsTheValue) {
  EXPECT_EQ(why({"scenario.columns=30", kScene}), kNone);
  EXPECT_EQ(why({"trajectory.start_m.1=2", "trajectory.start_m=[0, 2, 0]"}), kNone);
  EXPECT_EQ(why({kScene, "scenario.noise_sigma_m=0.01"}), kNone);
  EXPECT_EQ(why({"scenario.columns=30", "scenario_.x={}", "scenario.rows=4"}), kNone);
  EXPECT_EQ(why({"seed=1", "seed=2"}), kNone);  // named, see below
}

TEST(ReplacedSettings, AreNamedInALineEach) {
  EXPECT_EQ(replaced_settings({"seed=1", "duration_s=2", "seed=2"}),
            (Texts{"--set seed=1 is replaced by --set seed=2"}));
  EXPECT_EQ(replaced_settings({kScene, "scenario.columns=40"}),
            (Texts{R"(--set scenario={"name":"flat-grid","columns":30} is replaced in part by --set )"
                   "scenario.columns=40"}));
  EXPECT_EQ(replaced_settings({"a.01=1", "a.1=2"}), (Texts{"--set a.01=1 is replaced by --set a.1=2"}));
  EXPECT_EQ(replaced_settings({"seed=1", "seed=2", "seed=3"}).size(), 2u);
  EXPECT_TRUE(replaced_settings({"seed=1", "seed=1", kScene, "scenario.rows=3", "seeds=4"}).empty());
}

std::string titled(const char* configuration, const Texts& assignments) {
  Json json = Json::parse(configuration);
  apply_overrides(json, assignments);
  return json.value("title", std::string("none"));
}

TEST(Titles, NameWhatWasChanged) {
  constexpr const char* kLift = R"({"title": "a lift", "seed": 1, "scenario": {"noise_sigma_m": 0.006}})";
  EXPECT_EQ(titled(kLift, {"scenario.noise_sigma_m=0", "scenario.path=my/hand"}),
            "a lift, changed: scenario.noise_sigma_m=0, scenario.path=my/hand");
  EXPECT_EQ(titled(kLift, {}), "a lift");
  EXPECT_EQ(titled(kLift, {"seed=1", "scenario.noise_sigma_m=6e-3"}), "a lift");  // the values do not change
  EXPECT_EQ(titled(kLift, {"seed=2", "seed=3"}), "a lift, changed: seed=3");
  EXPECT_EQ(titled(R"({"title": "a lift, changed: seed=3"})", {"duration_s=2"}),
            "a lift, changed: seed=3, duration_s=2");
}

TEST(Titles, TitlesOfTheUserAreKept) {
  EXPECT_EQ(titled(R"({"title": "a lift"})", {"seed=2", "title=mine"}), "mine");
  EXPECT_EQ(titled(R"({"title": ""})", {"seed=2"}), "");
  EXPECT_EQ(titled("{}", {"seed=2"}), "none");
  EXPECT_EQ(titled("{}", {"seed=2", "title=mine"}), "mine");
}

// A title has at most 120 characters of changes, then the count of the others. No value is longer than 40.
TEST(Titles, HaveALimitedLength) {
  Texts many;
  for (int i = 0; i < 100; ++i)
    many.push_back("scenario.parameter_" + std::to_string(i) + "=" + std::to_string(i));
  const std::string title = titled(R"({"title": "a lift"})", many);
  EXPECT_HAS(title, "a lift, changed: scenario.parameter_0=0, scenario.parameter_1=1, ");
  EXPECT_HAS(title, " more");
  EXPECT_LE(title.size(), std::string("a lift, changed:  and 100 more").size() + 120);
  EXPECT_EQ(titled(R"({"title": "a"})", {"scenario.path=" + std::string(300, 'x') + "/sr305_hand_flex"}),
            "a, changed: scenario.path=..." + std::string(24, 'x') + "/sr305_hand_flex");
  const std::string list = Json(std::vector<int>(100, 7)).dump();
  EXPECT_EQ(titled(R"({"title": "a"})", {"w=" + list}), "a, changed: w=" + list.substr(0, 40) + "...");
}

// A character of several bytes is kept whole, or is left out.
TEST(Titles, AreUtf8) {
  for (std::size_t more = 0; more < 4; ++more) {
    std::string path = std::string(more, 'x');
    for (int i = 0; i < 30; ++i) path += "ü€";
    const std::string title = changed_title("a", {{"scenario.path", path}, {"list", Json::array({path})}});
    EXPECT_NO_THROW(static_cast<void>(Json(title).dump())) << more;  // throws for what is not UTF-8
  }
}

// Differences between configurations: by path, without titles.

TEST(ConfigurationDifferences, AreOneTextEach) {
  EXPECT_EQ(
      configuration_differences(R"({"seed": 1, "renderer": {"r1_m": 1}})", R"({"renderer": {"r1_m": 2}})"),
      (Texts{"seed 1 against absent", "renderer.r1_m 1 against 2"}));
}

// A title describes a configuration and does not change what it does.
TEST(ConfigurationDifferences, LeaveOutTitles) {
  EXPECT_TRUE(configuration_differences(R"({"title": "a"})", R"({"title": "b"})").empty());
  EXPECT_TRUE(configuration_differences(R"({"title": "a", "experiment": {"title": "c", "seed": 1}})",
                                        R"({"title": "b", "experiment": {"title": "d", "seed": 1}})")
                  .empty());
  EXPECT_EQ(
      configuration_differences(R"({"scenario": {"title": "a"}})", R"({"scenario": {"title": "b"}})").size(),
      1u);
}

// The limit of 57 bytes is in the middle of the 28th of these characters, behind a quotation mark and a
// letter.
TEST(ConfigurationDifferences, DoNotCutACharacter) {
  std::string umlauts;
  for (int i = 0; i < 40; ++i) umlauts += "\xc3\xa4";
  const Texts found = configuration_differences(R"({"path": "x)" + umlauts + R"("})", R"({"path": 1})");
  EXPECT_EQ(found, (Texts{"path \"x" + umlauts.substr(0, 54) + "... against 1"}));
}

// Long values that differ only after their beginning are shown from shortly before the difference on.
TEST(ConfigurationDifferences, ShowThePartThatDiffers) {
  const std::string folder(100, 'a');
  EXPECT_EQ(
      configuration_differences(R"({"path": ")" + folder + R"(/one"})", R"({"path": ")" + folder + R"("})"),
      (Texts{"path \"..." + std::string(20, 'a') + "/one\" against \"..." + std::string(20, 'a') + "\""}));
  std::string count =
      R"({"axes": [{"from": 0, "parameter": "scenario.acceleration_m_per_s2", "to": 1, "count": 3}]})";
  std::string other = count;
  other.replace(other.find("\"to\": 1"), 7, "\"to\": 2");
  EXPECT_EQ(
      configuration_differences(count, other),
      (Texts{
          "axes [...tion_m_per_s2\",\"to\":1,\"count\":3}] against [...tion_m_per_s2\",\"to\":2,\"count\":3}]"}));
}

}  // namespace
}  // namespace remote_touch::changed_settings_test
