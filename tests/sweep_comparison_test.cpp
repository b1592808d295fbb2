// Two sweeps held against each other, on results made by hand.
#include "analysis/sweep_comparison.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

namespace remote_touch {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Texts = std::vector<std::string>;

Column numbers(const std::string& name, std::size_t count, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(i) * step);
  return {name, "1", "scenario." + name, values, 1, {}};
}
Column names(const std::string& name, const Texts& texts) {
  std::vector<std::int32_t> places;
  for (std::size_t i = 0; i < texts.size(); ++i) places.push_back(static_cast<std::int32_t>(i));
  return {name, "1", "renderer." + name, places, 1, texts};
}

// Measures "event" and "depth", all runs done, all zero.
SweepResult sweep(std::vector<Column> axes, int replicates) {
  SweepResult result;
  result.axes = std::move(axes);
  result.replicates = replicates;
  result.measures = {{"event", "1", "", {}, 1, {}}, {"depth", "m", "", {}, 1, {}}};
  result.start(false);
  result.state.assign(result.run_count(), RunState::done);
  for (Column& measure : result.measures) measure.values = std::vector<double>(result.run_count(), 0.0);
  return result;
}
SweepResult row(std::size_t cells) {
  return sweep({numbers("x", cells, 1)}, 1);
}
// As large as the map of Fig 4.13: 5396 runs in nine parts of about 600.
SweepResult map() {
  return sweep({numbers("sigma", 76, 0.0002), numbers("acceleration", 71, 0.1)}, 1);
}

std::vector<double>& event(SweepResult& result) {
  return std::get<std::vector<double>>(result.measures[0].values);
}
std::vector<double>& depth(SweepResult& result) {
  return std::get<std::vector<double>>(result.measures[1].values);
}
void flip(SweepResult& a, SweepResult& b, std::size_t run, bool in_candidate) {
  event(a)[run] = in_candidate ? 0 : 1, event(b)[run] = in_candidate ? 1 : 0;
}
Judgement whole(const SweepComparison& comparison, std::size_t measure) {
  return comparison.at(0, measure).judgement;
}

TEST(CompareSweeps, EqualSweepsAreEqualWhateverTheyHold) {
  SweepResult a = map();
  depth(a)[3] = kNaN, depth(a)[4] = kInfinity, depth(a)[5] = 1e-300;
  const SweepComparison c = compare(a, a);
  EXPECT_TRUE(c.problems.empty() && c.notes.empty());
  EXPECT_EQ(c.exact, ExactVerdict::equal);
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
  EXPECT_EQ(c.exact, ExactVerdict::different);
  ASSERT_TRUE(c.first);
  EXPECT_EQ(c.first->run, 23u);
  EXPECT_EQ(c.first->cell, 7u);
  EXPECT_EQ(c.first->place, (std::vector<std::size_t>{3, 1}));
  EXPECT_EQ(c.first->replicate, 2);
  EXPECT_EQ(c.first->measure, "depth");
  EXPECT_EQ(c.first->baseline, 1e-20);
  EXPECT_EQ(c.first->candidate, 2e-20);
  EXPECT_EQ(c.measures[1].outside, 2);
  EXPECT_EQ(c.measures[1].first_outside, 23u);
  EXPECT_EQ(c.measures[1].largest_deviation, 1);
  EXPECT_NEAR(c.measures[1].rms_deviation, std::sqrt(1.0 / 30), 1e-15);
  EXPECT_EQ(c.measures[0].first_outside, 25u);
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
      EXPECT_EQ(c.exact, ExactVerdict::different);
      EXPECT_EQ(c.measures[1].outside, 1);
      EXPECT_EQ(c.measures[1].largest_deviation, 0);
      EXPECT_EQ(c.at(0, 1).unpaired, 1);
      EXPECT_EQ(c.at(0, 1).pairs, 5395);
      EXPECT_EQ(whole(c, 1), Judgement::changed);
      EXPECT_EQ(c.paired, PairedVerdict::changed);
    }
}

TEST(CompareSweeps, AnEventThatIsNeitherIsNoPass) {
  SweepResult a = map();
  event(a)[6] = 1;
  SweepResult b = a;
  event(b)[7] = 0.5;
  const SweepComparison c = compare(a, b);
  EXPECT_TRUE(c.measures[0].event);
  EXPECT_EQ(c.at(0, 0).unpaired, 1);
  EXPECT_EQ(c.paired, PairedVerdict::changed);
}

