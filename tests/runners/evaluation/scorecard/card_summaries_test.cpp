// A scorecard in few numbers: differences from a stored card, overview, weaknesses, thresholds.
#include "runners/evaluation/scorecard/evaluation.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "analysis/storage/result_file.h"
#include "analysis/trace/interval_estimates.h"
#include "core/kernels/kernels.h"
#include "scenarios/files/input_files.h"
#include "tests/runners/evaluation/scorecard/example_cards.h"
#include "tests/support/test_files.h"

namespace remote_touch::card_summaries_test {
namespace {

using namespace made_cards;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Numbers of a scene with two noise levels and of a scene with its own noise, for one judged measure.
CardNumbers numbers() {
  CardNumbers n;
  n.counts = {{{"flat", "proxy", 0}, {1, 1, 1, 0.2, 1}},
              {{"flat", "proxy", 0.003}, {9, 10, 0.9, 0.6, 0.98}},
              {{"organ", "proxy", kNan}, {0, 10, 0, 0, 0.28}}};
  n.means = {
      {{"flat", "proxy", 0}, "max_force", "N", {.value = 2, .clusters = 1}},
      {{"flat", "proxy", 0.003}, "max_force", "N", {.value = 2.5, .low = 2.4, .high = 2.6, .clusters = 9}},
      {{"organ", "proxy", kNan}, "max_force", "N", {}}};
  return n;
}

TEST(CardNumbers, TablesAndBackAreTheSame) {
  const CardNumbers n = numbers();
  EXPECT_TRUE(differences(numbers_in(counts_table(n), means_table(n)), n).empty());
  const CardNumbers back = numbers_in(counts_table(n), means_table(n));
  ASSERT_EQ(back.counts.size(), 3u);
  EXPECT_EQ(back.counts[1].successes.low, 0.6);
  EXPECT_EQ(back.counts[1].cell.noise_m, 0.003);
  EXPECT_TRUE(std::isnan(back.counts[2].cell.noise_m));
  EXPECT_EQ(back.means[1].value.clusters, 9);
  EXPECT_EQ(back.means[1].units, "N");
}

TEST(CardNumbers, ATableThatIsDamagedIsRefused) {
  const CardNumbers n = numbers();
  Table counts = counts_table(n), cut = counts, wrong = counts;
  cut.columns.pop_back();
  EXPECT_THROW(numbers_in(cut, means_table(n)), std::out_of_range);
  wrong.columns[2].values = std::vector<std::string>{"a", "b", "c"};
  EXPECT_THROW(numbers_in(wrong, means_table(n)), std::out_of_range);
  wrong.columns[2].values = std::vector<double>{0};
  EXPECT_THROW(numbers_in(wrong, means_table(n)), std::out_of_range);
}

// The seeds are equal, so that a difference is no chance: not one success, and not within an interval.
TEST(CardNumbers, AgreeOnlyIfTheyAreEqual) {
  CardNumbers now = numbers();
  now.means[0].value.value = 2.0015;  // up to a thousandth
  now.means[1].value.value = 2.4977;
  now.means[2].value.value = 7;  // no stored mean
  EXPECT_TRUE(differences(numbers(), now).empty());
  now.means[0].value.value = 2.003;
  now.means[1].value.value = 2.6;
  for (std::size_t i = 0; i < 3; ++i) {
    now.counts[i].successes.events ^= 1;
    EXPECT_EQ(differences(numbers(), now).size(), 3 + i);
  }
}

TEST(CardNumbers, EachNumberThatDiffersHasItsLine) {
  const std::pair<std::function<void(CardNumbers&)>, const char*> cases[] = {
      {[](CardNumbers& n) { n.counts[1].successes.events = 8; },
       "flat, proxy, noise 3 mm: 8 of 10 runs succeed, stored 9 of 10"},
      {[](CardNumbers& n) { n.counts[0].successes.events = 0; },
       "flat, proxy, noise 0 mm: 0 of 1 runs succeed, stored 1 of 1"},
      {[](CardNumbers& n) { n.means[1].value.value = 2.51; },
       "flat, proxy, noise 3 mm: max_force in N is 2.51, stored 2.5"},
      {[](CardNumbers& n) { n.means[1].value = {}; },
       "flat, proxy, noise 3 mm: max_force in N is NaN, stored 2.5"},
      {[](CardNumbers& n) { n.means[1].units = "mN"; },
       "flat, proxy, noise 3 mm: max_force is in mN, stored in N"},
      {[](CardNumbers& n) { n.counts[2].successes.runs = 0; },
       "organ, proxy, own noise: 0 of 0 runs succeed, stored 0 of 10"}};
  for (const auto& [change, line] : cases) {
    CardNumbers now = numbers();
    change(now);
    EXPECT_EQ(differences(numbers(), now), std::vector<std::string>{line});
  }
}

TEST(Overview, CountsNoiseFreeRunsSeparately) {
  const Scorecard card = card_of({{sweep_of(false, 20, 1), sweep_of(true, 10, 1), sweep_of(true, 0, 1)},
                                  {sweep_of(true, 10, 1), sweep_of(true, 10, 1), sweep_of(true, 0, 1)}});
  const Successes& own = card.scenes[0].success[0];
  ASSERT_TRUE(own.noise_free);
  EXPECT_EQ(own.noise_free->runs, 1);
  EXPECT_EQ(own.noise_free->events, 0);
  EXPECT_EQ(own.noisy.runs, 20);
  EXPECT_EQ(own.noisy.events, 20);
  const auto summary = overview(card);
  EXPECT_EQ(summary[0].success.value, 0.75);
  EXPECT_EQ(summary[0].noise_free.value, 0.5);
  EXPECT_EQ(summary[1].noise_free.value, 1);
  EXPECT_EQ(summary[0].held, 1);
  EXPECT_EQ(summary[0].old_success.value, 1);  // every run satisfies the previous rule
  EXPECT_EQ(card.scenes[0].old_success[2].noisy.events, 20);
}

TEST(Overview, TheMeanOverScenesHasAnInterval) {
  std::vector<std::vector<SweepResult>> scenes;
  for (const int held_runs : {20, 18, 20, 4, 20, 16, 20, 0, 20, 20})
    scenes.push_back({sweep_of(true, held_runs, 1), sweep_of(true, 10, 1), sweep_of(true, 0, 1)});
  const auto summary = overview(card_of(scenes));
  EXPECT_EQ(summary[0].success.clusters, 10);
  EXPECT_NEAR(summary[0].success.value, 158 / 200.0, 1e-12);
  EXPECT_LT(summary[0].success.low, 0.55);
  EXPECT_GT(summary[0].success.high, 0.93);
  // The same in every scene: as if ten runs decided, 5 of them successes.
  EXPECT_NEAR(summary[1].success.low, exact_interval(5, 10).first, 1e-12);
}

TEST(Weaknesses, AreWhatOthersDoBetterByMoreThanChance) {
  const Scorecard card = card_of({{sweep_of(true, 20, 2), sweep_of(true, 20, 1), sweep_of(true, 0, 1)},
                                  {sweep_of(true, 0, 1), sweep_of(true, 20, 1), sweep_of(true, 20, 1)},
                                  {sweep_of(true, 20, 1), sweep_of(true, 0, 1), sweep_of(true, 0, 1)}});
  const auto list = weaknesses(card, kOwnMethod);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].scene, "scene 0");
  EXPECT_EQ(list[0].what, "steps");
  EXPECT_EQ(list[0].other, "proxy");
  EXPECT_EQ(list[0].ahead, 1);
  EXPECT_GT(list[0].own_mean, list[0].other_mean);
  EXPECT_TRUE(list[0].is_significant);
  EXPECT_LT(list[0].p, kSignificance);
  EXPECT_EQ(list[1].scene, "scene 1");
  EXPECT_EQ(list[1].what, "success");
  EXPECT_EQ(list[1].ahead, 2);
  EXPECT_EQ(list[1].own_mean, 0);
  EXPECT_EQ(list[1].other_mean, 1);
  EXPECT_TRUE(weaknesses(card, "nobody").empty());
}

