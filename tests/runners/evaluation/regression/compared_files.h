// Result files that are compared, and the reports on them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/evaluation/regression/result_comparison.h"
#include "tests/support/test_files.h"

namespace remote_touch::compared_files {

namespace fs = std::filesystem;
using nlohmann::json;

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline bool any_has(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts)
    if (contains(text, part)) return true;
  return false;
}

inline json json_of(const ResultComparison& comparison) {
  return json::parse(report_of(comparison).json());
}
inline std::string junit_of(const ResultComparison& comparison) {
  return junit({{"baseline.h5", report_of(comparison).cases()}});
}
inline std::string counts(int tests, int failures, int errors, int skipped = 0) {
  return "tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" +
         std::to_string(errors) + "\" skipped=\"" + std::to_string(skipped) + "\"";
}

class Compare : public testing::Test {
 protected:
  ResultComparison compare(const std::string& baseline, const std::string& candidate,
                           const ComparisonRules& rules = {}) const {
    return compare_results(folder_ / baseline, folder_ / candidate, rules);
  }
  const TestFolder folder_{"result_comparison_test"};
};

}  // namespace remote_touch::compared_files
