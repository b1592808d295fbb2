#include "runners/evaluation/regression/result_comparison.h"

#include <algorithm>

namespace remote_touch {

namespace {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    // XML has no control characters, and bytes outside ASCII may not be UTF-8: both become '?'.
    const bool is_plain = static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) <= 0x7e;
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : is_plain ? std::string(1, c) : "?";
  }
  return safe;
}

std::string case_xml(const ReportSuite& suite, const ReportCase& one) {
  constexpr const char* kElements[] = {"", "failure", "error", "skipped"};
  std::string xml =
      "    <testcase classname=\"" + escaped(suite.name) + "\" name=\"" + escaped(one.name) + "\"";
  if (one.state == ReportCase::State::passed) return xml + "/>\n";
  return xml + "><" + kElements[static_cast<int>(one.state)] + " message=\"" + escaped(one.text) +
         "\"/></testcase>\n";
}

std::string count(const ReportSuite& suite, ReportCase::State state) {
  return std::to_string(std::count_if(suite.cases.begin(), suite.cases.end(),
                                      [&](const ReportCase& one) { return one.state == state; }));
}

}  // namespace

std::string junit(const std::vector<ReportSuite>& suites) {
  using Result = ReportCase::State;
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const ReportSuite& suite : suites) {
    xml += "  <testsuite name=\"" + escaped(suite.name) + "\" tests=\"" + std::to_string(suite.cases.size()) +
           "\" failures=\"" + count(suite, Result::failed) + "\" errors=\"" + count(suite, Result::error) +
           "\" skipped=\"" + count(suite, Result::skipped) + "\">\n";
    for (const ReportCase& one : suite.cases) xml += case_xml(suite, one);
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace remote_touch
