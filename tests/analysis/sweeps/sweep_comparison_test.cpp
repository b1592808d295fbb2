// Comparison of two sweeps, on results made by hand.
#include "analysis/sweeps/sweep_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "analysis/trace/interval_estimates.h"
#include "tests/analysis/sweeps/example_sweeps.h"

namespace remote_touch::sweep_comparison_test {
namespace {

using namespace made_sweeps;

TEST(CompareSweeps, EqualSweepsAreEqualWhateverTheyHold) {
  SweepResult a = map();
  depth(a)[3] = kNaN, depth(a)[4] = kInfinity, depth(a)[5] = 1e-300;
  const SweepComparison c = compare(a, a);
  EXPECT_TRUE(c.problems.empty() && c.notes.empty());
  EXPECT_TRUE(c.is_equal());
  EXPECT_EQ(c.paired, PairedVerdict::equal);
  EXPECT_FALSE(c.first);
  EXPECT_EQ(c.done_in_both, 5396u);
  EXPECT_EQ(c.measures[1].compared, 5396);
  EXPECT_EQ(c.measures[1].outside, 0);
  EXPECT_TRUE(c.measures[0].event);
  EXPECT_FALSE(c.measures[1].event);
  ASSERT_EQ(c.by_region.size(), 20u);
  for (const RegionComparison& r : c.by_region) EXPECT_EQ(r.judgement, Judgement::equal);
}

TEST(CompareSweeps, NamesTheFirstDifference) {
  SweepResult a = sweep({numbers("x", 5, 1), names("mode", {"on", "off"})}, 3), b = a;
  depth(a)[2] = 1e-20, depth(b)[2] = 1e-20;
  depth(a)[23] = 1e-20, depth(b)[23] = 2e-20;
  depth(b)[29] = 1;
  flip(a, b, 25, true);
  const SweepComparison c = compare(a, b);
  EXPECT_FALSE(c.is_equal());
  ASSERT_TRUE(c.first);
  EXPECT_EQ(c.first->run, 23u);
  EXPECT_EQ(c.first->cell, 7u);
  EXPECT_EQ(c.first->axis_indices, (std::vector<std::size_t>{3, 1}));
  EXPECT_EQ(c.first->replicate, 2);
  EXPECT_EQ(c.first->measure, "depth");
  EXPECT_EQ(c.first->baseline, 1e-20);
  EXPECT_EQ(c.first->candidate, 2e-20);
  EXPECT_EQ(c.measures[1].outside, 2);
  EXPECT_EQ(c.measures[1].first_outside, 23u);
  EXPECT_EQ(c.measures[1].max_deviation, 1);
  EXPECT_NEAR(c.measures[1].rms_deviation, std::sqrt(1.0 / 30), 1e-15);
  EXPECT_EQ(c.measures[0].first_outside, 25u);
  flip(a, b, 23, true);  // the first measure of the run is named
  EXPECT_EQ(compare(a, b).first->measure, "event");
}

TEST(CompareSweeps, EveryMeasureHasItsTolerance) {
  SweepResult a = row(8), b = a;
  depth(a)[1] = 1e-20, depth(b)[1] = 2e-20;
  flip(a, b, 2, true);
  const auto outside = [&](const Tolerances& tolerances) {
    const SweepComparison c = compare(a, b, tolerances);
    return std::make_pair(c.measures[0].outside, c.measures[1].outside);
  };
  EXPECT_EQ(outside({}), (std::pair<std::int64_t, std::int64_t>{1, 1}));
  EXPECT_EQ(outside({{"*", {1e-20, 0}}}), (std::pair<std::int64_t, std::int64_t>{1, 0}));
  EXPECT_EQ(outside({{"*", {1e-20, 0}}, {"depth", {}}}), (std::pair<std::int64_t, std::int64_t>{1, 1}));
  EXPECT_EQ(outside({{"depth", {0, 1}}}), (std::pair<std::int64_t, std::int64_t>{1, 0}));
  EXPECT_EQ(outside({{"*", {1, 0}}}), (std::pair<std::int64_t, std::int64_t>{0, 0}));
  EXPECT_EQ(compare(a, b, {{"*", {1, 0}}}).paired, PairedVerdict::equal);
}

TEST(CompareSweeps, ANumberAgainstNoneIsNeverAPass) {
  for (const double none : {kNaN, kInfinity})
    for (const bool in_candidate : {false, true}) {
      SweepResult a = map(), b = a;
      (in_candidate ? depth(b) : depth(a))[100] = none;
      const SweepComparison c = compare(a, b, {{"*", {1, 1}}});
      EXPECT_FALSE(c.is_equal());
      EXPECT_EQ(c.measures[1].outside, 1);
      EXPECT_EQ(c.measures[1].max_deviation, 0);
      EXPECT_EQ(c.at(0, 1).unpaired, 1);
      EXPECT_EQ(c.at(0, 1).pairs, 5395);
      EXPECT_EQ(whole(c, 1), Judgement::changed);
      EXPECT_EQ(c.paired, PairedVerdict::changed);
    }
  SweepResult a = map(), b = a;
  event(a)[6] = event(b)[6] = 1, event(b)[7] = 0.5;  // neither 0 nor 1
  const SweepComparison c = compare(a, b);
  EXPECT_TRUE(c.measures[0].event);
  EXPECT_EQ(c.at(0, 0).unpaired, 1);
  EXPECT_EQ(c.paired, PairedVerdict::changed);
}

// The changes go up as often as down, but are far larger than the differences between runs. They are not
// shown to be within the margin.
TEST(CompareSweeps, LargeChangesBothWaysAreNoPass) {
  SweepResult a = map(), b = a;
  for (std::size_t run = 0; run < depth(b).size(); ++run) depth(b)[run] += run % 2 == 0 ? 1e6 : -1e6;
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::undecided);
  SweepResult few = a;
  for (std::size_t run = 0; run < 4; ++run) depth(few)[run] += 1e6;
  EXPECT_EQ(compare(a, few).paired, PairedVerdict::undecided);
}

// The runs that a refinement adds depend on the results, so only the runs of the first round must be done in
// both.
TEST(CompareSweeps, RefinedSweepsAreJudgedByTheirFirstRound) {
  SweepResult a = map(), b = a;
  a.round.assign(a.run_count(), 0), a.round[3] = a.round[4] = 1;
  b.round = a.round;
  b.state[3] = RunState::not_sampled, b.round[3] = -1;
  flip(a, b, 4, true);
  EXPECT_FALSE(compare(a, b).is_equal());
  EXPECT_EQ(compare(a, b).at(0, 0).runs, static_cast<std::int64_t>(a.run_count()) - 2);
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::within_margin);
  b.state[5] = RunState::failed;
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::runs_missing);
}

