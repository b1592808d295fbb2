#include "runners/evaluation/regression/junit_report.h"

#include <algorithm>
#include <cstdio>

#include "runners/evaluation/regression/comparison_report.h"

namespace remote_touch {

namespace {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        // XML has no control characters, and bytes outside ASCII may not be UTF-8: both become '?'.
        safe += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e ? '?' : c;
    }
  }
  return safe;
}

std::string case_xml(const ReportSuite& suite, const ReportCase& one) {
  std::string xml =
      "    <testcase classname=\"" + escaped(suite.name) + "\" name=\"" + escaped(one.name) + "\"";
  if (one.state == ReportCase::State::passed) return xml + "/>\n";
  const char* element = one.state == ReportCase::State::failed  ? "failure"
                        : one.state == ReportCase::State::error ? "error"
                                                                : "skipped";
  return xml + "><" + element + " message=\"" + escaped(one.text) + "\"/></testcase>\n";
}

// "2 of 867 rows outside, the largest deviation 0.25"; empty for none.
std::string outside_text(std::int64_t outside, std::int64_t of, const char* things, double max) {
  if (outside == 0) return {};
  char text[160];
  std::snprintf(text, sizeof text, "%lld of %lld %s outside, the largest deviation %.6g",
                static_cast<long long>(outside), static_cast<long long>(of), things, max);
  return text;
}

ReportCase::State state_of(Outcome outcome) {
  using Result = ReportCase::State;
  switch (outcome) {
    case Outcome::same:
      return Result::passed;
    case Outcome::regressed:
      return Result::failed;
    case Outcome::changed:
      return Result::skipped;
    case Outcome::not_comparable:
      break;
  }
  return Result::error;
}

// An undecided measure is an error only if the whole comparison could not decide either.
ReportCase::State state_of(Judgement judgement, Outcome whole) {
  using Result = ReportCase::State;
  if (judgement == Judgement::equal || judgement == Judgement::within_margin) return Result::passed;
  if (judgement == Judgement::worse) return Result::failed;
  return judgement == Judgement::undecided && whole == Outcome::not_comparable ? Result::error
                                                                               : Result::skipped;
}

ReportCase case_of(const ValueComparison& measure, Outcome whole) {
  std::string text = shortest_text(measure.baseline) + " against " + shortest_text(measure.candidate);
  text += std::string(": ") + name_of(measure.judgement) + " (" + text_of(measure.better) + ")";
  return {measure.name, state_of(measure.judgement, whole), text};
}

ReportCase case_of(const MeasureComparison& measure, Judgement judgement, Outcome whole) {
  return {measure.name, state_of(judgement, whole),
          outside_text(measure.outside, measure.compared, "runs", measure.max_deviation) + ": " +
              name_of(judgement) + " (" + text_of(measure.better) + ")"};
}

std::string count(const ReportSuite& suite, ReportCase::State state) {
  return std::to_string(std::count_if(suite.cases.begin(), suite.cases.end(),
                                      [&](const ReportCase& one) { return one.state == state; }));
}

}  // namespace

ReportSuite suite_of(const ResultComparison& comparison, const std::string& name) {
  ReportSuite suite{name};
  using Result = ReportCase::State;
  if (comparison.columns)
    for (const ColumnComparison& column : comparison.columns->columns) {
      std::string why = column.problem;
      if (!why.empty() && column.outside > 0) why += "; ";
      why += outside_text(static_cast<std::int64_t>(column.outside), static_cast<std::int64_t>(column.rows),
                          "rows", column.max);
      suite.cases.push_back({column.name, column.is_same() ? Result::passed : Result::skipped, why});
    }
  for (const ValueComparison& measure : comparison.measures)
    suite.cases.push_back(case_of(measure, comparison.outcome));
  if (comparison.sweep && comparison.sweep->problems.empty())
    for (std::size_t i = 0; i < comparison.sweep->measures.size(); ++i)
      suite.cases.push_back(case_of(comparison.sweep->measures[i],
                                    judgement_of(*comparison.sweep, i, comparison.paired),
                                    comparison.outcome));
  suite.cases.push_back({comparison.kind, state_of(comparison.outcome), comparison.verdict});
  return suite;
}

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
