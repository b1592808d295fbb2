#include "analysis/measures/perception_thresholds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "analysis/measures/measures.h"

namespace remote_touch::perception_thresholds_test {
namespace {

TEST(PerceptionThresholds, BelongToMeasuresOfTheSameUnit) {
  std::set<std::string> names;
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    const auto& measures = built_in_measures();
    const auto found = std::find_if(measures.begin(), measures.end(),
                                    [&](const Measure& one) { return one.name == threshold.measure; });
    ASSERT_NE(found, measures.end()) << threshold.measure;
    EXPECT_EQ(found->unit, threshold.unit) << threshold.measure;
    EXPECT_TRUE(found->better == Better::smaller || found->better == Better::near_zero) << threshold.measure;
    EXPECT_GT(threshold.value, 0) << threshold.measure;
    EXPECT_TRUE(names.insert(threshold.measure).second) << threshold.measure << " appears twice";
  }
  EXPECT_TRUE(names.contains("max_relative_jump"));
  EXPECT_TRUE(names.contains("apparent_friction"));
}

TEST(PerceptionThresholds, StateTheirMeaningAndSource) {
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    EXPECT_FALSE(std::string(threshold.meaning).empty());
    const std::string source = threshold.source;
    ASSERT_GT(source.size(), 4u);
    EXPECT_TRUE(std::all_of(source.end() - 4, source.end(), [](char c) { return c >= '0' && c <= '9'; }))
        << source << " does not end with a year";
  }
}

TEST(PerceptionThresholds, CompareMagnitudes) {
  const PerceptionThreshold threshold{"friction", "1", 0.5, "", ""};
  EXPECT_TRUE(is_below(threshold, 0));
  EXPECT_TRUE(is_below(threshold, -0.49));
  EXPECT_FALSE(is_below(threshold, 0.5));
  EXPECT_FALSE(is_below(threshold, -0.5));
  EXPECT_FALSE(is_below(threshold, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace remote_touch::perception_thresholds_test