TEST(CompareSweeps, ARunDoneInOneOnlyIsNamedAndNoPass) {
  for (const RunState state :
       {RunState::not_sampled, RunState::pending, RunState::failed, RunState::elsewhere}) {
    SweepResult a = map(), b = a;
    a.state[7] = a.state[9] = b.state[5] = state;
    a.state[11] = RunState::failed, b.state[11] = RunState::pending;
    depth(b)[6] = 1;
    const SweepComparison c = compare(a, b);
    EXPECT_FALSE(c.is_equal());
    EXPECT_EQ(c.paired, PairedVerdict::runs_missing);
    EXPECT_EQ(c.baseline_only, std::vector<std::size_t>{5});
    EXPECT_EQ(c.candidate_only, (std::vector<std::size_t>{7, 9}));
    EXPECT_EQ(c.done_in_both, 5392u);
    EXPECT_EQ(c.first->run, 5u);
    EXPECT_EQ(c.first->measure, "");
    EXPECT_EQ(c.notes, Texts{"runs done in neither: 1"});
    a.state[7] = a.state[9] = RunState::done;
    EXPECT_EQ(compare(a, b).paired, PairedVerdict::runs_missing);
    EXPECT_EQ(compare(b, a).paired, PairedVerdict::runs_missing);
  }
}

