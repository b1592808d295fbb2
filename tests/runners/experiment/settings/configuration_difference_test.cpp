// Differences between configurations: by path, without titles.
#include "runners/experiment/settings/configuration_difference.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace remote_touch::configuration_difference_test {
namespace {

using Texts = std::vector<std::string>;

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
}  // namespace remote_touch::configuration_difference_test
