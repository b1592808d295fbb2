// Comparisons in machine-readable form: JSON, and JUnit's XML for build servers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/regression/comparison/result_comparison.h"

namespace remote_touch {

// The whole comparison, {"outcome", "verdict", "kind", "columns": [...], "divergence": {...}, ...}. Numbers
// that are not finite are null.
std::string comparison_json(const ResultComparison& comparison);
std::string comparison_json(const std::vector<ResultComparison>& comparisons);  // a list

// One test case and its result.
struct ReportCase {
  enum class State { passed, failed, error, skipped };
  std::string name;
  State state = State::passed;
  std::string text = {};  // why it did not pass
};
struct ReportSuite {
  std::string name;
  std::vector<ReportCase> cases = {};
};

// A case for each column or measure, and one for the whole.
ReportSuite suite_of(const ResultComparison& comparison, const std::string& name);
std::string junit(const std::vector<ReportSuite>& suites);

// Writes a report; throws InputError when it cannot.
void write_report(const std::filesystem::path& file, const std::string& text);

}  // namespace remote_touch
