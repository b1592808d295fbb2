// The measures of two sweeps and of two traces: what became better or worse, and what is not judged. The
// tests of analysis/sweeps have how measures are judged; here it is what a comparison of files says of it.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <tuple>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/evaluation/regression/compared_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::judged_measures_test {
namespace {

using namespace compared_files;

// --- sweeps ---

class CompareSweepFiles : public Compare {
 protected:
  using Change = std::function<void(SweepResult&)>;
  // A run takes a millisecond.
  static Sweep quick(const std::vector<std::string>& overrides = {}) {
    return Sweep::from_json(R"({"title": "quick", "experiment": "fig4.12",
      "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
      "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3},
               {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 4}],
      "replicates": 20, "measures": ["max_penetration", "popped_through"]})",
                            "quick.json", overrides);
  }
  // Done once: 240 runs.
  static const SweepResult& result() {
    static const SweepResult result = run_sweep(quick(), {});
    return result;
  }
  void write(
      const std::string& name, const Change& change = [](SweepResult&) {}) const {
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
  // Whether the proxy popped through in runs 47 and 48.
  static Change popped(double in_47, double in_48 = 0) {
    return [=](SweepResult& sweep) { event(sweep)[47] = in_47, event(sweep)[48] = in_48; };
  }
  static ComparisonRules rules(bool paired, double margin = ComparisonRules{}.rule.margin) {
    ComparisonRules made;
    made.paired = paired, made.rule.margin = margin;
    return made;
  }
};

TEST_F(CompareSweepFiles, ComparesRunByRun) {
  write("a.h5", popped(0)), write("other.h5", popped(1));
  const ResultComparison other = compare("a.h5", "other.h5");
  EXPECT_EQ(other.kind, "sweep");
  EXPECT_EQ(other.outcome, Outcome::regressed);
  const json sweep = json_of(other)["sweep"];
  EXPECT_EQ(sweep["runs"], 240);
  EXPECT_EQ(sweep["done_in_baseline_only"], 0);
  EXPECT_EQ(sweep["first_difference"], json({{"cell", {0, 2}},
                                             {"replicate", 7},
                                             {"measure", "popped_through"},
                                             {"baseline", 0},
                                             {"candidate", 1}}));
  ASSERT_EQ(sweep["measures"].size(), 2u);
  EXPECT_EQ(sweep["measures"][0]["outside"], 0);
  EXPECT_EQ(sweep["measures"][0]["judgement"], "equal");
  EXPECT_EQ(sweep["measures"][1]["event"], true);
  EXPECT_EQ(sweep["measures"][1]["outside"], 1);
  EXPECT_EQ(sweep["measures"][1]["max"], 1);
  EXPECT_EQ(sweep["measures"][1]["judgement"], "worse");
  EXPECT_EQ(sweep["measures"][1]["direction"], "smaller is better");
  EXPECT_EQ(sweep["regions"].size(), 2u * 13);  // the whole and 3 x 4 parts
  EXPECT_HAS(junit_of(other), "name=\"max_penetration\"/>");
  EXPECT_HAS(junit_of(other), "name=\"popped_through\"><failure message=\"1 of 240 runs outside");
}

struct JudgedSweeps {
  std::function<void(SweepResult&)> baseline, candidate;
  ComparisonRules rules;
  Outcome outcome;
  std::string verdict;
  int failures, errors, skipped;  // parts of two measures, and the whole
};