TEST(CompareSweeps, SaysWhyTheyAreNotComparable) {
  const SweepResult a = sweep({numbers("x", 6, 1), names("mode", {"on", "off"})}, 2);
  const struct {
    const char* problem;
    std::function<void(SweepResult& b)> change;
  } rows[] = {{"axes: 2 against 1", [](auto& b) { b.axes.pop_back(); }},
              {"axis: x against y", [](auto& b) { b.axes[0].name = "y"; }},
              {"axis x, parameter: scenario.x against trajectory.x",
               [](auto& b) { b.axes[0].long_name = "trajectory.x"; }},
              {"axis x, unit: 1 against m", [](auto& b) { b.axes[0].units = "m"; }},
              {"axis x, values: 6 against 7", [](auto& b) { b.axes[0] = numbers("x", 7, 1); }},
              {"axis x: the values differ", [](auto& b) { b.axes[0] = numbers("x", 6, 1 + 1e-15); }},
              {"axis x: the values differ",
               [](auto& b) { std::get<std::vector<double>>(b.axes[0].values)[0] = -0.0; }},
              {"axis mode: the values differ", [](auto& b) { b.axes[1].value_names[1] = "auto"; }},
              {"replicates: 2 against 3", [](auto& b) { b.replicates = 3; }},
              {"measure depth: the candidate has none", [](auto& b) { b.measures.pop_back(); }},
              {"measure depth, unit: m against mm", [](auto& b) { b.measures[1].units = "mm"; }},
              {"measure depth: comes before event in the candidate",
               [](auto& b) { std::swap(b.measures[0], b.measures[1]); }},
              {"no run is done in both", [](auto& b) { b.state.assign(b.run_count(), RunState::failed); }}};
  for (const auto& row : rows) {
    SweepResult b = a;
    row.change(b);
    const SweepComparison c = compare(a, b);
    EXPECT_EQ(c.problems, Texts{row.problem});
    EXPECT_EQ(c.paired, PairedVerdict::not_comparable);
    EXPECT_TRUE(c.by_region.empty());
  }
  EXPECT_EQ(compare(a, a, {{"force", {1, 0}}}).problems,
            Texts{"a tolerance is given for force, which the baseline does not measure"});
  SweepResult none = a;
  none.axes[0].units = "m", none.measures.clear();
  EXPECT_EQ(compare(a, none).problems.size(), 3u);
  EXPECT_EQ(compare(none, none).problems, Texts{"the baseline has no measures"});
}

TEST(CompareSweeps, WhatDoesNotMatterIsANote) {
  SweepResult a = row(6), b = a;
  a.state[3] = b.state[3] = RunState::not_sampled, depth(b)[3] = 1;
  b.measures.insert(b.measures.begin() + 1, {"force", "N", "", std::vector<double>(6, 1.0)});
  const SweepComparison c = compare(a, b);
  EXPECT_TRUE(c.is_equal());
  EXPECT_EQ(c.notes, (Texts{"measure force: only the candidate has it", "runs done in neither: 1"}));
  EXPECT_FALSE(compare(b, a).problems.empty());
}

Texts labels(std::vector<Column> axes) {
  const SweepResult a = sweep(std::move(axes), 1);
  const SweepComparison c = compare(a, a);
  Texts labels;
  for (const Region& region : c.regions) labels.push_back(region.label);
  // Every cell is in the whole and, when there are parts, in one of them.
  for (std::size_t cell = 0; cell < a.cell_count(); ++cell) {
    std::size_t count = 0;
    for (const Region& region : c.regions) count += region.contains(a.axis_indices(cell)) ? 1 : 0;
    EXPECT_EQ(count, c.regions.size() == 1 ? 1u : 2u);
  }
  return labels;
}

TEST(Regions, AreThirdsOfNumbersAndSingleValuesOfShortAxes) {
  EXPECT_EQ(labels({numbers("x", 1, 1)}), Texts{"all runs"});
  EXPECT_EQ(labels({numbers("x", 5, 1)}), Texts{"all runs"});
  EXPECT_EQ(labels({names("mode", {"a", "b", "c", "d", "e", "f"})}), Texts{"all runs"});
  EXPECT_EQ(labels({numbers("x", 7, 0.1)}),
            (Texts{"all runs", "x 0 to 0.1", "x 0.2 to 0.3", "x 0.4 to 0.6"}));
  EXPECT_EQ(labels({numbers("x", 2, 0.1), numbers("y", 5, 1), names("mode", {"on", "off"})}),
            (Texts{"all runs", "x 0, mode on", "x 0, mode off", "x 0.1, mode on", "x 0.1, mode off"}));
  const Texts map = labels({numbers("sigma", 76, 0.0002), numbers("acceleration", 71, 0.1)});
  ASSERT_EQ(map.size(), 10u);
  EXPECT_EQ(map[2], "sigma 0 to 0.0048, acceleration 2.3 to 4.6");
}

// Three axes with three parts each make 27 parts, and a fourth axis would make too many. Axes a, b and d make
// 4 x 4 x 2 = 32 parts; axis c would make too many.
TEST(Regions, AreAtMost36) {
  const auto axis = [](const char* name, std::size_t count) { return numbers(name, count, 1); };
  EXPECT_EQ(labels({axis("a", 6), axis("b", 6), axis("c", 6), axis("d", 6)}).size(), 28u);
  EXPECT_EQ(labels({axis("a", 4), axis("b", 3), axis("c", 3)}).size(), 37u);
  EXPECT_EQ(labels({axis("a", 4), axis("b", 4), axis("c", 3), axis("d", 2)}).back(), "a 3, b 3, d 1");
}

