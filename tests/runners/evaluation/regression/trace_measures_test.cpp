// The measures of two traces: which of them became better or worse.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/storage/result_file.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/runners/evaluation/regression/compared_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::trace_measures_test {
namespace {

using namespace compared_files;

json measure_in(const ResultComparison& comparison, const std::string& name) {
  const json all = json_of(comparison)["measures"];
  for (const json& measure : all)
    if (measure["name"] == name) return measure;
  return {};
}

class CompareMeasuresOfTraces : public Compare {
 protected:
  static Trace run() { return simulate(Experiment::load("fig4.12"), {}); }
  void write(const std::string& name, double end_distance_m) {
    Trace trace = run();
    trace.signed_distance_m.back() = end_distance_m;
    write_trace(folder_ / name, trace, {}, {});
  }
  // One run that holds at its end, and one that has popped through.
  void SetUp() override {
    write("held.h5", 0.005);
    write("lost.h5", -0.01);
  }
};

TEST_F(CompareMeasuresOfTraces, AWorseMeasureIsARegression) {
  const ResultComparison worse = compare("held.h5", "lost.h5");
  EXPECT_EQ(worse.outcome, Outcome::regressed);
  EXPECT_HAS(worse.verdict, "signed_distance of 18 columns, from tick 866 on");
  EXPECT_HAS(worse.verdict, "; worse: popped_through");
  const json measure = measure_in(worse, "popped_through");
  EXPECT_EQ(measure["judgement"], "worse");
  EXPECT_EQ(measure["baseline"], 0);
  EXPECT_EQ(measure["candidate"], 1);
  EXPECT_EQ(measure["direction"], "smaller is better");
  EXPECT_EQ(measure_in(worse, "end_distance")["judgement"], "changed");
  EXPECT_EQ(measure_in(worse, "max_force")["judgement"], "equal");
  EXPECT_HAS(junit_of(worse),
             "name=\"popped_through\"><failure message=\"0 against 1: worse (smaller is better)");
  EXPECT_HAS(junit_of(worse), "name=\"end_distance\"><skipped message=");
  EXPECT_HAS(junit_of(worse), "name=\"max_force\"/>");
}

TEST_F(CompareMeasuresOfTraces, ABetterMeasureIsAChange) {
  const ResultComparison better = compare("lost.h5", "held.h5");
  EXPECT_EQ(better.outcome, Outcome::changed);
  EXPECT_HAS(better.verdict, "; better: popped_through");
  EXPECT_FALSE(contains(junit_of(better), "<failure"));
  EXPECT_HAS(junit_of(better), "name=\"trace\"><skipped message=");
}

// The run that lost the surface would have had the calmer force.
TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereOneRunPoppedThrough) {
  Trace calm = run();
  calm.signed_distance_m.back() = -0.01;
  for (Vec3& force_N : calm.force_N) force_N.setZero();
  write_trace(folder_ / "calm.h5", calm, {}, {});
  const ResultComparison better = compare("calm.h5", "held.h5");
  EXPECT_EQ(better.outcome, Outcome::changed);
  EXPECT_EQ(measure_in(better, "popped_through")["judgement"], "better");
  EXPECT_EQ(measure_in(better, "force_noise")["judgement"], "changed");
  EXPECT_EQ(better.not_judged, "one run popped through: the other measures are not judged");
  EXPECT_EQ(json_of(better)["not_judged"], better.not_judged);
  calm.signed_distance_m.back() = 0.005;
  write_trace(folder_ / "calm.h5", calm, {}, {});
  EXPECT_EQ(compare("calm.h5", "held.h5").not_judged, "");
}

// The runs of two experiments: with noise one run of each shows nothing, without it there is no chance. A new
// build of one experiment is judged in both cases.
TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereNoisyExperimentsDiffer) {
  const auto write_run = [&](const std::string& name, const char* noise, const char* steps, double depth_m) {
    const Experiment experiment = Experiment::load(
        "fig4.12",
        {std::string("scenario.noise_sigma_m=") + noise, std::string("renderer.steps_per_tick=") + steps});
    Trace trace = run();
    trace.signed_distance_m.back() = depth_m;
    write_trace(folder_ / name, trace, {{"config", experiment.to_json()}}, {});
  };
  for (const char* noise : {"0", "0.003"}) {
    write_run("held.h5", noise, "20", 0.005);
    write_run("same.h5", noise, "20", -0.01);
    write_run("other.h5", noise, "10", -0.01);
    EXPECT_EQ(compare("held.h5", "same.h5").outcome, Outcome::regressed);
    const bool is_noisy = std::string(noise) != "0";
    for (const bool forward : {true, false}) {
      const ResultComparison other =
          forward ? compare("held.h5", "other.h5") : compare("other.h5", "held.h5");
      EXPECT_EQ(other.outcome, forward && !is_noisy ? Outcome::regressed : Outcome::changed);
      EXPECT_EQ(measure_in(other, "popped_through")["judgement"], is_noisy  ? "changed"
                                                                  : forward ? "worse"
                                                                            : "better");
      EXPECT_EQ(contains(other.verdict, "one run of each shows no direction"), is_noisy) << other.verdict;
    }
  }
}