// The same difference in the other direction is neither a regression nor a pass. Equally many runs that
// became better and worse leave a measure undecided; one of another program has no direction.
TEST_F(CompareSweepFiles, AreJudgedByTheDirectionOfTheirMeasures) {
  const auto same = [](SweepResult&) {};
  const auto own = [](double value) {
    return [value](SweepResult& sweep) { sweep.measures[1].name = "own", event(sweep)[47] = value; };
  };
  const auto failed = [](SweepResult& sweep) {
    sweep.state[47] = RunState::failed, sweep.error[47] = "broken";
    for (Column& measure : sweep.measures) std::get<std::vector<double>>(measure.values)[47] = kNaN;
  };
  const auto flipped = [](SweepResult& sweep) { event(sweep)[100] = 1 - event(sweep)[100]; };
  const auto shifted = [](SweepResult& sweep) {
    for (std::size_t run = 0; run < 60; ++run) event(sweep)[run] = 1;  // they seldom pop if there is no noise
  };
  const std::string lost = "1 are finished in only one of the two sweeps, of which 1 failed in the candidate";
  const ComparisonRules each = rules(false), pairs = rules(true);
  // With a margin of 0.04: 160 runs have random numbers, four others do not. 240 are too few for one of
  // 0.001.
  const JudgedSweeps cases[] = {
      {popped(0), popped(0), each, Outcome::same, "240 runs", 0, 0, 0},
      {popped(0), popped(1), each, Outcome::regressed, "; worse: popped_through", 2, 0, 0},
      {popped(1), popped(0), each, Outcome::changed, "; better: popped_through", 0, 0, 2},
      {popped(1, 0), popped(0, 1), each, Outcome::changed, "; undecided: popped_through", 0, 0, 2},
      {own(0), own(1), each, Outcome::changed, "; changed: own", 0, 0, 2},
      {own(1), own(0), each, Outcome::changed, "; changed: own", 0, 0, 2},
      {same, failed, each, Outcome::regressed, lost, 1, 0, 0},
      {same, failed, pairs, Outcome::regressed, lost, 1, 0, 0},
      {failed, same, each, Outcome::changed, "", 0, 0, 1},
      {failed, same, pairs, Outcome::changed, "", 0, 0, 1},
      {same, flipped, rules(true, 0.04), Outcome::same,
       "all changes are within the margins (0.04 of the runs for events", 0, 0, 0},
      {same, flipped, rules(true, 1e-3), Outcome::not_comparable, "too few runs to be sure", 0, 2, 0},
      {same, flipped, rules(true, 1e-3), Outcome::not_comparable, "undecided: popped_through", 0, 2, 0},
      {same, shifted, pairs, Outcome::regressed, "worse: popped_through", 2, 0, 0},
      {shifted, same, pairs, Outcome::changed, "better: popped_through", 0, 0, 2}};
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    SCOPED_TRACE(i);
    write("a.h5", cases[i].baseline), write("b.h5", cases[i].candidate);
    const ResultComparison found = compare("a.h5", "b.h5", cases[i].rules);
    EXPECT_EQ(found.outcome, cases[i].outcome);
    EXPECT_HAS(found.verdict, cases[i].verdict);
    EXPECT_HAS(junit_of(found), counts(3, cases[i].failures, cases[i].errors, cases[i].skipped));
  }
}

