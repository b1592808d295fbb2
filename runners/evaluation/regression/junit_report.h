// Comparisons and checks for build servers: JUnit's XML.
#pragma once

#include <string>
#include <vector>

#include "runners/evaluation/regression/result_comparison.h"

namespace remote_touch {

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

// Returns a case for each column or measure, and one for the whole. A measure that got worse is a failure.
// Any other difference is "skipped", so that nobody mistakes it for a failure or for a pass, and its text
// describes it. A comparison that was not possible or not decided is an error.
ReportSuite suite_of(const ResultComparison& comparison, const std::string& name);
std::string junit(const std::vector<ReportSuite>& suites);

}  // namespace remote_touch