TEST(Weaknesses, ListsInsignificantDifferencesSeparately) {
  const Scorecard card = card_of({{sweep_of(false, 17, 1), sweep_of(true, 18, 1), sweep_of(true, 20, 1)}});
  const auto list = weaknesses(card, kOwnMethod);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].what, "success");
  EXPECT_EQ(list[0].other, "penalty");
  EXPECT_EQ(list[0].ahead, 2);
  EXPECT_FALSE(list[0].is_significant);
  EXPECT_GT(list[0].p, kSignificance);
  EXPECT_EQ(list[1].what, "success without noise");
  EXPECT_EQ(list[1].own_mean, 0);
  EXPECT_EQ(list[1].other_mean, 1);
  EXPECT_TRUE(std::isnan(list[1].p));
  EXPECT_TRUE(
      weaknesses(card_of({{sweep_of(true, 20, 1), sweep_of(true, 20, 1), sweep_of(true, 0, 1)}}), kOwnMethod)
          .empty());
}

// --- thresholds ---

// Two replicates at each of the noise levels 0 and 5 mm, or four runs with the scene's own noise.
SweepResult jumps(const std::vector<double>& held, const std::vector<double>& jump, bool own_noise = false) {
  return finished_sweep(own_noise ? std::vector<double>{1} : std::vector<double>{0, 0.005},
                        {{"held", held}, {"max_relative_jump", jump}});
}
SceneScore scene_of(const std::vector<SweepResult>& sweeps, bool own_noise = false,
                    const char* measure = "max_relative_jump") {
  return score({"scene", "", "", {{"held", 1}}, {{measure, Better::neither}}}, sweeps, own_noise);
}
Scorecard of_two_methods(const std::vector<SceneScore>& scenes) {
  return {{"one", "two"}, {"", ""}, scenes};
}
using Counts = std::array<int, 5>;
Counts counts_of(const ThresholdCounts& of) {
  return {of.below, of.runs, of.noise_free_below, of.noise_free_runs, of.scenes};
}

