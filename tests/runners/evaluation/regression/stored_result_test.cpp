#include "runners/evaluation/regression/stored_result.h"

#include <gtest/gtest.h>

#include "analysis/figures/result_file.h"
#include "runners/experiment/provenance/provenance.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_result_test {
namespace {

class StoredResults : public testing::Test {
 protected:
  // A trace of the recipe, as if it had come out of this configuration.
  StoredResult stored(const Recipe& recipe, const std::string& config) const {
    return stored(provenance(config, recipe, "x86-64"));
  }
  StoredResult stored(const TextAttributes& attributes) const {
    const std::string file = (folder_ / "made.h5").string();
    write_trace(file, awkward_trace(3), attributes, {});
    return StoredResult(file);
  }
  const TestFolder folder_{"stored_result_test"};
};

const Recipe kRun = {"run", "fig4.11", {"seed=3"}};

TEST_F(StoredResults, AreMadeAgainByTheirCommand) {
  const Remaking again = stored(kRun, Experiment::load("fig4.11", {"seed=3"}).to_json()).remaking();
  EXPECT_EQ(again.commands, std::vector<std::string>{"remote-touch run fig4.11 --set seed=3 -o again.h5"});
  EXPECT_EQ(again.reason, "");
}

TEST_F(StoredResults, AreMadeAgainByTheirConfigurationIfTheCommandMakesAnother) {
  const StoredResult result = stored(kRun, Experiment::load("fig4.11", {"seed=4"}).to_json());
  const Remaking again = result.remaking();
  EXPECT_EQ(again.commands,
            (std::vector<std::string>{"remote-touch repro " + result.file() + " --config again.json",
                                      "remote-touch run again.json -o again.h5"}));
  EXPECT_HAS(again.reason, "its command no longer makes this configuration");
}

TEST_F(StoredResults, NeedTheProgramThatKnowsTheirEntries) {
  std::string config = Experiment::load("fig4.11").to_json();
  config.replace(config.find("\"proxy\""), 7, "\"mine\"");
  TextAttributes attributes = provenance(config, kRun, "x86-64");
  attributes.emplace_back("program", "press-lab");
  const Remaking again = stored(attributes).remaking();
  EXPECT_TRUE(again.commands.empty());
  EXPECT_HAS(again.reason, "was made by press-lab");
}

TEST_F(StoredResults, KnowTheirKindAndConfiguration) {
  const std::string config = Experiment::load("fig4.11", {"seed=3"}).to_json();
  const StoredResult result = stored(kRun, config);
  EXPECT_EQ(result.kind(), "trace");
  EXPECT_EQ(result.of("git_commit"), attribute(provenance("", "", ""), "git_commit"));
  EXPECT_EQ(result.experiment().to_json(), config);
}

TEST_F(StoredResults, RefuseOtherFiles) {
  const auto text = folder_.write("text.h5", "text").string();
  EXPECT_HAS(refusal([&] { StoredResult result(text); }), "text.h5");
}

}  // namespace
}  // namespace remote_touch::stored_result_test
