// Comparison of files of figures.
#include <gtest/gtest.h>

#include "analysis/storage/result_file.h"
#include "tests/runners/evaluation/regression/compared_files.h"

namespace remote_touch::figure_comparison_test {
namespace {

using namespace compared_files;

class CompareFigures : public Compare {
 protected:
  void write(const std::string& name, const std::vector<double>& heights, bool with_second = true,
             const std::string& config = "[]") {
    Figure figure{"4.99", "A figure", "for tests"};
    Table first{"first", ""}, second{"second", ""};
    first.add("x", "m", "", {0, 1, 2}), first.add("height", "m", "", heights);
    second.add("x", "m", "", {5});
    figure.tables = {first};
    if (with_second) figure.tables.push_back(second);
    write_figure(folder_ / name, figure, {{"config", config}});
  }
};

TEST_F(CompareFigures, ComparesTableByTable) {
  write("a.h5", {1, 2, 3}), write("same.h5", {1, 2, 3}), write("other.h5", {1, 2, 3.5});
  const ResultComparison same = compare("a.h5", "same.h5");
  EXPECT_EQ(same.kind, "figure");
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_HAS(same.verdict, "3 columns");
  const ResultComparison other = compare("a.h5", "other.h5");
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_EQ(other.verdict, "first/height of 3 columns");
  EXPECT_EQ(json_of(other)["columns"][0]["name"], "first/height");
  EXPECT_EQ(json_of(other)["columns"][0]["max"], 0.5);
  ComparisonRules rules;
  rules.tolerances = {{"first/height", {0.5, 0}}};
  EXPECT_EQ(compare("a.h5", "other.h5", rules).outcome, Outcome::same);
  rules.tolerances = {{"height", {0.5, 0}}};
  EXPECT_HAS(refusal([&] { compare("a.h5", "other.h5", rules); }),
             "tolerance of height: there is no such column: expected first/height, first/x, second/x");
}

TEST_F(CompareFigures, TablesMayBeAddedButNotMissed) {
  write("a.h5", {1, 2, 3}), write("less.h5", {1, 2, 3}, false);
  const ResultComparison added = compare("less.h5", "a.h5");
  EXPECT_EQ(added.outcome, Outcome::same);
  EXPECT_EQ(json_of(added)["columns_only_in_candidate"], json({"second/x"}));
  const ResultComparison missing = compare("a.h5", "less.h5");
  EXPECT_EQ(missing.outcome, Outcome::changed);
  EXPECT_HAS(junit_of(missing), "name=\"second/x\"><skipped message=\"missing in the candidate\"/>");
  write("other.h5", {1, 2, 3}, false, "[1]");
  EXPECT_EQ(compare("other.h5", "a.h5").outcome, Outcome::changed);  // in either order
  EXPECT_EQ(compare("a.h5", "other.h5").outcome, Outcome::changed);
}

}  // namespace
}  // namespace remote_touch::figure_comparison_test
