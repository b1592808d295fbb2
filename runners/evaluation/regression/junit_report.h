// Comparisons and checks for build servers: JUnit's XML.
#pragma once

#include <string>
#include <vector>

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

std::string junit(const std::vector<ReportSuite>& suites);

}  // namespace remote_touch
