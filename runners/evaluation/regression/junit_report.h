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

// A case for each column or measure, and one for the whole. What got worse failed; what differs otherwise is
// "skipped", so that nobody takes it for a failure or for a pass, and its text says how; what could not be
// compared or decided is an error.
ReportSuite suite_of(const ResultComparison& comparison, const std::string& name);
std::string junit(const std::vector<ReportSuite>& suites);

}  // namespace remote_touch
