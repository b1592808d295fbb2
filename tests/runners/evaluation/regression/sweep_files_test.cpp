// Comparison of files of sweeps.
#include "runners/evaluation/regression/result_comparison.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "analysis/sweeps/sweep_file.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/evaluation/regression/compared_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_files_test {
namespace {

using namespace compared_files;

// --- sweeps ---

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 4}],
  "replicates": 20, "measures": ["max_penetration", "popped_through"]})";

class CompareSweepFiles : public Compare {
 protected:
  using Change = std::function<void(SweepResult&)>;
  static Sweep quick(const std::vector<std::string>& overrides = {}) {
    return Sweep::from_json(kQuick, "quick.json", overrides);
  }
  // Done once: 240 runs.
  static const SweepResult& result() {
    static const SweepResult result = run_sweep(quick(), {});
    return result;
  }
  void write(
      const std::string& name, const Change& change = [](SweepResult&) {}) {
    SweepResult other = result();
    change(other);
    write_sweep(folder_ / name, other, attributes(quick()));
  }
  static TextAttributes attributes(const Sweep& sweep) {
    return {{"config", sweep.to_json()}, {"shard", "1/1"}};
  }
  static std::vector<double>& event(SweepResult& sweep) {
    return std::get<std::vector<double>>(sweep.measures.at(1).values);
  }
  static void flip(SweepResult& sweep, std::size_t run) { event(sweep)[run] = 1 - event(sweep)[run]; }
  ComparisonRules paired() const {
    ComparisonRules rules;
    rules.paired = true;
    return rules;
  }
};

TEST_F(CompareSweepFiles, RunsOfAnotherDurationAreNotComparable) {
  write("a.h5");
  write_sweep(folder_ / "short.h5", result(), attributes(quick({"duration_s=0.7"})));
  const ResultComparison other = compare("a.h5", "short.h5");
  EXPECT_EQ(other.outcome, Outcome::not_comparable);
  EXPECT_HAS(other.verdict, "experiment.duration_s ");
  EXPECT_HAS(other.verdict, ": measures of another duration cannot be compared");
}

TEST_F(CompareSweepFiles, ComparesRunByRun) {
  for (const char* name : {"a.h5", "b.h5"}) write(name, [](SweepResult& sweep) { event(sweep)[47] = 0; });
  write("other.h5", [](SweepResult& sweep) { event(sweep)[47] = 1; });
  const ResultComparison same = compare("a.h5", "b.h5");
  EXPECT_EQ(same.kind, "sweep");
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_HAS(same.verdict, "240 runs");
  EXPECT_HAS(junit_of(same), counts(3, 0, 0));  // two measures and the whole
  const ResultComparison other = compare("a.h5", "other.h5");
  EXPECT_EQ(other.outcome, Outcome::regressed);
  const json sweep = json_of(other)["sweep"];
  EXPECT_EQ(sweep["runs"], 240);
  EXPECT_EQ(sweep["done_in_baseline_only"], 0);
  EXPECT_EQ(sweep["first_difference"]["cell"], json({0, 2}));
  EXPECT_EQ(sweep["first_difference"]["replicate"], 7);
  EXPECT_EQ(sweep["first_difference"]["measure"], "popped_through");
  EXPECT_EQ(sweep["first_difference"]["baseline"], 0);
  EXPECT_EQ(sweep["first_difference"]["candidate"], 1);
  ASSERT_EQ(sweep["measures"].size(), 2u);
  EXPECT_EQ(sweep["measures"][0]["outside"], 0);
  EXPECT_EQ(sweep["measures"][1]["event"], true);
  EXPECT_EQ(sweep["measures"][1]["outside"], 1);
  EXPECT_EQ(sweep["measures"][1]["max"], 1);
  EXPECT_EQ(sweep["regions"].size(), 2u * 13);  // the whole and 3 x 4 parts
  EXPECT_HAS(junit_of(other), counts(3, 2, 0));
  EXPECT_HAS(junit_of(other), "name=\"max_penetration\"/>");
  EXPECT_HAS(junit_of(other), "name=\"popped_through\"><failure message=\"1 of 240 runs outside");
  EXPECT_HAS(other.verdict, "; worse: popped_through");
  EXPECT_EQ(sweep["measures"][0]["judgement"], "equal");
  EXPECT_EQ(sweep["measures"][1]["judgement"], "worse");
  EXPECT_EQ(sweep["measures"][1]["direction"], "smaller is better");
}

