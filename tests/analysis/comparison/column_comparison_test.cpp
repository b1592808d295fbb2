// Comparison of two columns: what counts as the same, and what never does.
#include "analysis/comparison/column_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace remote_touch::column_comparison_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Column numbers(std::vector<double> values, int width = 1, std::string units = "m") {
  return {"x", std::move(units), "", std::move(values), width, {}};
}

TEST(Within, ZeroToleranceAcceptsOnlyEqualNumbers) {
  const Tolerance exact;
  EXPECT_TRUE(within(exact, 0.1, 0.1));
  EXPECT_FALSE(within(exact, 1e-20, 2e-20));
  EXPECT_FALSE(within(exact, 0.1, std::nextafter(0.1, 1)));
  EXPECT_TRUE(within(exact, 0.0, -0.0));
}

TEST(Within, the) {
  const Tolerance both = {0.5, 0.25};
  EXPECT_TRUE(within(both, 2, 3));
  EXPECT_FALSE(within(both, 2, 3.0001));
  EXPECT_TRUE(within(both, -2, -3));
  EXPECT_FALSE(within(both, 2, 0.9));  // relative to the candidate 0.9, the limit would be smaller
  EXPECT_TRUE(within({0, 1}, 4, 0));
  EXPECT_FALSE(within({0, 1}, 0, 4));
}

TEST(Within, NanAndInfinityEqualOnlyThemselvesAtAnyTolerance) {
  const double other_nan = -std::numeric_limits<double>::signaling_NaN();
  for (const Tolerance& tolerance : {Tolerance{}, Tolerance{1, 1}, Tolerance{kInfinity, kInfinity}}) {
    EXPECT_TRUE(within(tolerance, kNaN, kNaN));
    EXPECT_TRUE(within(tolerance, kNaN, other_nan));
    EXPECT_TRUE(within(tolerance, -kInfinity, -kInfinity));
    for (const double number : {0.0, 1.0, -1e308, kInfinity}) {
      EXPECT_FALSE(within(tolerance, kNaN, number)) << number;
      EXPECT_FALSE(within(tolerance, number, kNaN)) << number;
      EXPECT_FALSE(within(tolerance, number, -kInfinity)) << number;
      EXPECT_FALSE(within(tolerance, -kInfinity, number)) << number;
    }
  }
}

TEST(CompareColumns, CountsAndMeasuresWhatIsOutside) {
  const auto c = compare_columns(numbers({1, 2, 3, 4}), numbers({1, 2.5, 3, 4.1}), {0.2, 0});
  EXPECT_FALSE(c.is_same());
  EXPECT_EQ(c.rows, 4u);
  EXPECT_EQ(c.outside, 1u);
  EXPECT_EQ(c.first_difference, 1u);
  EXPECT_EQ(c.first_outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 0.5);
  EXPECT_DOUBLE_EQ(c.rms, std::sqrt((0.25 + 0.01) / 4));
  EXPECT_TRUE(compare_columns(numbers({1, 2}), numbers({1, 2}), {}).is_same());
}

// h5diff accepts such differences.
TEST(CompareColumns, TinyDifferencesAreDifferences) {
  const auto c = compare_columns(numbers({1e-20}), numbers({2e-20}), {});
  EXPECT_FALSE(c.is_same());
  EXPECT_DOUBLE_EQ(c.max, 1e-20);
}

TEST(CompareColumns, AVectorsDeviationIsALength) {
  const auto c = compare_columns(numbers({0, 0, 0, 3, 0, 4}, 3), numbers({0, 3, 4, 3, 0, 4}, 3), {1, 0});
  EXPECT_EQ(c.rows, 2u);
  EXPECT_EQ(c.outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 5);
  // The tolerance is relative to the length of the baseline's row, here 5.
  EXPECT_TRUE(compare_columns(numbers({3, 0, 4}, 3), numbers({3, 0, 4.4}, 3), {0, 0.1}).is_same());
  EXPECT_FALSE(compare_columns(numbers({3, 0, 4}, 3), numbers({3, 0, 4.6}, 3), {0, 0.1}).is_same());
}

// The squares of such small numbers are 0.
TEST(CompareColumns, DistinguishesTheSmallestVectors) {
  const auto c = compare_columns(numbers({0, 1e-170, 0}, 3), numbers({0, 2e-170, 0}, 3), {});
  EXPECT_EQ(c.outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 1e-170);
  EXPECT_EQ(compare_columns(numbers({0, 5e-324, 0}, 3), numbers({0, 0, 0}, 3), {}).outside, 1u);
  // The next row does not matter.
  const auto two =
      compare_columns(numbers({0, 1e-170, 0, 7, 0, 0}, 3), numbers({0, 2e-170, 0, 8, 0, 0}, 3), {});
  EXPECT_EQ(two.outside, 2u);
}