// One jump of method one is at the threshold; method two fails in the two runs with noise. Then some runs
// have no value.
TEST(ThresholdSummary, CountsSuccessfulRunsBelowTheThreshold) {
  const auto list = threshold_summary(of_two_methods(
      {scene_of({jumps({1, 1, 1, 1}, {0.01, 0.2, 0.0699, 0.07}), jumps({1, 1, 0, 0}, {0.3, 0.4, 0, 0})})}));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_STREQ(list[0].threshold.measure, "max_relative_jump");
  EXPECT_EQ(counts_of(list[0].methods[0]), (Counts{1, 2, 1, 2, 1}));
  EXPECT_EQ(counts_of(list[0].methods[1]), (Counts{0, 0, 0, 2, 0}));
  const auto some = threshold_summary(of_two_methods({scene_of(
      {jumps({1, 1, 1, 1}, {kNan, 0.2, 0.01, kNan}), jumps({1, 1, 1, 1}, {kNan, kNan, kNan, kNan})})}));
  ASSERT_EQ(some.size(), 1u);
  EXPECT_EQ(counts_of(some[0].methods[0]), (Counts{1, 1, 0, 1, 1}));
  EXPECT_EQ(counts_of(some[0].methods[1]), (Counts{0, 0, 0, 0, 0}));
}

TEST(ThresholdSummary, AddsAllScenesThatReportTheMeasure) {
  const std::vector<double> jump = {0.2, 0.3, 0.01, 0.09};
  const SweepResult some = jumps({1, 1, 1, 1}, jump), own_noise = jumps({1, 1, 1, 1}, jump, true);
  const SceneScore silent = scene_of({some, some}, false, "held"),
                   own = scene_of({own_noise, own_noise}, true);
  const auto list = threshold_summary(of_two_methods({scene_of({some, some}), silent, own}));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(counts_of(list[0].methods[1]), (Counts{2, 2 + 4, 0, 2, 2}));
  EXPECT_TRUE(threshold_summary(of_two_methods({silent})).empty());
}

// --- stored cards ---

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

TEST_F(StoredCards, DifferWhereSomethingIsDefinedAnew) {
  Json scene = parse_json(kScene, "scene");
  scene["success"]["tolerance_m"] = 0.004;
  const BenchmarkPlan plan = plan_in(folder_, chosen_methods({"proxy", "penalty"}), scene.dump());
  const auto list = differences(read_stored_card(file_), plan, card_);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0], "scene short: defined in another way in the stored card");
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
  const auto other = folder_ / "other.h5";
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
}  // namespace remote_touch::card_summaries_test