// A run that touches nothing can have the smoother force, for example that of guidance.
TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereOneRunHasNoContact) {
  Trace free = run();
  free.signed_distance_m.back() = 0.005;
  for (Vec3& force_N : free.force_N) force_N *= 0.5;
  std::fill(free.contact_count.begin(), free.contact_count.end(), 0);
  write_trace(folder_ / "free.h5", free, {}, {});
  for (const bool forward : {true, false}) {
    const ResultComparison other = forward ? compare("held.h5", "free.h5") : compare("free.h5", "held.h5");
    EXPECT_EQ(other.outcome, Outcome::changed);
    EXPECT_EQ(measure_in(other, "force_noise")["judgement"], "changed");
    EXPECT_EQ(other.not_judged, "a run without contact: measures that need one are not judged");
  }
}

TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereAnOutcomeIsUnknown) {
  write("unknown.h5", kNaN);
  EXPECT_EQ(compare("held.h5", "unknown.h5").not_judged,
            "popped_through is unknown in one run: the other measures are not judged");
}

// The candidate has as many ticks, but lasted twice as long.
TEST_F(CompareMeasuresOfTraces, AreNoneWhereTheTicksAreFartherApart) {
  Trace slow = run();
  for (double& time_s : slow.time_s) time_s *= 2;
  slow.signed_distance_m.back() = -0.01;
  write_trace(folder_ / "slow.h5", slow, {}, {});
  const ResultComparison other = compare("held.h5", "slow.h5");
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_TRUE(other.measures.empty());
  EXPECT_EQ(other.no_measures, "the baseline has a tick every 1 ms, the candidate every 2 ms");
  EXPECT_HAS(other.verdict, "; no measures: the baseline has a tick every 1 ms, the candidate every 2 ms");
}

// A proxy that rests on the surface ends a little in front of it or behind it. The configuration decides
// whether that counts as popped through.
TEST_F(CompareMeasuresOfTraces, SurfelsThatRestOnTheSurfaceDidNotPopThrough) {
  Trace resting = run();
  for (const char* renderer : {"surfels", "proxy"}) {
    const Experiment experiment =
        Experiment::load("fig4.12", {R"(renderer={"name": ")" + std::string(renderer) + "\"}"});
    const TextAttributes attributes = {{"config", experiment.to_json()}};
    resting.signed_distance_m.back() = 1e-6;
    write_trace(folder_ / "front.h5", resting, attributes, {});
    resting.signed_distance_m.back() = -1e-6;
    write_trace(folder_ / "back.h5", resting, attributes, {});
    EXPECT_EQ(measure_in(compare("front.h5", "back.h5"), "popped_through")["judgement"],
              std::string(renderer) == "proxy" ? "worse" : "equal");
  }
}

TEST_F(CompareMeasuresOfTraces, AnUnreadableConfigurationLeavesPopThroughUnknown) {
  Trace lost = run();
  lost.signed_distance_m.back() = -0.01;
  write_trace(folder_ / "newer.h5", lost, {{"config", R"({"renderer": {"name": "of another program"}})"}},
              {});
  const ResultComparison other = compare("held.h5", "newer.h5");
  EXPECT_EQ(measure_in(other, "popped_through")["judgement"], "changed");
  EXPECT_TRUE(measure_in(other, "popped_through")["candidate"].is_null());
  EXPECT_EQ(other.not_judged, "popped_through is unknown in one run: the other measures are not judged");

  lost.signed_distance_m.back() = 0.005;
  write_trace(folder_ / "other.h5", lost, {{"config", R"({"renderer": {"name": "of another program"}})"}},
              {});
  const ResultComparison both = compare("other.h5", "newer.h5");
  EXPECT_EQ(measure_in(both, "popped_through")["judgement"], "changed");
  EXPECT_EQ(both.not_judged, "popped_through is unknown in both runs: the other measures are not judged");
}

// Traces that are the same have the same measures, so these are not computed.
TEST_F(CompareMeasuresOfTraces, AreNotReportedIfEveryColumnIsWithinItsTolerance) {
  ComparisonRules rules;
  rules.tolerances = {{"signed_distance", {1, 0}}};
  const ResultComparison same = compare("held.h5", "lost.h5", rules);
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_TRUE(same.measures.empty());
}

TEST_F(CompareMeasuresOfTraces, HaveTolerances) {
  ComparisonRules rules;
  rules.tolerances = {{"*", {1, 0}}, {"signed_distance", {0, 0}}};
  const ResultComparison other = compare("held.h5", "lost.h5", rules);
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_EQ(measure_in(other, "popped_through")["judgement"], "equal");
  rules.tolerances["popped_through"] = {0, 0};
  EXPECT_EQ(compare("held.h5", "lost.h5", rules).outcome, Outcome::regressed);
}

TEST_F(CompareMeasuresOfTraces, NeedAllColumns) {
  std::vector<Column> columns = run().columns();
  std::erase_if(columns, [](const Column& column) { return column.name == "status"; });
  write_trace(folder_ / "less.h5", columns, {}, {});
  const ResultComparison other = compare("held.h5", "less.h5");
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_HAS(other.verdict, "no measures: a column is missing");
  EXPECT_TRUE(other.measures.empty());
}

TEST(ShortestText, HasTheFewestDigitsThatStateTheNumberExactly) {
  EXPECT_EQ(shortest_text(0.033), "0.033");
  EXPECT_EQ(shortest_text(0), "0");
  EXPECT_EQ(shortest_text(-2), "-2");
  EXPECT_EQ(shortest_text(1e-20), "1e-20");
  EXPECT_EQ(shortest_text(0.1 + 0.2), "0.30000000000000004");  // the last bit counts
}

}  // namespace
}  // namespace remote_touch::trace_measures_test
