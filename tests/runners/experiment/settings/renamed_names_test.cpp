// Names of version 0.1: the hint that a key has another name now.
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

// The new name is the hint even if another name is nearer in spelling.
TEST(RenamedNames, AreTheHintOfAnOldKey) {
  double max_force_N = 0, longest_force_N = 0;
  const Parameters parameters = {{"longest_force_N", &longest_force_N, 0, 1, "another"},
                                 {"max_force_N", &max_force_N, 0, 1, "as it is called now"}};
  EXPECT_EQ(refusal([&] {
              read_parameters({{"largest_force_N", 1}}, parameters, "safety");
            }),
            "safety.largest_force_N: unknown; did you mean safety.max_force_N");
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
