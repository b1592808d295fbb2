// The report of a comparison: as text for people, as JSON, and as test cases for build servers.
#pragma once

#include <string>
#include <vector>

#include "runners/evaluation/regression/junit_report.h"
#include "runners/evaluation/regression/result_comparison.h"

namespace remote_touch {

struct ComparisonReport {
  std::string text;  // tables
  // The text of a JSON file: {"outcome", "verdict", "kind", "columns": [...], "divergence": {...}, ...}.
  // Numbers that are not finite are null.
  std::string json;
  // A case for each column or measure, and one for the whole. A measure that got worse is a failure. Any
  // other difference is "skipped", so that nobody mistakes it for a failure or for a pass, and its text
  // describes it. A comparison that was not possible or not decided is an error.
  std::vector<ReportCase> cases = {};
};
ComparisonReport report_of(const ResultComparison& comparison);

// The fewest digits that state the number exactly: "0.033", not "0.033000000000000002".
std::string shortest_text(double number);

}  // namespace remote_touch
