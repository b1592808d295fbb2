#include "runners/evaluation/scorecard/evaluation.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <nlohmann/json.hpp>

#include "analysis/storage/result_file.h"
#include "core/kernels/kernels.h"
#include "scenarios/files/input_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::card_folder_test {
namespace {

// Two methods in a scene of a few ticks.
constexpr const char* kScene = R"({
  "title": "a short press",
  "experiment": {
    "scenario": {"name": "flat-grid", "columns": 30, "rows": 30},
    "trajectory": {"name": "waypoints", "waypoints": [[0, 0.006, 0, 0], [0, -0.005, 0, 0.5]]},
    "duration_s": 0.15
  },
  "noise": "scenario.noise_sigma_m",
  "measures": {"max_force": "smaller"},
  "success": {"rule": "held"}
})";

BenchmarkPlan plan_in(const TestFolder& folder, const std::vector<Method>& methods,
                      const std::string& scene = kScene) {
  return plan_of({methods, {read_benchmark_scene("short", scene)}, 3, folder / "card"});
}

Scorecard scored(const BenchmarkPlan& plan) {
  std::filesystem::create_directories(plan.benchmark.folder / "runs");
  do_sweeps(plan.sweeps(), kernels_for(best_isa()), nullptr, [](auto...) {});
  return scores_of(plan);
}

TextAttributes config_of(const BenchmarkPlan& plan) {
  return {{"config", configuration_of(plan)}};
}

class StoredCards : public testing::Test {
 protected:
  StoredCards() : folder_("stored_card_test"), plan_(plan_in(folder_, chosen_methods({"proxy", "penalty"}))) {
    card_ = scored(plan_);
    file_ = folder_ / "stored.h5";
    write_stored_card(file_, card_, config_of(plan_));
  }
  TestFolder folder_;
  BenchmarkPlan plan_;
  Scorecard card_;
  std::filesystem::path file_;
};

TEST_F(StoredCards, AgreeWithTheSameCardAndWithPartsOfIt) {
  const StoredCard stored = read_stored_card(file_);
  EXPECT_EQ(stored.replicates, 3);
  EXPECT_EQ(stored.methods, (std::vector<std::string>{"proxy", "penalty"}));
  EXPECT_EQ(stored.scenes, std::vector<std::string>{"short"});
  EXPECT_EQ(stored.numbers.counts.size(), 2 * scorecard_noise_m().size());
  EXPECT_TRUE(differences(stored, plan_, card_).empty());
  const BenchmarkPlan part = plan_in(folder_, chosen_methods({"penalty"}));
  EXPECT_TRUE(differences(stored, part, scored(part)).empty());
}

TEST_F(StoredCards, DifferWhereANumberIsAnother) {
  Scorecard changed = card_;
  changed.scenes[0].success[0].at_level[2] = {0, 3, 0, 0, 0.5};
  const auto list = differences(read_stored_card(file_), plan_, changed);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_HAS(list[0], "short, proxy, noise 1 mm: 0 of 3 runs succeed, stored 3 of 3");
}

TEST_F(StoredCards, DifferWhereSomethingIsDefinedAnew) {
  Json scene = parse_json(kScene, "scene");
  scene["success"]["tolerance_m"] = 0.004;
  BenchmarkPlan plan = plan_in(folder_, chosen_methods({"proxy", "penalty"}), scene.dump());
  auto list = differences(read_stored_card(file_), plan, card_);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0], "scene short: defined in another way in the stored card");
  plan = plan_;
  plan.benchmark.methods[0].name = "newcomer";
  list = differences(read_stored_card(file_), plan, card_);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0], "method newcomer: not in the stored card");
}

// One of three runs of the own method is behind the proxy's, which is too few to show it.
TEST_F(StoredCards, SayFirstWhereTheOwnMethodIsNotTheBest) {
  Scorecard card = card_;
  card.methods[1] = own_method(card.methods);
  write_stored_card(file_, card, config_of(plan_));
  const std::string text = stored_summary(file_);
  EXPECT_EQ(text.find("Where tracked-sheet is not the best, by more than chance:\n"), 0u) << text;
  EXPECT_HAS(text, "| scene | what | tracked-sheet | better | p, corrected |\n");
  EXPECT_HAS(text, "| short | success without noise | 0 | 1 (proxy) | - |\n");
  EXPECT_HAS(text, "All methods, means over 1 scenes:");
  EXPECT_LT(text.find("| proxy | "), text.rfind("| tracked-sheet | "));  // the most successful first
}