// An infinite or a very large baseline does not make the relative tolerance accept any number.
TEST(CompareColumns, ARelativeToleranceNeedsAFiniteLength) {
  EXPECT_FALSE(
      compare_columns(numbers({kInfinity, 0, 0}, 3), numbers({kInfinity, 5, 0}, 3), {0, 1e-12}).is_same());
  EXPECT_FALSE(compare_columns(numbers({1e200}), numbers({5e200}), {0, 1e-9}).is_same());
  EXPECT_TRUE(
      compare_columns(numbers({1e200, 0, 0}, 3), numbers({1.0001e200, 0, 0}, 3), {0, 1e-3}).is_same());
}

TEST(CompareColumns, NanOrInfinityNeverPassesAgainstANumber) {
  for (const double none : {kNaN, kInfinity}) {
    const auto c = compare_columns(numbers({none, 1}), numbers({0, 1}), {1e9, 1e9});
    EXPECT_EQ(c.outside, 1u);
    EXPECT_EQ(c.not_numbers, 1u);
    EXPECT_EQ(c.max, 0);
    const auto alone = compare_columns(numbers({none}), numbers({0}), {});
    EXPECT_EQ(alone.max, 0);
    EXPECT_EQ(alone.rms, 0);  // no deviation is finite
    EXPECT_FALSE(compare_columns(numbers({0, 1}), numbers({none, 1}), {1e9, 1e9}).is_same());
    EXPECT_TRUE(compare_columns(numbers({none, 1}), numbers({none, 1}), {}).is_same());
  }
  EXPECT_FALSE(compare_columns(numbers({0, kNaN, 0}, 3), numbers({0, 0, 0}, 3), {1, 1}).is_same());
  EXPECT_FALSE(compare_columns(numbers({kInfinity}), numbers({-kInfinity}), {1, 1}).is_same());
}

TEST(CompareColumns, ShapesUnitsAndKindsAreProblems) {
  const Column whole = numbers({1, 2, 3});
  const auto problem = [&](const Column& other) {
    const auto c = compare_columns(whole, other, {1e9, 0});
    EXPECT_FALSE(c.is_same());
    return c.problem;
  };
  EXPECT_EQ(problem(numbers({1, 2})), "3 rows of 1 against 2 rows of 1");
  EXPECT_EQ(problem(numbers({1, 2, 3}, 3)), "3 rows of 1 against 1 rows of 3");
  EXPECT_EQ(problem(numbers({1, 2, 3}, 1, "mm")), "units m against mm");
  EXPECT_EQ(problem({"x", "m", "", std::vector<std::int32_t>{1, 2, 3}}), "different type of values");
  EXPECT_EQ(problem(numbers({})), "3 rows of 1 against 0 rows of 1");
  // The rows that both have are compared nevertheless.
  EXPECT_EQ(compare_columns(whole, numbers({1, 9}), {}).first_outside, 1u);
}

// A table of a figure may be empty, for example if it lists events that did not happen.
TEST(CompareColumns, TwoEmptyColumnsAreTheSame) {
  EXPECT_TRUE(compare_columns(numbers({}), numbers({}), {}).is_same());
  EXPECT_FALSE(compare_columns(numbers({}, 3), numbers({}), {}).is_same());
}

TEST(CompareColumns, NamesTextsAndFingerprintsAreEqualOrNot) {
  const auto state = [](std::vector<std::int32_t> values,
                        std::vector<std::string> names = {"free", "contact"}) {
    return Column{"state", "1", "", std::move(values), 1, std::move(names)};
  };
  const auto c = compare_columns(state({0, 1}), state({0, 0}), {5, 0});
  EXPECT_EQ(c.outside, 1u);
  EXPECT_EQ(c.max, 0);
  EXPECT_EQ(compare_columns(state({0}), state({0}, {"free", "touching"}), {}).problem,
            "different names of the values");
  const Column hash = {"h", "1", "", std::vector<std::uint64_t>{1, 2}};
  Column other = hash;
  other.values = std::vector<std::uint64_t>{1, 3};
  EXPECT_EQ(compare_columns(hash, other, {5, 0}).first_outside, 1u);
  const Column text = {"t", "1", "", std::vector<std::string>{"a", "b"}};
  EXPECT_TRUE(compare_columns(text, text, {}).is_same());
  const Column counts = {"n", "1", "", std::vector<std::int32_t>{10, 20}};
  Column more = counts;
  more.values = std::vector<std::int32_t>{10, 22};
  EXPECT_EQ(compare_columns(counts, more, {}).max, 2);
  EXPECT_TRUE(compare_columns(counts, more, {2, 0}).is_same());
}

}  // namespace
}  // namespace remote_touch::column_comparison_test
