// A recipe is read back field by field, and no text of a file is accepted as a command.
#include "runners/experiment/provenance/recipe.h"

#include <gtest/gtest.h>

#include <string>

namespace remote_touch::recipe_test {
namespace {

const Recipe kRecipes[] = {
    {"run", "fig4.11"},
    {"run", "it's my file.json", {"title=a; b", "trajectory.waypoints=[[0, 0.01, 0, 0]]"}},
    {"sweep", "quick.json", {"seed=3"}},
    {"replay", "quick.json", {"seed=3"}, {0, 4000000000}, 2},
    {"figure", "4.13", {}, {}, 0, 10},
    {"compare", "a.h5", {}, {}, 0, 1, "b.h5", {"*=1", "force=1e-9,1e-6"}},
};

TEST(Recipe, ComesBack) {
  for (const Recipe& recipe : kRecipes) {
    const auto again = recipe_of({{kRecipe, to_json(recipe)}});
    ASSERT_TRUE(again) << to_json(recipe);
    EXPECT_EQ(to_json(*again), to_json(recipe));
    EXPECT_EQ(commands(*again), commands(recipe));
  }
}

TEST(Recipe, IsACommand) {
  EXPECT_EQ(command_text(kRecipes[0]), "remote-touch run fig4.11");
  EXPECT_EQ(
      command_text(kRecipes[1]),
      "remote-touch run 'it'\\''s my file.json' --set 'title=a; b' --set 'trajectory.waypoints=[[0, 0.01, 0, 0]]'");
  EXPECT_EQ(
      command_text(kRecipes[3]),
      "remote-touch sweep quick.json --set seed=3; remote-touch replay --cell 0,4000000000 --replicate 2");
  EXPECT_EQ(command_text(kRecipes[4]), "remote-touch figure 4.13 --coarse 10");
  EXPECT_EQ(command_text(kRecipes[5]),
            "remote-touch compare a.h5 b.h5 --tolerance '*=1' --tolerance force=1e-9,1e-6");
}

TEST(Recipe, IsNoneIfTheTextIsOfAnotherKind) {
  for (const char* text : {"", "remote-touch run fig4.11", "{}", "[]", "null", "{\"action\": \"run\"}",
                           "{\"subject\": \"fig4.11\"}", "{\"action\": 1, \"subject\": 2}",
                           "{\"action\": \"touch evil\", \"subject\": \"x\"}",
                           "{\"action\": \"run\", \"subject\": \"x\", \"set\": \"seed=3\"}",
                           "{\"action\": \"run\", \"subject\": \"x\", \"set\": [1]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": \"3,4\"}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": [1e300]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": [-1]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"replicate\": 1e300}",
                           "{\"action\": \"figure\", \"subject\": \"x\", \"coarse\": 99999999999}",
                           "{\"action\": \"run\", \"action\": \"run\", \"subject\": \"x\"}"})
    EXPECT_FALSE(recipe_of({{kRecipe, text}})) << text;
  EXPECT_FALSE(recipe_of({}));
}

TEST(Recipe, AFileWithAnyNameIsStored) {
  EXPECT_TRUE(recipe_of({{kRecipe, to_json({"run", "\xff.json"})}}));
}

}  // namespace
}  // namespace remote_touch::recipe_test