// The counts in the summary are those of threshold_summary(). A flat-grid without noise has one
// frame and no jump, so the shape is another one here.
TEST_F(StoredCards, SayHowManyRunsAreBelowAThreshold) {
  Json scene = parse_json(kScene, "scene");
  scene["experiment"]["scenario"] = {{"name", "moving-shape"}, {"rise_s", 5}};
  scene["experiment"]["duration_s"] = 0.3;
  const TestFolder folder("stored_thresholds");
  const BenchmarkPlan plan = plan_in(folder, chosen_methods({"proxy", "penalty"}), scene.dump());
  const Scorecard card = scored(plan);
  const auto summary = threshold_summary(card);
  ASSERT_EQ(summary.size(), 1u);  // the scene reports max_relative_jump only
  const ThresholdCounts& proxy = summary[0].methods[0];
  ASSERT_GT(proxy.runs, 0);
  ASSERT_GT(proxy.noise_free_runs, 0);
  ASSERT_EQ(summary[0].methods[1].runs, 0);  // the penalty method never succeeds
  write_stored_card(file_, card, config_of(plan));
  const std::string text = stored_summary(file_);
  EXPECT_HAS(text,
             "| max_relative_jump below 0.07, with noise | without |\n|---|---|---|---|---|---|---|---|\n");
  EXPECT_HAS(text, " | " + std::to_string(proxy.below) + " of " + std::to_string(proxy.runs) + " | " +
                       std::to_string(proxy.noise_free_below) + " of " +
                       std::to_string(proxy.noise_free_runs) + " |\n");
  EXPECT_HAS(text, " | - | - |\n");
  EXPECT_HAS(text, "Thresholds of perception:\n\n- `max_relative_jump`: 0.07 is the change");
}

// Cards that earlier versions stored have no thresholds.
TEST_F(StoredCards, WithoutThresholdsAreSummarised) {
  const CardNumbers numbers = numbers_of(card_, KeptMeasures::judged);
  write_figure(file_,
               {kStoredCardFigure,
                "t",
                "c",
                {overview_table(card_), behind_table(card_), counts_table(numbers), means_table(numbers)}},
               config_of(plan_));
  const std::string text = stored_summary(file_);
  EXPECT_HAS(text, "| best alone | worst alone |\n");
  EXPECT_EQ(text.find("hreshold"), std::string::npos) << text;
}

TEST_F(StoredCards, AnEvaluationThatFailsGivesTheThreadsBack) {
  const std::filesystem::path& card = plan_.benchmark.folder;
  std::filesystem::create_directories(card / "traces");
  std::filesystem::create_directories(card / "costs.json");  // a folder, so that no costs can be written
  const int before = omp_get_max_threads();
  omp_set_num_threads(3);
  EXPECT_HAS(refusal([&] { evaluate(plan_, kernels_for(best_isa()), nullptr, [](auto...) {}); }),
             "costs.json");
  EXPECT_EQ(omp_get_max_threads(), 3);
  omp_set_num_threads(before);
}

TEST_F(StoredCards, OtherFilesAreRefused) {
  EXPECT_HAS(refusal([&] { read_stored_card(folder_ / "none.h5"); }), "none.h5");
  const auto other = folder_ / "other.h5";
  write_figure(other, scorecard_figure(card_), config_of(plan_));
  EXPECT_HAS(refusal([&] { read_stored_card(other); }), "not a stored card: expected");
  for (const char* config : {"", "[]", "{}", R"({"replicates": "x", "methods": {}, "scenes": {}})"}) {
    write_stored_card(other, card_, {{"config", config}});
    EXPECT_HAS(refusal([&] { read_stored_card(other); }), "has no configuration of a scorecard");
  }
  Figure without = {kStoredCardFigure, "t", "c", {counts_table(numbers_of(card_, KeptMeasures::judged))}};
  write_figure(other, without, config_of(plan_));
  EXPECT_HAS(refusal([&] { read_stored_card(other); }), "has no table measures");
  without.tables.push_back({"measures", "t"});
  without.tables.back().add("mean", "1", "mean", {1});
  write_figure(other, without, config_of(plan_));
  EXPECT_HAS(refusal([&] { read_stored_card(other); }), "no usable column scene");
}

}  // namespace
}  // namespace remote_touch::card_folder_test
