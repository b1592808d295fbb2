#include "analysis/scorecard/card_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

namespace remote_touch::card_numbers_test {
namespace {

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

TEST(CardNumbers, NewNumbersAreDifferencesAndMissingOnesAreNot) {
  CardNumbers now = numbers();
  now.counts[1].cell.method = "newcomer", now.means[1].cell.method = "newcomer";
  const auto list = differences(numbers(), now);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0], "flat, newcomer, noise 3 mm: its successes are not in the stored card");
  EXPECT_EQ(list[1], "flat, newcomer, noise 3 mm: max_force is not in the stored card");
  EXPECT_TRUE(differences(numbers(), {}).empty());
}

}  // namespace
}  // namespace remote_touch::card_numbers_test