// The same difference in the other direction is neither a regression nor a pass.
TEST_F(CompareSweepFiles, AnImprovementIsAChange) {
  write("a.h5", [](SweepResult& sweep) { event(sweep)[47] = 1; });
  write("b.h5", [](SweepResult& sweep) { event(sweep)[47] = 0; });
  const ResultComparison better = compare("a.h5", "b.h5");
  EXPECT_EQ(better.outcome, Outcome::changed);
  EXPECT_HAS(better.verdict, "; better: popped_through");
  EXPECT_EQ(json_of(better)["outcome"], "changed");
  EXPECT_EQ(json_of(better)["sweep"]["measures"][1]["judgement"], "better");
  EXPECT_HAS(junit_of(better), counts(3, 0, 0, 2));
  EXPECT_HAS(junit_of(better), "name=\"popped_through\"><skipped message=\"1 of 240 runs outside");
}

// Equally many runs became better and worse, so that the measure is neither.
TEST_F(CompareSweepFiles, ChangesInBothDirectionsAreUndecided) {
  write("a.h5", [](SweepResult& sweep) { event(sweep)[47] = 1, event(sweep)[48] = 0; });
  write("b.h5", [](SweepResult& sweep) { event(sweep)[47] = 0, event(sweep)[48] = 1; });
  const ResultComparison other = compare("a.h5", "b.h5");
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_HAS(other.verdict, "; undecided: popped_through");
  EXPECT_HAS(junit_of(other), counts(3, 0, 0, 2));
}

// A program's own measure has no direction by default.
TEST_F(CompareSweepFiles, AMeasureWithoutADirectionIsOnlyAnother) {
  const auto as_own = [](double value) {
    return [value](SweepResult& sweep) { sweep.measures[1].name = "own", event(sweep)[47] = value; };
  };
  write("a.h5", as_own(0)), write("b.h5", as_own(1));
  for (const auto& [baseline, candidate] : {std::pair("a.h5", "b.h5"), std::pair("b.h5", "a.h5")}) {
    const ResultComparison other = compare(baseline, candidate);
    EXPECT_EQ(other.outcome, Outcome::changed);
    EXPECT_HAS(other.verdict, "; changed: own");
  }
}

TEST_F(CompareSweepFiles, ARunThatFailsNowIsWorse) {
  write("a.h5");
  write("b.h5", [](SweepResult& sweep) {
    sweep.state[47] = RunState::failed, sweep.error[47] = "broken";
    for (Column& measure : sweep.measures) std::get<std::vector<double>>(measure.values)[47] = kNaN;
  });
  for (const bool in_pairs : {false, true}) {
    ComparisonRules rules;
    rules.paired = in_pairs;
    const ResultComparison failed = compare("a.h5", "b.h5", rules);
    EXPECT_EQ(failed.outcome, Outcome::regressed);
    EXPECT_HAS(failed.verdict,
               "1 are finished in only one of the two sweeps, of which 1 failed in the candidate");
    EXPECT_EQ(compare("b.h5", "a.h5", rules).outcome, Outcome::changed);
  }
}

TEST_F(CompareSweepFiles, PairedTestsIgnoreAFlipAndReportAShift) {
  write("a.h5");
  write("flip.h5", [](SweepResult& sweep) { flip(sweep, 100); });
  write("shift.h5", [](SweepResult& sweep) {
    for (std::size_t run = 0; run < 60; ++run) event(sweep)[run] = 1;  // they seldom pop if there is no noise
  });
  EXPECT_EQ(compare("a.h5", "a.h5", paired()).outcome, Outcome::same);
  ComparisonRules wide = paired();
  wide.rule.margin = 0.04;  // 160 runs have random numbers, four others do not
  const ResultComparison flipped = compare("a.h5", "flip.h5", wide);
  EXPECT_EQ(flipped.outcome, Outcome::same);
  EXPECT_HAS(flipped.verdict, "all changes are within the margins (0.04 of the runs for events");
  EXPECT_HAS(junit_of(flipped), counts(3, 0, 0));
  const ResultComparison shifted = compare("a.h5", "shift.h5", paired());
  EXPECT_EQ(shifted.outcome, Outcome::regressed);
  EXPECT_HAS(shifted.verdict, "worse: popped_through");
  EXPECT_HAS(junit_of(shifted), counts(3, 2, 0));
  const ResultComparison back = compare("shift.h5", "a.h5", paired());
  EXPECT_EQ(back.outcome, Outcome::changed);
  EXPECT_HAS(back.verdict, "better: popped_through");
  EXPECT_HAS(junit_of(back), counts(3, 0, 0, 2));
  // The runs are too few for so narrow a margin, so the outcome is neither the same nor changed.
  ComparisonRules narrow = paired();
  narrow.rule.margin = 1e-3;
  const ResultComparison undecided = compare("a.h5", "flip.h5", narrow);
  EXPECT_EQ(undecided.outcome, Outcome::not_comparable);
  EXPECT_HAS(undecided.verdict, "too few runs to be sure");
  EXPECT_HAS(undecided.verdict, "undecided: popped_through");
  EXPECT_HAS(junit_of(undecided), counts(3, 0, 2));
}