TEST(RegionComparison, CountsEventsByHand) {
  SweepResult a = sweep({numbers("x", 2, 1)}, 50), b = a;
  for (std::size_t run = 0; run < 50; ++run) event(a)[run] = event(b)[run] = run < 20 ? 1 : 0;
  for (const std::size_t run : {0, 1, 2}) event(b)[run] = 0;
  for (const std::size_t run : {30, 31, 32, 33, 34, 35, 36, 99}) event(b)[run] = 1;
  event(a)[49] = event(b)[49] = kNaN;
  const SweepComparison c = compare(a, b);
  const RegionComparison& first = c.at(1, 0);
  EXPECT_EQ(c.regions[1].label, "x 0");
  EXPECT_EQ(first.runs, 50);
  EXPECT_EQ(first.pairs, 49);
  EXPECT_EQ(first.outside, 10);
  EXPECT_EQ(first.unpaired, 0);
  EXPECT_EQ(first.baseline_events, 20);
  EXPECT_EQ(first.candidate_events, 24);
  EXPECT_EQ(first.up, 7);
  EXPECT_EQ(first.down, 3);
  EXPECT_EQ(first.tested, 50);
  EXPECT_EQ(first.difference.value, 4.0 / 49);
  // The run whose outcome is unknown in both sweeps may be an event in either.
  const Estimate &was = first.baseline_fraction, &is = first.candidate_fraction;
  EXPECT_EQ(std::pair(was.low, was.high),
            std::pair(exact_interval(20, 50).first, exact_interval(21, 50).second));
  EXPECT_EQ(std::pair(is.low, is.high),
            std::pair(exact_interval(24, 50).first, exact_interval(25, 50).second));
  EXPECT_NEAR(first.difference.p, 0.548828125, 1e-15);  // 7 up and 4 down: 2 (1 + 11 + 55 + 165 + 330) / 2048
  const OutcomePair both{1, 1}, neither{0, 0}, up{0, 1}, down{1, 0}, unknown{kNaN, kNaN};
  std::vector<std::vector<OutcomePair>> pairs(17, {both});
  pairs.resize(20, {down}), pairs.resize(27, {up}), pairs.resize(49, {neither}), pairs.resize(50, {unknown});
  const Estimate direct = estimated_event_difference(pairs);
  EXPECT_EQ(first.difference.low, direct.low);
  EXPECT_EQ(first.difference.high, direct.high);
  EXPECT_TRUE(std::isnan(first.mean.p));
  EXPECT_EQ(c.at(0, 0).up, 8);
  EXPECT_EQ(c.at(2, 0).candidate_events, 1);
}

TEST(RegionComparison, MeasuresOtherNumbers) {
  SweepResult a = row(5), b = a;
  depth(a) = {1, 2, 3, 4, kNaN}, depth(b) = {2, 4, 2.5, 4.5, kNaN};
  const SweepComparison c = compare(a, b, {{"*", {0.75, 0}}});
  const RegionComparison& r = c.at(0, 1);
  EXPECT_EQ(r.pairs, 4);
  EXPECT_EQ(r.up, 2);
  EXPECT_EQ(r.down, 0);
  EXPECT_EQ(r.mean.clusters, 4);
  EXPECT_EQ(r.mean.value, 0.75);  // pairs within the tolerance count as equal
  EXPECT_EQ(r.mean.low, estimated_difference({1, 2, 0, 0}).low);
  EXPECT_NEAR(r.baseline_spread, std::sqrt(5.0) / 2, 1e-15);  // values 1 to 4: sqrt((9 + 1 + 1 + 9) / 4 / 4)
  EXPECT_TRUE(std::isnan(r.difference.p) && std::isnan(r.mean.p) && std::isnan(r.adjusted_p));  // too few
}

// --- shared random numbers ---

CellStreams streams_of(std::size_t cells, RandomStreams each) {
  CellStreams streams = independent_streams(cells);
  streams.draws.assign(cells, each);
  return streams;
}

