#include "analysis/scorecard/overview.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/statistics/proportion.h"
#include "tests/analysis/scorecard/example_cards.h"

namespace remote_touch::overview_test {
namespace {

using namespace made_cards;

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

TEST(Weaknesses, NameTheFirstOfSeveralMethodsAhead) {
  const Scorecard card = card_of({{sweep_of(true, 0, 1), sweep_of(true, 14, 1), sweep_of(true, 20, 1)}});
  const auto list = weaknesses(card, kOwnMethod);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].ahead, 2);
  EXPECT_EQ(list[0].other, "penalty");
  EXPECT_EQ(list[0].other_mean, 1);
  EXPECT_EQ(list[0].p, card.scenes[0].ranking.against[2][0].p);
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

}  // namespace
}  // namespace remote_touch::overview_test