TEST_F(CompareSweepFiles, OtherRunsAreNotComparable) {
  write("a.h5");
  const SweepResult& runs = result();
  const std::tuple<const char*, const SweepResult*, const char*> cases[] = {
      {"seed=5", &runs, "experiment.seed 1 against 5: the runs had different noise"},
      {"duration_s=0.7", &runs, ": measures of another duration cannot be compared"},
      {"axes.1.to=6", nullptr, "axis acceleration_m_per_s2: the values differ"},
      {"axes.0.count=2", nullptr, "axis noise_sigma_m, values: 3 against 2"},
      {"replicates=3", nullptr, "replicates"}};
  for (const auto& [change, stored, why] : cases) {
    const Sweep other = quick({change});
    write_sweep(folder_ / "b.h5", stored ? *stored : other.plan(), attributes(other));
    for (const bool in_pairs : {false, true}) {
      const ResultComparison comparison = compare("a.h5", "b.h5", rules(in_pairs));
      EXPECT_EQ(comparison.outcome, Outcome::not_comparable) << change;
      EXPECT_HAS(comparison.verdict, why);
      EXPECT_HAS(junit_of(comparison), counts(1, 0, 1));
    }
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

// --- traces ---

json measure_in(const ResultComparison& comparison, const std::string& name) {
  const json all = json_of(comparison)["measures"];
  for (const json& measure : all)
    if (measure["name"] == name) return measure;
  return {};
}

class CompareMeasuresOfTraces : public Compare {
 protected:
  // Writes a run that ends at this distance. change: made after that.
  void write(
      const std::string& name, double end_distance_m, const std::string& config = {},
      const std::function<void(Trace&)>& change = [](Trace&) {}) const {
    static const Trace run = simulate(Experiment::load("fig4.12"), {});
    Trace trace = run;
    trace.signed_distance_m.back() = end_distance_m;
    change(trace);
    write_trace(folder_ / name, trace, config.empty() ? TextAttributes{} : TextAttributes{{"config", config}},
                {});
  }
  static std::string config_with(const std::vector<std::string>& overrides) {
    return Experiment::load("fig4.12", overrides).to_json();
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

// The run that lost the surface would have had the calmer force. A run that touches nothing can have the
// smoother force, for example that of guidance.
TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereOneRunLostTheSurfaceOrDidNotTouchIt) {
  const auto calm = [](Trace& trace) {
    for (Vec3& force_N : trace.force_N) force_N.setZero();
  };
  const auto free = [](Trace& trace) {
    for (Vec3& force_N : trace.force_N) force_N *= 0.5;
    std::fill(trace.contact_count.begin(), trace.contact_count.end(), 0);
  };
  write("calm.h5", -0.01, "", calm), write("free.h5", 0.005, "", free);
  const ResultComparison better = compare("calm.h5", "held.h5");
  EXPECT_EQ(better.outcome, Outcome::changed);
  EXPECT_EQ(measure_in(better, "popped_through")["judgement"], "better");
  EXPECT_EQ(measure_in(better, "force_noise")["judgement"], "changed");
  EXPECT_EQ(better.not_judged, "one run popped through: the other measures are not judged");
  EXPECT_EQ(json_of(better)["not_judged"], better.not_judged);
  for (const auto& [baseline, candidate] : {std::pair("held.h5", "free.h5"), {"free.h5", "held.h5"}}) {
    const ResultComparison other = compare(baseline, candidate);
    EXPECT_EQ(other.outcome, Outcome::changed);
    EXPECT_EQ(measure_in(other, "force_noise")["judgement"], "changed");
    EXPECT_EQ(other.not_judged, "a run without contact: measures that need one are not judged");
  }
  write("calm.h5", 0.005, "", calm);
  EXPECT_EQ(compare("calm.h5", "held.h5").not_judged, "");
}

// The runs of two experiments: with noise one run of each shows nothing, without it there is no chance. A new
// build of one experiment is judged in both cases.
TEST_F(CompareMeasuresOfTraces, AreNotJudgedWhereNoisyExperimentsDiffer) {
  for (const std::string noise : {"0", "0.003"}) {
    const bool is_noisy = noise != "0";
    const auto config = [&](const char* steps) {
      return config_with(
          {"scenario.noise_sigma_m=" + noise, std::string("renderer.steps_per_tick=") + steps});
    };
    write("held.h5", 0.005, config("20"));
    write("same.h5", -0.01, config("20"));
    write("other.h5", -0.01, config("10"));
    EXPECT_EQ(compare("held.h5", "same.h5").outcome, Outcome::regressed);
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

// The candidate has as many ticks, but lasted twice as long; or it lacks a column.
TEST_F(CompareMeasuresOfTraces, AreNoneOfOtherTicksOrColumns) {
  write("slow.h5", -0.01, "", [](Trace& trace) {
    for (double& time_s : trace.time_s) time_s *= 2;
  });
  std::vector<Column> columns = simulate(Experiment::load("fig4.12"), {}).columns();
  std::erase_if(columns, [](const Column& column) { return column.name == "status"; });
  write_trace(folder_ / "less.h5", columns, {}, {});
  for (const auto& [candidate, why] :
       {std::pair("slow.h5", "the baseline has a tick every 1 ms, the candidate every 2 ms"),
        {"less.h5", "a column is missing"}}) {
    const ResultComparison other = compare("held.h5", candidate);
    EXPECT_EQ(other.outcome, Outcome::changed);
    EXPECT_TRUE(other.measures.empty());
    EXPECT_HAS(other.verdict, std::string("; no measures: ") + why);
  }
}

// A proxy that rests on the surface ends a little in front of it or behind it. The configuration decides
// whether that counts as popped through.
TEST_F(CompareMeasuresOfTraces, SurfelsThatRestOnTheSurfaceDidNotPopThrough) {
  for (const std::string renderer : {"surfels", "proxy"}) {
    const std::string config = config_with({R"(renderer={"name": ")" + renderer + "\"}"});
    write("front.h5", 1e-6, config), write("back.h5", -1e-6, config);
    EXPECT_EQ(measure_in(compare("front.h5", "back.h5"), "popped_through")["judgement"],
              renderer == "proxy" ? "worse" : "equal");
  }
}

TEST_F(CompareMeasuresOfTraces, AnUnreadableConfigurationLeavesPopThroughUnknown) {
  const std::string foreign = R"({"renderer": {"name": "of another program"}})";
  write("newer.h5", -0.01, foreign), write("other.h5", 0.005, foreign);
  for (const auto& [baseline, runs] : {std::pair("held.h5", "one run"), {"other.h5", "both runs"}}) {
    const ResultComparison other = compare(baseline, "newer.h5");
    EXPECT_EQ(measure_in(other, "popped_through")["judgement"], "changed");
    EXPECT_TRUE(measure_in(other, "popped_through")["candidate"].is_null());
    EXPECT_EQ(other.not_judged,
              std::string("popped_through is unknown in ") + runs + ": the other measures are not judged");
  }
}

// Traces that are the same have the same measures, so these are not computed.
TEST_F(CompareMeasuresOfTraces, HaveTolerances) {
  ComparisonRules rules;
  rules.tolerances = {{"*", {1, 0}}, {"signed_distance", {0, 0}}};
  const ResultComparison other = compare("held.h5", "lost.h5", rules);
  EXPECT_EQ(other.outcome, Outcome::changed);
  EXPECT_EQ(measure_in(other, "popped_through")["judgement"], "equal");
  rules.tolerances["popped_through"] = {0, 0};
  EXPECT_EQ(compare("held.h5", "lost.h5", rules).outcome, Outcome::regressed);
  rules.tolerances = {{"signed_distance", {1, 0}}};
  const ResultComparison same = compare("held.h5", "lost.h5", rules);
  EXPECT_EQ(same.outcome, Outcome::same);
  EXPECT_TRUE(same.measures.empty());
}

TEST(ShortestText, HasTheFewestDigitsThatStateTheNumberExactly) {
  EXPECT_EQ(shortest_text(0.033), "0.033");
  EXPECT_EQ(shortest_text(-2), "-2");
  EXPECT_EQ(shortest_text(1e-20), "1e-20");
  EXPECT_EQ(shortest_text(0.1 + 0.2), "0.30000000000000004");  // the last bit counts
}

}  // namespace
}  // namespace remote_touch::judged_measures_test
