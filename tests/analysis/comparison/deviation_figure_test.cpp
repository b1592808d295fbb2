// The figure of the deviation between two traces over time.
#include "analysis/comparison/deviation_figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace remote_touch::deviation_figure_test {
namespace {

using Numbers = std::vector<double>;

// Time in seconds and columns of zeros.
std::vector<Column> zeros(std::size_t rows, const std::vector<std::string>& names) {
  Numbers time(rows);
  std::iota(time.begin(), time.end(), 0.0);
  std::vector<Column> columns = {{"time", "s", "", time}};
  for (const std::string& name : names) columns.push_back({name, "m", "", Numbers(rows)});
  return columns;
}
double& value(std::vector<Column>& columns, std::size_t column, std::size_t row) {
  return std::get<Numbers>(columns[column].values)[row];
}

Figure figure_of(const std::vector<Column>& a, const std::vector<Column>& b,
                 const Tolerances& tolerances = {}) {
  const ColumnsInMemory baseline(a), candidate(b);
  return deviation_figure(baseline, candidate, compare_by_name(baseline, candidate, tolerances, {}));
}

// 2001 rows are more than the maximum of 2000 pieces, so each piece has two rows, and the last has one.
TEST(DeviationFigure, EachPieceShowsItsLargestDeviation) {
  const std::vector<Column> a = zeros(2001, {"x"});
  std::vector<Column> b = a;
  value(b, 1, 4) = 0.001, value(b, 1, 5) = -0.01;
  value(b, 1, 7) = std::numeric_limits<double>::quiet_NaN();
  value(b, 1, 1000) = 0.1, value(b, 1, 2000) = 100;
  const Figure figure = figure_of(a, b, {{"x", {0.05, 0}}});
  ASSERT_EQ(figure.tables.size(), 1u);  // the first row outside, 7, has no deviation to show
  const Numbers &when = numbers(figure.tables[0], "time"), &size = numbers(figure.tables[0], "deviation");
  ASSERT_EQ(size.size(), 1001u);
  for (std::size_t i = 0; i < size.size(); ++i) {
    EXPECT_EQ(when[i], 2.0 * static_cast<double>(i));
    if (i == 2 || i == 500 || i == 1000)
      EXPECT_NEAR(size[i], i == 2 ? -2 : i == 500 ? -1 : 2, 1e-12);
    else
      EXPECT_TRUE(std::isnan(size[i])) << i;
  }
}

TEST(DeviationFigure, UpTo2000RowsAreDrawnOneByOne) {
  const std::vector<Column> a = zeros(2000, {"x"});
  std::vector<Column> b = a;
  value(b, 1, 1999) = 1;
  const Figure figure = figure_of(a, b);
  ASSERT_EQ(figure.tables.size(), 2u);
  EXPECT_EQ(numbers(figure.tables[0], "deviation").size(), 2000u);
  EXPECT_EQ(numbers(figure.tables[1], "time"), Numbers{1999});
  EXPECT_EQ(numbers(figure.tables[1], "deviation"), Numbers{0});
}

TEST(DeviationFigure, CaptionTellsWhetherColumnsDiffer) {
  const std::vector<Column> a = zeros(5, {"x", "y"});
  std::vector<Column> b = a;
  EXPECT_EQ(figure_of(a, b).caption, "No column differs.");
  value(b, 1, 3) = 0.5;
  EXPECT_EQ(figure_of(a, b, {{"x", {1, 0}}}).caption, "1 column(s) differ, within the tolerances.");
  value(b, 2, 3) = 0.5;
  EXPECT_EQ(figure_of(a, b, {{"x", {1, 0}}}).caption, "2 column(s) differ.");
  const auto without_time = [](std::vector<Column> columns) {
    columns.erase(columns.begin());
    return columns;
  };
  EXPECT_EQ(figure_of(without_time(a), without_time(b)).caption,
            "2 column(s) differ. Nothing is drawn, because the baseline has no column time.");
  EXPECT_EQ(figure_of(without_time(a), without_time(a)).caption, "No column differs.");
}

TEST(DeviationFigure, HasAtMostEightPanelsInTheTracesOrder) {
  const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  const std::vector<Column> a = zeros(5, names);
  std::vector<Column> b = a;
  for (std::size_t column = 2; column < b.size(); ++column) value(b, column, 3) = 1;
  const Figure figure = figure_of(a, b);
  ASSERT_EQ(figure.panels.size(), 8u);  // nine columns differ; "a" does not
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(figure.panels[i].title, names[i + 1]);
    EXPECT_EQ(figure.panels[i].y_label, "log10 of the deviation in m");
  }
  EXPECT_TRUE(figure_of(a, a).panels.empty());
}

}  // namespace
}  // namespace remote_touch::deviation_figure_test