// Four cells of 10 replicates that draw nothing: four facts, no chance.
TEST(SharedRandomNumbers, FixedCellsAreBetterOnlyIfAllAgree) {
  SweepResult a = sweep({numbers("x", 4, 1)}, 10), b = a;
  const SweepPairing fixed{streams_of(4, {}), true};
  for (double& value : depth(b)) value = -1;
  const SweepComparison all = compare(a, b, {}, {}, {{"depth", Better::smaller}}, fixed);
  EXPECT_EQ(all.at(0, 1).runs, 4);
  EXPECT_EQ(all.at(0, 1).tested, 0);
  EXPECT_TRUE(std::isnan(all.at(0, 1).adjusted_p));
  EXPECT_EQ(all.at(0, 1).difference.low, -1);
  for (const bool paired : {false, true}) EXPECT_EQ(judgement_of(all, 1, paired), Judgement::better);
  for (std::size_t run = 0; run < 10; ++run) depth(b)[run] = 1;
  const SweepComparison most = compare(a, b, {}, {}, {{"depth", Better::smaller}}, fixed);
  EXPECT_EQ(whole(most, 1), Judgement::changed);
  EXPECT_EQ(judgement_of(most, 1, false), Judgement::undecided);
}

// 40 runs are all better, but they share the random numbers of five replicates.
TEST(SharedRandomNumbers, RunsOfAReplicateAreOneCluster) {
  SweepResult a = sweep({numbers("x", 8, 1)}, 5), b = a;
  for (double& value : depth(b)) value = -1;
  const auto judged = [&](RandomStreams each, bool needs_tests) {
    return judgement_of(
        compare(a, b, {}, {}, {{"depth", Better::smaller}}, {streams_of(8, each), needs_tests}), 1, false);
  };
  EXPECT_EQ(judged({true, false}, true), Judgement::better);
  EXPECT_EQ(judged({true, true}, true), Judgement::undecided);
  EXPECT_EQ(judged({true, true}, false),
            Judgement::better);  // the experiment is one: the program has changed
}

// Fractions are those of clusters; without random numbers they are exact.
TEST(SharedRandomNumbers, FractionsCountClusters) {
  SweepResult a = sweep({numbers("x", 8, 1)}, 5), b = a;
  for (const std::size_t run : {0, 5, 10, 15, 20, 1}) event(a)[run] = 1;  // five of replicate 0, one of 1
  const SweepComparison shared = compare(a, b, {}, {}, {}, {streams_of(8, {true, true})});
  const Estimate direct = estimated_fraction({{5, 3}, {1, 7}, {0, 8}, {0, 8}, {0, 8}});
  EXPECT_EQ(shared.at(0, 0).runs, 40);
  EXPECT_EQ(shared.at(0, 0).clusters, 5);
  EXPECT_EQ(shared.at(0, 0).baseline_fraction.high, direct.high);
  const SweepComparison fixed = compare(a, b, {}, {}, {}, {streams_of(8, {})});
  EXPECT_EQ(fixed.at(0, 0).clusters, 8);
  EXPECT_EQ(fixed.at(0, 0).baseline_fraction.value, 5.0 / 8);
  EXPECT_EQ(fixed.at(0, 0).baseline_fraction.method, kExactMethod);
  EXPECT_TRUE(std::isnan(fixed.at(0, 0).baseline_fraction.low));
}

// Regions whose pairs are equal have nothing to test, so they do not make the adjusted p of others larger.
TEST(RegionComparison, EqualPairsAreNoTest) {
  SweepResult a = sweep({numbers("x", 2, 1), numbers("y", 2, 1)}, 8), b = a;
  for (std::size_t run = 0; run < 8; ++run) depth(b)[run] = 1 + static_cast<double>(run);
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(c.regions.size(), 5u);
  EXPECT_EQ(c.tests, 4);  // shares and mean, over the whole and in one part
  EXPECT_TRUE(std::isnan(c.at(2, 1).difference.p) && std::isnan(c.at(2, 1).adjusted_p));
  EXPECT_EQ(c.at(1, 1).mean.p, 1.0 / 128);
  EXPECT_DOUBLE_EQ(c.at(1, 1).adjusted_p, 4.0 / 128);
  EXPECT_EQ(c.needed_clusters, 0);  // 4 tests need 10 pairs, and the whole has 32
  EXPECT_EQ(compare(a, b, {}, {0.02, 0.1, 1e-10}).needed_clusters, 37);  // 4 / 2^36 < 1e-10
}

// The candidate has no contact in any run.
TEST(SharedRandomNumbers, RunsWithoutContactHaveNoDirection) {
  SweepResult a = row(20), b = a;
  for (SweepResult* one : {&a, &b}) one->note_kinds = {"other", "no contact"}, one->notes.assign(20, 1);
  for (double& value : depth(b)) value = -1;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, {{"depth", Better::smaller}}), 1, false), Judgement::better);
  b.notes.assign(20, 2);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, {{"depth", Better::smaller}}), 1, false), Judgement::changed);
}

}  // namespace
}  // namespace remote_touch::sweep_comparison_test