// As likely up as down, but far beyond what the runs lie apart: not shown to be within the margin.
TEST(CompareSweeps, LargeChangesBothWaysAreNoPass) {
  SweepResult a = map(), b = a;
  for (std::size_t run = 0; run < depth(b).size(); ++run) depth(b)[run] += run % 2 == 0 ? 1e6 : -1e6;
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::undecided);
  SweepResult few = a;
  for (std::size_t run = 0; run < 4; ++run) depth(few)[run] += 1e6;
  EXPECT_EQ(compare(a, few).paired, PairedVerdict::undecided);
}

// Which runs a refinement adds follows from what came out: only the first round has to be there.
TEST(CompareSweeps, RefinedSweepsAreJudgedByTheirFirstRound) {
  SweepResult a = map(), b = a;
  a.round.assign(a.run_count(), 0), a.round[3] = a.round[4] = 1;
  b.round = a.round;
  b.state[3] = RunState::not_sampled, b.round[3] = -1;
  flip(a, b, 4, true);
  EXPECT_EQ(compare(a, b).exact, ExactVerdict::different);
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
    EXPECT_EQ(c.exact, ExactVerdict::different);
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

TEST(CompareSweeps, WhatIsDoneInNeitherIsNotLookedAt) {
  SweepResult a = row(10), b = a;
  a.state[3] = b.state[3] = RunState::not_sampled, depth(b)[3] = 1;
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(c.exact, ExactVerdict::equal);
  EXPECT_EQ(c.notes, Texts{"runs done in neither: 1"});
}

TEST(CompareSweeps, SaysWhyTheyAreNotComparable) {
  const SweepResult a = sweep({numbers("x", 6, 1), names("mode", {"on", "off"})}, 2);
  const auto problems = [&](const std::function<void(SweepResult&)>& change) {
    SweepResult b = a;
    change(b);
    const SweepComparison c = compare(a, b);
    EXPECT_EQ(c.exact, ExactVerdict::not_comparable);
    EXPECT_EQ(c.paired, PairedVerdict::not_comparable);
    EXPECT_TRUE(c.by_region.empty());
    return c.problems;
  };
  const auto axis = [](SweepResult& b) -> Column& { return b.axes[0]; };
  EXPECT_EQ(problems([](auto& b) { b.axes.pop_back(); }), Texts{"axes: 2 against 1"});
  EXPECT_EQ(problems([&](auto& b) { axis(b).name = "y"; }), Texts{"axis: x against y"});
  EXPECT_EQ(problems([&](auto& b) { axis(b).long_name = "trajectory.x"; }),
            Texts{"axis x, parameter: scenario.x against trajectory.x"});
  EXPECT_EQ(problems([&](auto& b) { axis(b).units = "m"; }), Texts{"axis x, unit: 1 against m"});
  EXPECT_EQ(problems([&](auto& b) { axis(b) = numbers("x", 7, 1); }), Texts{"axis x, values: 6 against 7"});
  EXPECT_EQ(problems([&](auto& b) { axis(b) = numbers("x", 6, 1 + 1e-15); }),
            Texts{"axis x: the values differ"});
  EXPECT_EQ(problems([&](auto& b) { std::get<std::vector<double>>(axis(b).values)[0] = -0.0; }),
            Texts{"axis x: the values differ"});
  EXPECT_EQ(problems([](auto& b) { b.axes[1].value_names[1] = "auto"; }),
            Texts{"axis mode: the values differ"});
  EXPECT_EQ(problems([](auto& b) { b.replicates = 3; }), Texts{"replicates: 2 against 3"});
  EXPECT_EQ(problems([](auto& b) { b.measures.pop_back(); }), Texts{"measure depth: the candidate has none"});
  EXPECT_EQ(problems([](auto& b) { b.measures[1].units = "mm"; }),
            Texts{"measure depth, unit: m against mm"});
  EXPECT_EQ(problems([](auto& b) { std::swap(b.measures[0], b.measures[1]); }),
            Texts{"measure depth: comes before event in the candidate"});
  EXPECT_EQ(problems([](auto& b) { b.state.assign(b.run_count(), RunState::failed); }),
            Texts{"no run is done in both"});
  EXPECT_EQ(problems([](auto& b) { b.axes[0].units = "m", b.measures.clear(); }).size(), 3u);
}

TEST(CompareSweeps, RefusesToCompareNothing) {
  SweepResult a = row(6);
  EXPECT_EQ(compare(a, a, {{"force", {1, 0}}}).problems,
            Texts{"a tolerance is given for force, which the baseline does not measure"});
  a.measures.clear();
  EXPECT_EQ(compare(a, a).problems, Texts{"the baseline has no measures"});
}

TEST(CompareSweeps, FurtherMeasuresOfTheCandidateAreANote) {
  const SweepResult a = row(6);
  SweepResult b = a;
  b.measures.insert(b.measures.begin() + 1, {"force", "N", "", std::vector<double>(6, 1.0), 1, {}});
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(c.exact, ExactVerdict::equal);
  EXPECT_EQ(c.notes, Texts{"measure force: only the candidate has it"});
  EXPECT_EQ(compare(b, a).exact, ExactVerdict::not_comparable);
}

Texts labels(std::vector<Column> axes) {
  const SweepResult a = sweep(std::move(axes), 1);
  const SweepComparison c = compare(a, a);
  Texts labels;
  for (const Region& region : c.regions) labels.push_back(region.label);
  // Every cell is in the whole and, when there are parts, in one of them.
  for (std::size_t cell = 0; cell < a.cell_count(); ++cell) {
    std::size_t count = 0;
    for (const Region& region : c.regions) count += region.contains(a.place(cell)) ? 1 : 0;
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

// 3 x 3 x 3, and 3 more would be too many; 4 x 4 and 2 are 32, and the 3 before them too many.
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
  EXPECT_EQ(first.difference, paired_difference_interval(7, 3, 49));
  EXPECT_EQ(first.baseline_share, wilson_interval(20, 49));
  EXPECT_EQ(first.candidate_share, wilson_interval(24, 49));
  EXPECT_NEAR(first.sign_p, 0.34375, 1e-15);  // (1 + 10 + 45 + 120) / 512
  EXPECT_EQ(first.symmetry_p, 1);
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
  EXPECT_EQ(r.mean.pairs, 4);
  EXPECT_EQ(r.mean.mean, 0.75);  // also what is within the tolerance
  EXPECT_EQ(r.mean.low, mean_difference({1, 2, -0.5, 0.5}).low);
  EXPECT_EQ(r.sign_p, 0.5);
  EXPECT_EQ(r.symmetry_p, symmetry_test({1, 2}));
}

// --- the rule ---

TEST(PairedVerdictOf, FewRunsDecideNothing) {
  SweepResult a = sweep({numbers("x", 1, 1)}, 4), b = a;
  flip(a, b, 2, true);
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::undecided);
  // Nor when the event is equal and something else differs, however little.
  b = a, depth(b)[0] = 1e-12;
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(whole(c, 0), Judgement::equal);
  EXPECT_EQ(whole(c, 1), Judgement::undecided);
  EXPECT_EQ(c.paired, PairedVerdict::undecided);
}

TEST(PairedVerdictOf, PassesFromTheRunsOnThatItSays) {
  const auto with_one_flip = [](std::size_t runs) {
    SweepResult a = row(runs), b = a;
    flip(a, b, 0, false);
    EXPECT_EQ(compare(a, b).paired, compare(b, a).paired);
    return compare(a, b).paired;
  };
  EXPECT_EQ(with_one_flip(185), PairedVerdict::undecided);
  EXPECT_EQ(with_one_flip(190), PairedVerdict::within_margin);
  const auto with_jitter = [](std::size_t runs) {
    SweepResult a = row(runs), b = a;
    for (std::size_t run = 0; run < runs; ++run) {
      depth(a)[run] = 0.25 * static_cast<double>(run % 3);
      depth(b)[run] = depth(a)[run] + (run % 2 == 0 ? 1e-12 : -1e-12);
    }
    EXPECT_EQ(compare(a, b, {{"*", {1e-9, 0}}}).paired, PairedVerdict::equal);
    return compare(a, b).paired;
  };
  EXPECT_EQ(with_jitter(380), PairedVerdict::undecided);
  EXPECT_EQ(with_jitter(384), PairedVerdict::within_margin);
}

TEST(PairedVerdictOf, ChaoticFlipsBothWaysPass) {
  SweepResult a = map(), b = a;
  std::mt19937_64 random(3);
  for (int i = 0; i < 30; ++i) {
    const std::size_t run = random() % 5396;
    flip(a, b, run, i % 2 == 0);
    depth(a)[run] = i % 2 == 0 ? 0.02 : 0.005, depth(b)[run] = i % 2 == 0 ? 0.005 : 0.02;
  }
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(c.exact, ExactVerdict::different);
  EXPECT_EQ(c.paired, PairedVerdict::within_margin);
  EXPECT_LT(c.at(0, 0).difference.second, 0.0021);
  for (const RegionComparison& r : c.by_region) EXPECT_NE(r.judgement, Judgement::changed);
}

TEST(PairedVerdictOf, FlipsOneWayAreAChange) {
  for (const bool in_candidate : {true, false}) {
    SweepResult a = map(), b = a;
    for (std::size_t i = 0; i < 30; ++i) flip(a, b, i * 179, in_candidate);
    const SweepComparison c = compare(a, b);
    EXPECT_EQ(c.paired, PairedVerdict::changed);
    EXPECT_EQ(whole(c, 0), Judgement::changed);
    EXPECT_GT(c.at(0, 0).adjusted_p, c.at(0, 0).sign_p);
    EXPECT_EQ(compare(a, b, {}, {0.02, 0.1, 1e-12}).paired, PairedVerdict::within_margin);
  }
}

// 3 % of a part's runs get worse, while 318 flips elsewhere hide that in the whole.
TEST(PairedVerdictOf, FindsAChangeOfOnePart) {
  SweepResult a = map(), b = a;
  const std::vector<Region> regions = compare(a, a).regions;
  int changed = 0, flipped = 0;
  for (std::size_t run = 0; run < 5396; ++run)
    if (regions[5].contains(a.place(run))) {
      if (run % 33 == 0) flip(a, b, run, true), ++changed;
    } else if (run % 15 == 0) {
      flip(a, b, run, flipped++ % 2 == 0);
    }
  EXPECT_NEAR(changed, 18, 2);
  EXPECT_GT(flipped, 300);
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(whole(c, 0), Judgement::within_margin);
  EXPECT_GT(c.at(0, 0).sign_p, 0.1);
  EXPECT_EQ(c.at(5, 0).judgement, Judgement::changed);
  EXPECT_EQ(c.regions[5].label, "sigma 0.005 to 0.0098, acceleration 2.3 to 4.6");
  EXPECT_EQ(c.paired, PairedVerdict::changed);
}

// Depths differ in the last bits everywhere, both ways; in 60 runs they get a lot worse.
TEST(PairedVerdictOf, FindsLargeDifferencesAmongSmallOnes) {
  SweepResult a = sweep({numbers("x", 100, 1)}, 200), b = a;
  for (std::size_t run = 0; run < 20000; ++run) {
    depth(a)[run] = 0.01 * static_cast<double>(run % 3);
    depth(b)[run] = depth(a)[run] + (run % 2 == 0 ? 1e-15 : -1e-15);
  }
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::within_margin);
  for (std::size_t i = 0; i < 60; ++i) depth(b)[i * 333] += 0.01;
  const SweepComparison c = compare(a, b);
  EXPECT_GT(c.at(0, 1).sign_p, 0.5);
  EXPECT_EQ(whole(c, 1), Judgement::changed);
}

