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

}  // namespace
}  // namespace remote_touch::configuration_difference_test
