// Comparison of traces and figures in files: what is compared, the verdict, and what the reports state. The
// test command_line/compare has more of them; judged_measures_test.cpp has what became better or worse.
#include "runners/evaluation/regression/result_comparison.h"

#include <gtest/gtest.h>
#include <functional>
#include <nlohmann/json.hpp>

#include "analysis/storage/result_file.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/runners/evaluation/regression/compared_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::result_comparison_test {
namespace {

using namespace compared_files;

// --- traces ---

class CompareTraceFiles : public Compare {
 protected:
  static Trace run(const Experiment& experiment) {
    SimulationOptions options;
    options.hash_frames = true;
    return simulate(experiment, options);
  }
  void write(const std::string& name, const std::vector<std::string>& overrides = {},
             const TextAttributes& build = {{"command", "remote-touch run fig4.12"}, {"git_commit", "abc"}}) {
    const Experiment experiment = Experiment::load("fig4.12", overrides);
    TextAttributes attributes = build;
    attributes.emplace_back("config", experiment.to_json());
    write_trace(folder_ / name, run(experiment), attributes, {});
  }
  void write_changed(const std::string& name, const std::function<void(Trace&)>& change) {
    const Experiment experiment = Experiment::load("fig4.12");
    Trace trace = run(experiment);
    change(trace);
    write_trace(folder_ / name, trace, {{"config", experiment.to_json()}}, {});
  }
};

// Builds and commands are reported but not judged. The title is not compared at all.
TEST_F(CompareTraceFiles, ProvenanceIsReportedAndNotJudged) {
  write("a.h5");
  write("b.h5", {"title=another"},
        {{"git_commit", "def"}, {"isa", "x86-64"}, {"input_digests", "scene: sha256 01"}});
  const ResultComparison same = compare("a.h5", "b.h5");
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_TRUE(same.configuration.empty());
  EXPECT_EQ(same.provenance.size(), 4u);
  for (const char* difference : {"git_commit abc against def", "command remote-touch run fig4.12 against ",
                                 "isa  against x86-64", "input scene absent against sha256 01"})
    EXPECT_TRUE(any_has(same.provenance, difference)) << difference;
  EXPECT_EQ(json_of(same)["provenance"].size(), 4u);
}

// Another configuration with the same numbers is reported, and the outcome is `same`.
TEST_F(CompareTraceFiles, AConfigurationAloneIsNoRegression) {
  write("a.h5", {"scenario.noise_sigma_m=0"}), write("b.h5", {"scenario.noise_sigma_m=0", "seed=2"});
  const ResultComparison same = compare("a.h5", "b.h5");
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_EQ(same.configuration, std::vector<std::string>{"seed 1 against 2"});
}

TEST_F(CompareTraceFiles, TheJsonHoldsTheNumbers) {
  write_changed("a.h5", [](Trace&) {});
  write_changed("b.h5", [](Trace& trace) {
    trace.force_N[410].y() += 0.25;
    trace.force_N[412].y() += 1e-3;
    trace.nearest_distance_m[600] = kNaN;
    trace.state[700] = (trace.state[700] + 1) % 3;
  });
  ComparisonRules rules;
  rules.tolerances = {{"force", {1e-6, 1e-9}}, {"*", {1e-12, 0}}};
  const ResultComparison other = compare("a.h5", "b.h5", rules);
  EXPECT_EQ(other.outcome, Outcome::regressed);
  EXPECT_HAS(other.verdict, "force and 2 more of 18 columns, from tick 410 on (");
  const json told = json_of(other), divergence = told["divergence"];
  EXPECT_EQ(told["outcome"], "regressed");  // a tick more counts as in contact
  EXPECT_EQ(told["verdict"], other.verdict);
  EXPECT_EQ(told["kind"], "trace");
  EXPECT_EQ(divergence["tick"], 410);
  EXPECT_EQ(divergence["first_difference"], 410);
  EXPECT_DOUBLE_EQ(divergence["time_s"], 0.41);
  EXPECT_EQ(divergence["quantity"], "force");
  EXPECT_NEAR(divergence["deviation"], 0.25, 1e-12);
  EXPECT_EQ(divergence["rows_from_tick"], 409);
  const Trace trace = run(Experiment::load("fig4.12"));
  const json before = divergence["baseline"]["force"], after = divergence["candidate"]["force"];
  ASSERT_EQ(before.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(before[i], trace.force_N[409 + i / 3][static_cast<int>(i % 3)]);  // equal to the last bit
  EXPECT_EQ(after[4], trace.force_N[410].y() + 0.25);
  for (const json& name : divergence["baseline"]["state"])
    EXPECT_TRUE(name == "free" || name == "contact" || name == "entrenched") << name;
  EXPECT_EQ(divergence["baseline"]["frame_hash"][1], trace.frame_hash[410]);  // all 64 bits
  for (const json& column : told["columns"]) {
    if (column["name"] == "force") {
      EXPECT_EQ(column["units"], "N");
      EXPECT_EQ(column["rows"], 867);
      EXPECT_EQ(column["outside"], 2);
      EXPECT_EQ(column["first_difference"], 410);
      EXPECT_EQ(column["first_outside"], 410);
      EXPECT_EQ(column["absolute_tolerance"], 1e-6);
      EXPECT_EQ(column["relative_tolerance"], 1e-9);
      EXPECT_NEAR(column["max"], 0.25, 1e-12);
      EXPECT_NEAR(column["rms"], std::sqrt((0.0625 + 1e-6) / 867), 1e-9);
    } else if (column["name"] == "nearest_distance") {
      EXPECT_EQ(column["not_numbers"], 1);
      EXPECT_EQ(column["same"], false);
    } else if (column["name"] == "state") {
      EXPECT_EQ(column["first_outside"], 700);
    } else {
      EXPECT_EQ(column["same"], true) << column["name"];
      EXPECT_EQ(column["absolute_tolerance"], 1e-12);
    }
  }
  const std::string xml = junit_of(other);
  EXPECT_HAS(xml, "<testcase classname=\"baseline.h5\" name=\"time\"/>");
  EXPECT_HAS(xml, "name=\"force\"><skipped message=\"2 of 867 rows outside, the largest deviation 0.25\"/>");
  EXPECT_HAS(xml, "name=\"distance_sd\"><failure message=");
  EXPECT_HAS(xml, "name=\"trace\"><failure message=\"force and 2 more");
}

// JSON has no NaN, so NaN is written as null and never as 0.
TEST_F(CompareTraceFiles, NanIsNullInJson) {
  write_changed("a.h5", [](Trace&) {});
  write_changed("b.h5", [](Trace& trace) { trace.signed_distance_m[77] = kNaN; });
  const json divergence = json_of(compare("a.h5", "b.h5"))["divergence"];
  EXPECT_TRUE(divergence["deviation"].is_null());
  EXPECT_TRUE(divergence["candidate"]["signed_distance"][1].is_null());
  EXPECT_TRUE(divergence["baseline"]["signed_distance"][1].is_number());
}

// A faulty renderer may give a state that has no name.
TEST_F(CompareTraceFiles, AStateWithoutANameIsReportedByItsNumber) {
  write_changed("a.h5", [](Trace& trace) { trace.state[410] = 1; });
  for (const int unknown : {7, -1}) {
    write_changed("b.h5", [&](Trace& trace) { trace.state[410] = unknown; });
    const ResultComparison other = compare("a.h5", "b.h5");
    EXPECT_NE(other.outcome, Outcome::same);
    EXPECT_EQ(json_of(other)["divergence"]["baseline"]["state"][1], "contact");
    EXPECT_EQ(json_of(other)["divergence"]["candidate"]["state"][1], unknown);
  }
}

TEST_F(CompareTraceFiles, AnEmptyRunIsNotComparable) {
  write_trace(folder_ / "a.h5", Trace{}, {}, {});
  const ResultComparison none = compare("a.h5", "a.h5");
  EXPECT_EQ(none.outcome, Outcome::not_comparable);
  EXPECT_EQ(none.verdict, "nothing was compared");
  EXPECT_HAS(junit_of(none), "name=\"trace\"><error message=\"nothing was compared\"/>");
  write_hashes(folder_ / "none.h5", {}, {});
  EXPECT_EQ(compare("none.h5", "none.h5").outcome, Outcome::not_comparable);
}

// A configuration that is no JSON: the message names the file.
TEST_F(CompareTraceFiles, ABrokenConfigurationIsNamed) {
  write("a.h5");
  write_trace(folder_ / "b.h5", run(Experiment::load("fig4.12")), {{"config", "{\"seed\":"}}, {});
  EXPECT_HAS(refusal([&] { compare("a.h5", "b.h5"); }), "configuration");
}

// --- reports and figures ---

TEST(Reports, AreWrittenForANameThatIsNotUtf8) {
  ResultComparison comparison{"bad \xff name", "x", "trace"};
  EXPECT_HAS(json_of(comparison)["baseline"].get<std::string>(), "bad ");
  EXPECT_EQ(json_of(comparison)["outcome"], "not_comparable");
}

class CompareFigures : public Compare {
 protected:
  void write(const std::string& name, const std::vector<double>& heights, bool with_second = true,
             const std::string& config = "[]") {
    Figure figure{"4.99", "A figure", "for tests"};
    Table first{"first", ""}, second{"second", ""};
    first.add("x", "m", "", {0, 1, 2}), first.add("height", "m", "", heights);
    second.add("x", "m", "", {5});
    figure.tables = {first};
    if (with_second) figure.tables.push_back(second);
    write_figure(folder_ / name, figure, {{"config", config}});
  }
};

TEST_F(CompareFigures, TablesMayBeAddedButNotMissed) {
  write("a.h5", {1, 2, 3}), write("less.h5", {1, 2, 3}, false);
  const ResultComparison added = compare("less.h5", "a.h5");
  EXPECT_EQ(added.outcome, Outcome::same);
  EXPECT_EQ(json_of(added)["columns_only_in_candidate"], json({"second/x"}));
  const ResultComparison missing = compare("a.h5", "less.h5");
  EXPECT_EQ(missing.outcome, Outcome::changed);
  EXPECT_HAS(junit_of(missing), "name=\"second/x\"><skipped message=\"missing in the candidate\"/>");
  write("other.h5", {1, 2, 3}, false, "[1]");
  EXPECT_EQ(compare("other.h5", "a.h5").outcome, Outcome::changed);  // in either order
  EXPECT_EQ(compare("a.h5", "other.h5").outcome, Outcome::changed);
}

}  // namespace
}  // namespace remote_touch::result_comparison_test