// All smaller than the margin could tell, but all one way.
TEST(PairedVerdictOf, ASystematicChangeIsAChangeHoweverSmall) {
  SweepResult a = row(40), b = a;
  for (double& value : depth(b)) value = 1e-15;
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::changed);
  EXPECT_EQ(compare(a, b, {{"*", {1e-12, 0}}}).paired, PairedVerdict::equal);
}

// Maps in which one run of 20 flips by chance: alpha holds, and at this size all the others pass.
TEST(PairedVerdictOf, IsRarelyAFalseAlarm) {
  constexpr int kMaps = 200;
  std::mt19937_64 random(11);
  int alarms = 0, passes = 0;
  for (int i = 0; i < kMaps; ++i) {
    SweepResult a = map(), b = a;
    for (std::size_t run = 0; run < 5396; ++run) {
      const std::uint64_t drawn = random() % 40;
      if (drawn < 2) flip(a, b, run, drawn == 0);
      depth(a)[run] = static_cast<double>(run % 5);
      depth(b)[run] = depth(a)[run] + (drawn == 2 ? 1 : drawn == 3 ? -1 : 0);
    }
    const PairedVerdict verdict = compare(a, b, {}, {0.02, 0.1, 0.05}).paired;
    alarms += verdict == PairedVerdict::changed ? 1 : 0;
    passes += verdict == PairedVerdict::within_margin ? 1 : 0;
  }
  EXPECT_LE(alarms, 15);  // 10 expected at most
  EXPECT_EQ(alarms + passes, kMaps);
}

}  // namespace
}  // namespace remote_touch