TEST_F(CompareSweepFiles, SweepsOfAnotherSeedAreNotComparable) {
  write("a.h5");
  const Sweep other = quick({"seed=5"});
  write_sweep(folder_ / "b.h5", result(), attributes(other));
  for (const bool in_pairs : {false, true}) {
    ComparisonRules rules;
    rules.paired = in_pairs;
    const ResultComparison comparison = compare("a.h5", "b.h5", rules);
    EXPECT_EQ(comparison.outcome, Outcome::not_comparable);
    EXPECT_HAS(comparison.verdict, "experiment.seed 1 against 5: the runs had different noise");
    EXPECT_HAS(junit_of(comparison), counts(1, 0, 1));
  }
}

TEST_F(CompareSweepFiles, OtherAxesAreNotComparable) {
  write("a.h5");
  for (const char* change : {"axes.1.to=6", "axes.0.count=2", "replicates=3"}) {
    const Sweep other = quick({change});
    SweepResult plan = other.plan();
    write_sweep(folder_ / "b.h5", plan, attributes(other));
    const ResultComparison comparison = compare("a.h5", "b.h5");
    EXPECT_EQ(comparison.outcome, Outcome::not_comparable) << change;
    EXPECT_FALSE(json_of(comparison)["sweep"]["problems"].empty());
  }
}

// The change is reported. The sweeps are comparable because their runs still form pairs.
TEST_F(CompareSweepFiles, SweepsOfAnotherConfigurationAreComparable) {
  write("a.h5");
  const Sweep other = quick({"renderer.r1_m=0.0045"});
  write_sweep(folder_ / "b.h5", run_sweep(other, {}), attributes(other));
  const ResultComparison comparison = compare("a.h5", "b.h5");
  EXPECT_NE(comparison.outcome, Outcome::same);
  EXPECT_NE(comparison.outcome, Outcome::not_comparable);
  EXPECT_TRUE(any_has(comparison.configuration, "renderer.r1_m"));
}

TEST_F(CompareSweepFiles, AnUnfinishedOneLacksRuns) {
  write("a.h5");
  SweepResult part = result();
  for (std::size_t run = 100; run < part.run_count(); ++run) {
    part.state[run] = RunState::pending;
    for (Column& measure : part.measures) std::get<std::vector<double>>(measure.values)[run] = kNaN;
  }
  write_sweep_in_progress(folder_ / "part.h5", part, attributes(quick()));
  for (const bool in_pairs : {false, true}) {
    ComparisonRules rules;
    rules.paired = in_pairs;
    for (const auto& [baseline, candidate] : {std::pair("a.h5", "part.h5"), std::pair("part.h5", "a.h5")}) {
      const ResultComparison comparison = compare(baseline, candidate, rules);
      EXPECT_EQ(comparison.outcome, Outcome::changed);
      EXPECT_HAS(comparison.verdict, "140 are finished in only one of the two sweeps");
      EXPECT_EQ(json_of(comparison)["sweep"]["runs"], 100);
    }
  }
  EXPECT_EQ(json_of(compare("a.h5", "part.h5"))["sweep"]["done_in_baseline_only"], 140);
  EXPECT_EQ(json_of(compare("part.h5", "a.h5"))["sweep"]["done_in_candidate_only"], 140);
}

TEST_F(CompareSweepFiles, AToleranceMustNameAMeasure) {
  write("a.h5");
  write("b.h5", [](SweepResult& sweep) {
    for (double& value : std::get<std::vector<double>>(sweep.measures[0].values)) value += 1e-9;
  });
  EXPECT_EQ(compare("a.h5", "b.h5").outcome, Outcome::regressed);
  ComparisonRules rules;
  rules.tolerances = {{"max_penetration", {2e-9, 0}}};
  EXPECT_EQ(compare("a.h5", "b.h5", rules).outcome, Outcome::same);
  rules.tolerances = {{"tool_penetration", {1, 0}}};
  const ResultComparison misspelt = compare("a.h5", "b.h5", rules);
  EXPECT_EQ(misspelt.outcome, Outcome::not_comparable);
  EXPECT_HAS(misspelt.verdict, "penetration, which the baseline does not measure");
}

}  // namespace
}  // namespace remote_touch::sweep_files_test
