// The claims of a figure beside a run of its experiment.
#include "runners/presentation/view/shown_claims.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runners/experiment/provenance/provenance.h"
#include "tests/support/test_files.h"

namespace remote_touch::shown_claims_test {
namespace {

constexpr const char* kClaims = R"([
  {"figure": "4.12", "claim": "height", "paper": "3 mm", "measured": 0.003, "criterion": "at most 0.004", "unit": "m",
   "verdict": "pass", "set_up": false},
  {"figure": "4.16", "claim": "other", "paper": "-", "measured": null, "criterion": "-", "unit": "1",
   "verdict": "not run", "set_up": false},
  {"figure": "4.12", "claim": "speed", "paper": "1", "measured": 2, "criterion": "-", "unit": "1", "verdict": "differs",
   "set_up": false}])";

TextAttributes run(const std::string& experiment, const std::vector<std::string>& overrides = {}) {
  return {{kRecipe, to_json(Recipe{"run", experiment, overrides})}};
}

class ShownClaimsTest : public testing::Test {
 protected:
  std::string why(const std::string& text) {
    return refusal([&] { shown_claims(folder_.write("bad.json", text), run("fig4.12")); });
  }
  const TestFolder folder_{"shown_claims"};
  const std::filesystem::path file_ = folder_.write("claims.json", kClaims);
};

TEST_F(ShownClaimsTest, AreThoseOfTheFigureInTheirOrder) {
  const Json claims = shown_claims(file_, run("fig4.12"));
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[0]["claim"], "height");
  EXPECT_EQ(claims[0]["measured"], 0.003);
  EXPECT_EQ(claims[1]["verdict"], "differs");
  EXPECT_FALSE(claims[0].contains("set_up"));
}

TEST_F(ShownClaimsTest, ARunOfAnotherExperimentOrWithOtherSettingsHasNone) {
  EXPECT_TRUE(shown_claims(file_, run("fig4.14")).empty());
  EXPECT_TRUE(shown_claims(file_, run("fig4.12", {"seed=3"})).empty());
  EXPECT_TRUE(shown_claims(file_, run("my.json")).empty());
  EXPECT_TRUE(shown_claims(file_, {}).empty());
  EXPECT_TRUE(shown_claims({}, run("fig4.12")).empty());
}

TEST_F(ShownClaimsTest, AnotherFileIsRefused) {
  for (const char* text : {"{}", "[3]", R"([{"claim": "x"}])", R"([{"figure": "4.12"}])"})
    EXPECT_HAS(why(text), "bad.json: is not a list of claims") << text;
  EXPECT_HAS(why("[{"), "bad.json");
  EXPECT_HAS(refusal([&] { shown_claims(folder_ / "none.json", run("fig4.12")); }), "none.json");
}

}  // namespace
}  // namespace remote_touch::shown_claims_test
