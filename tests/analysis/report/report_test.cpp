#include "analysis/report/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace remote_touch {
namespace {

using Json = nlohmann::ordered_json;

// A table with a row for all, one for programs, and one with a control character and a wide character.
ReportTable table() {
  ReportTable table{"measures"};
  const auto add = [&](const std::string& name, double value) -> ReportRow& {
    ReportRow& row = table.rows.emplace_back();
    row.add("name", "measure", name).add("value", "value\nN", value);
    row.tell("digits", list_of(std::vector{1, 2})).show("remark", value > 9 ? "large" : "");
    return row;
  };
  add("force", 12.5).result = ReportCase{"force", ReportCase::State::failed, "too large"};
  add("hidden", 1).is_shown = false;
  add("\xc3\xa9\x1b", std::numeric_limits<double>::quiet_NaN());
  return table;
}

TEST(Report, AlignsTheTextOfATable) {
  EXPECT_EQ(table().text(),
            "  measure  value  remark\n"
            "               N\n"
            "  force     12.5  large\n"
            "  \xc3\xa9\\x1b      nan\n");
  EXPECT_EQ(ReportTable{}.text(), "");
  ReportTable all_hidden;
  all_hidden.rows.emplace_back().show("x", "1").is_shown = false;
  EXPECT_EQ(all_hidden.text(), "");
  ReportTable plain{.indent = "", .has_headings = false};
  plain.rows.emplace_back().show("x", "1").show("y", "2");
  EXPECT_EQ(plain.text(), "1  2\n");
}

TEST(Report, HasOneOrderForPeopleProgramsAndBuildServers) {
  Report section;
  section.line("a section"), section.tell("none", {}), section.tell("missing", std::optional<int>());
  section.add(ReportCase{"part"});
  Report report;
  report.line("a line"), report.line("");
  report.tell("verdict", "first"), report.add(table()), report.add("section", section);
  report.add(ReportTable{"empty"}), report.add(ReportCase{"whole", ReportCase::State::error, "why"});
  report.tell("verdict", "changed");
  EXPECT_EQ(report.text(), "a line\n" + table().text() + "a section\n");
  const Json json = Json::parse(report.json());
  EXPECT_EQ(json, Json::parse(R"({"verdict": "changed",
    "measures": [{"name": "force", "value": 12.5, "digits": [1, 2]}, {"name": "hidden", "value": 1.0, "digits": [1, 2]},
                 {"name": "\u00e9\u001b", "value": null, "digits": [1, 2]}],
    "section": {"none": null, "missing": null}})"));
  EXPECT_EQ(Json::parse(json_of({report, section})), Json({json, json["section"]}));
  std::string names;
  for (const ReportCase& one : report.cases()) names += one.name + " ";
  EXPECT_EQ(names, "force part whole ");
}

TEST(Report, AnyTextIsWellFormedXml) {
  ReportSuite suite{"a<b>&\"c\"\n"};
  suite.cases = {{"passes & \t", ReportCase::State::passed},
                 {"fails", ReportCase::State::failed, "1 < 2 && \"x\" > 'y'"},
                 {"errs", ReportCase::State::error, "\x01\x1f\xff"},
                 {"skips", ReportCase::State::skipped, "no recording"}};
  const std::string name = "a&lt;b>&amp;&quot;c&quot;?",
                    of_suite = "    <testcase classname=\"" + name + "\" ";
  EXPECT_EQ(junit({suite}),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"" + name +
                "\" tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"1\">\n" +  //
                of_suite + "name=\"passes &amp; ?\"/>\n" +                       //
                of_suite +
                "name=\"fails\"><failure message=\"1 &lt; 2 &amp;&amp; &quot;x&quot; > 'y'\"/></testcase>\n" +
                of_suite + "name=\"errs\"><error message=\"???\"/></testcase>\n" +  //
                of_suite + "name=\"skips\"><skipped message=\"no recording\"/></testcase>\n" +
                "  </testsuite>\n</testsuites>\n");
}

}  // namespace
}  // namespace remote_touch
