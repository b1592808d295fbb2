// The rule by which pairs of runs lead to a verdict: what passes, what does not, and how often it is wrong.
#include "analysis/sweeps/sweep_comparison.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/analysis/sweeps/example_sweeps.h"

namespace remote_touch::paired_verdict_test {
namespace {

using namespace made_sweeps;

// --- the rule ---

TEST(PairedVerdictOf, FewRunsDecideNothing) {
  SweepResult a = sweep({numbers("x", 1, 1)}, 4), b = a;
  flip(a, b, 2, true);
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::undecided);
  // They decide nothing either if the event is equal and another measure differs, however little.
  b = a, depth(b)[0] = 1e-12;
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(whole(c, 0), Judgement::equal);
  EXPECT_EQ(whole(c, 1), Judgement::undecided);
  EXPECT_EQ(c.paired, PairedVerdict::undecided);
}

TEST(PairedVerdictOf, PassesFromTheDocumentedNumberOfRuns) {
  const auto with_one_flip = [](std::size_t runs) {
    SweepResult a = row(runs), b = a;
    flip(a, b, 0, false);
    EXPECT_EQ(compare(a, b).paired, compare(b, a).paired);
    return compare(a, b).paired;
  };
  EXPECT_EQ(with_one_flip(279), PairedVerdict::undecided);
  EXPECT_EQ(with_one_flip(280), PairedVerdict::within_margin);
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
  EXPECT_FALSE(c.is_equal());
  EXPECT_EQ(c.paired, PairedVerdict::within_margin);
  EXPECT_LT(c.at(0, 0).difference.high, 0.0022);
  for (const RegionComparison& r : c.by_region) EXPECT_NE(r.judgement, Judgement::changed);
}

TEST(PairedVerdictOf, FlipsOneWayAreAChange) {
  for (const bool in_candidate : {true, false}) {
    SweepResult a = map(), b = a;
    for (std::size_t i = 0; i < 30; ++i) flip(a, b, i * 179, in_candidate);
    const SweepComparison c = compare(a, b);
    EXPECT_EQ(c.paired, PairedVerdict::changed);
    EXPECT_EQ(whole(c, 0), Judgement::changed);
    EXPECT_GT(c.at(0, 0).adjusted_p, c.at(0, 0).difference.p);
    EXPECT_EQ(compare(a, b, {}, {0.02, 0.1, 1e-12}).paired, PairedVerdict::within_margin);
  }
}

// 3 % of a part's runs get worse, while more than 300 flips elsewhere hide that in the whole.
TEST(PairedVerdictOf, FindsAChangeOfOnePart) {
  SweepResult a = map(), b = a;
  const std::vector<Region> regions = compare(a, a).regions;
  int changed = 0, flipped = 0;
  for (std::size_t run = 0; run < 5396; ++run)
    if (regions[5].contains(a.axis_indices(run))) {
      if (run % 33 == 0) flip(a, b, run, true), ++changed;
    } else if (run % 15 == 0) {
      flip(a, b, run, flipped++ % 2 == 0);
    }
  EXPECT_NEAR(changed, 18, 2);
  EXPECT_GT(flipped, 300);
  const SweepComparison c = compare(a, b);
  EXPECT_EQ(whole(c, 0), Judgement::within_margin);
  EXPECT_GT(c.at(0, 0).difference.p, 0.1);
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
  EXPECT_GT(c.at(0, 1).difference.p, 0.5);
  EXPECT_EQ(whole(c, 1), Judgement::changed);
}

// All differences are far below the margin, but all have the same sign.
TEST(PairedVerdictOf, ASystematicChangeIsAChangeHoweverSmall) {
  SweepResult a = row(40), b = a;
  for (double& value : depth(b)) value = 1e-15;
  EXPECT_EQ(compare(a, b).paired, PairedVerdict::changed);
  EXPECT_EQ(compare(a, b, {{"*", {1e-12, 0}}}).paired, PairedVerdict::equal);
}

// One run of 20 flips by chance in these maps. False alarms are as rare as alpha requires, and all other maps
// pass.
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

// Judgements (better, worse, changed) of one number, and of the measures of sweeps.

const Directions kSmaller = {{"event", Better::smaller}, {"depth", Better::smaller}};
const Directions kLarger = {{"event", Better::larger}, {"depth", Better::larger}};

TEST(Judged, JudgementFollowsTheDirectionOfTheMeasure) {
  EXPECT_EQ(judge_value(1, 2, Better::smaller, {}), Judgement::worse);
  EXPECT_EQ(judge_value(2, 1, Better::smaller, {}), Judgement::better);
  EXPECT_EQ(judge_value(1, 2, Better::larger, {}), Judgement::better);
  EXPECT_EQ(judge_value(-3, 2, Better::near_zero, {}), Judgement::better);
  EXPECT_EQ(judge_value(1, 2, Better::neither, {}), Judgement::changed);
  EXPECT_EQ(judge_value(-1, 1, Better::near_zero, {}), Judgement::changed);
  // A renderer that follows the surface more closely has a smaller gap, which is no fault.
  EXPECT_EQ(judge_value(0.005, 0.0047, Better::not_negative, {}), Judgement::changed);
  EXPECT_EQ(judge_value(0.005, -0.001, Better::not_negative, {}), Judgement::worse);
  EXPECT_EQ(judge_value(1, 2, Better::smaller, {1, 0}), Judgement::equal);
  EXPECT_EQ(judge_value(1, kInfinity, Better::smaller, {}), Judgement::worse);
  EXPECT_EQ(judge_value(1, 1 + 1e-12, Better::smaller, {}), Judgement::changed) << "may be rounding";
  EXPECT_EQ(judge_value(1, 1 + 1e-8, Better::smaller, {}), Judgement::worse);
  EXPECT_EQ(judge_value(0, 1e-12, Better::smaller, {}), Judgement::worse);
}

Judgement exchanged(Judgement judgement) {
  return judgement == Judgement::better  ? Judgement::worse
         : judgement == Judgement::worse ? Judgement::better
                                         : judgement;
}

TEST(Judged, ExchangedValuesAreJudgedTheOtherWayRound) {
  for (const Better better :
       {Better::neither, Better::smaller, Better::larger, Better::near_zero, Better::not_negative})
    for (const double a : {-3.0, -1e-12, 0.0, 1.0, 1 + 1e-12, 2.0, kInfinity, -kInfinity, kNaN})
      for (const double b : {-3.0, -1e-12, 0.0, 1.0, 1 + 1e-12, 2.0, kInfinity, -kInfinity, kNaN})
        EXPECT_EQ(judge_value(b, a, better, {}), exchanged(judge_value(a, b, better, {}))) << a << " " << b;
}

TEST(Judged, NanIsNeitherBetterNorWorse) {
  EXPECT_EQ(judge_value(kNaN, kNaN, Better::smaller, {}), Judgement::equal);
  EXPECT_EQ(judge_value(1, kNaN, Better::smaller, {}), Judgement::changed);
  EXPECT_EQ(judge_value(kNaN, 1, Better::smaller, {}), Judgement::changed);
  EXPECT_EQ(judge_value(-1, kNaN, Better::not_negative, {}), Judgement::changed);
}

TEST(JudgedRunByRun, DirectionOfAllChangedRunsDecides) {
  SweepResult a = row(6), b = a;
  flip(a, b, 2, true);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 0, false), Judgement::worse);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kLarger), 0, false), Judgement::better);
  EXPECT_EQ(judgement_of(compare(a, b), 0, false), Judgement::changed);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::equal);
  depth(a)[1] = 1, depth(b)[1] = kNaN;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::changed);
  depth(b)[3] = 2;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::undecided);
}

// All 16 runs popped through before, and one does now. The other measure cannot be judged in 15 runs, and is
// worse or better in one. This one run decides nothing in either direction.
TEST(JudgedRunByRun, OneRunBesideManyWithAnotherOutcomeDecidesNothing) {
  SweepResult a = row(16), b = a;
  for (SweepResult* one : {&a, &b}) one->measures[0].name = "popped_through", one->measures[1].name = "noise";
  for (std::size_t run = 0; run < 16; ++run)
    event(a)[run] = 1, event(b)[run] = run == 0 ? 1 : 0, depth(b)[run] = -1;
  const Directions directions = {{"popped_through", Better::smaller}, {"noise", Better::smaller}};
  for (const double value : {1.0, -1.0}) {
    depth(b)[0] = value;
    const SweepComparison c = compare(a, b, {}, {}, directions);
    EXPECT_EQ(c.measures[1].got_worse, value > 0 ? 1 : 0);
    EXPECT_EQ(c.measures[1].got_better, value > 0 ? 0 : 1);
    EXPECT_EQ(c.measures[1].outside, 16);
    EXPECT_EQ(judgement_of(c, 0, false), Judgement::better);
    EXPECT_EQ(judgement_of(c, 1, false), Judgement::undecided);
  }
}

// 60 runs hold that did not before, and 4 are lost: better. Equal numbers each way: undecided.
TEST(JudgedRunByRun, TheTestsDecideIfRunsWentBothWays) {
  SweepResult a = map(), b = a;
  for (std::size_t i = 0; i < 64; ++i) flip(a, b, i * 83, i % 16 == 0);
  const SweepComparison c = compare(a, b, {}, {}, kSmaller);
  EXPECT_EQ(c.measures[0].got_better, 60);
  EXPECT_EQ(c.measures[0].got_worse, 4);
  EXPECT_EQ(judgement_of(c, 0, false), Judgement::better);
  SweepResult x = row(6), y = x;
  flip(x, y, 1, true), flip(x, y, 2, false);
  EXPECT_EQ(judgement_of(compare(x, y, {}, {}, kSmaller), 0, false), Judgement::undecided);
}

TEST(JudgedInPairs, AClearImprovementIsBetter) {
  SweepResult a = map(), b = a;
  for (std::size_t i = 0; i < 30; ++i) flip(a, b, i * 179, false);
  const SweepComparison c = compare(a, b, {}, {}, kSmaller);
  EXPECT_EQ(c.paired, PairedVerdict::changed);
  EXPECT_EQ(judgement_of(c, 0, true), Judgement::better);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kLarger), 0, true), Judgement::worse);
}

// Better over the whole, but one of its nine parts got worse.
TEST(JudgedInPairs, OnePartThatGotWorseIsWorse) {
  SweepResult a = map(), b = a;
  const Region part = compare(a, a).regions[5];
  for (std::size_t run = 0; run < 5396; ++run)
    if (part.contains(a.axis_indices(run)) ? run % 33 == 0 : run % 20 == 0)
      flip(a, b, run, part.contains(a.axis_indices(run)));
  const SweepComparison c = compare(a, b, {}, {}, kSmaller);
  EXPECT_EQ(whole(c, 0), Judgement::better);
  EXPECT_EQ(judgement_of(c, 0, true), Judgement::worse);
}

// Nearly all depths get smaller by a little, a few much larger: better in most runs, worse on average.
TEST(JudgedInPairs, AFewThatGotMuchWorseAreWorse) {
  SweepResult a = sweep({numbers("x", 100, 1)}, 20), b = a;
  for (std::size_t run = 0; run < 2000; ++run) depth(b)[run] = run % 40 == 0 ? 0.01 : -1e-15;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, true), Judgement::worse);
  for (std::size_t run = 0; run < 2000; ++run) depth(b)[run] = -1e-15;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, true), Judgement::better);
  depth(b)[7] = kNaN;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, true), Judgement::changed);
}

// If one of two runs popped through, the other measures do not show which run is better.
TEST(JudgedInPairs, RunsWithAnotherOutcomeAreJudgedByThatAlone) {
  SweepResult a = map(), b = a;
  for (SweepResult* one : {&a, &b}) one->measures[0].name = "popped_through", one->measures[1].name = "noise";
  for (std::size_t i = 0; i < 60; ++i) flip(a, b, i * 83, false), depth(b)[i * 83] = 1;
  const Directions directions = {{"popped_through", Better::smaller}, {"noise", Better::smaller}};
  for (const bool paired : {false, true}) {
    const SweepComparison c = compare(a, b, {}, {}, directions);
    EXPECT_EQ(judgement_of(c, 0, paired), Judgement::better);
    EXPECT_EQ(judgement_of(c, 1, paired), Judgement::changed);
  }
  for (std::size_t i = 0; i < 60; ++i) depth(b)[i * 83 + 1] = 1;  // the outcome is the same
  for (const bool paired : {false, true})
    EXPECT_EQ(judgement_of(compare(a, b, {}, {}, directions), 1, paired), Judgement::worse);
}

// Heights of both signs that all come nearer to the surface.
TEST(JudgedInPairs, NearerToZeroIsBetter) {
  SweepResult a = map(), b = a;
  for (std::size_t run = 0; run < 5396; ++run) {
    depth(a)[run] = run % 3 == 0 ? -3e-3 : 2e-3;
    depth(b)[run] = depth(a)[run] / 2;
  }
  const Directions directions = {{"depth", Better::near_zero}};
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, directions), 1, true), Judgement::better);
}

// The reverse does not hold: a run without a partner can make a measure worse, but never better.
TEST(JudgedBothWays, BetterIsWorseWithTheSweepsExchanged) {
  std::mt19937 random(4);
  int found_better = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SweepResult a = sweep({numbers("x", 4, 1)}, 10), b = a;
    const auto shift = static_cast<double>(random() % 3) - 1;
    for (std::size_t run = 0; run < a.run_count(); ++run) {
      const double noise = static_cast<double>(random() % 1000) / 1000;
      event(a)[run] = random() % 4 == 0 ? 1 : 0, event(b)[run] = noise < 0.25 + 0.4 * shift ? 1 : 0;
      depth(a)[run] = noise,
      depth(b)[run] = noise + 0.1 * shift + 1e-4 * static_cast<double>(random() % 1000);
      if (trial % 4 == 0 && random() % 20 == 0) event(b)[run] = depth(a)[run] = kNaN;
    }
    for (const Directions& directions :
         {kSmaller, kLarger, Directions{{"event", Better::smaller}, {"depth", Better::near_zero}}}) {
      const SweepComparison to_b = compare(a, b, {}, {}, directions),
                            to_a = compare(b, a, {}, {}, directions);
      for (const std::size_t measure : {0u, 1u})
        for (const bool paired : {false, true}) {
          const Judgement there = judgement_of(to_b, measure, paired),
                          back = judgement_of(to_a, measure, paired);
          found_better += there == Judgement::better || back == Judgement::better;
          EXPECT_TRUE(there != Judgement::better || back == Judgement::worse) << trial;
          EXPECT_TRUE(back != Judgement::better || there == Judgement::worse) << trial;
          EXPECT_EQ(there == Judgement::equal, back == Judgement::equal) << trial;
        }
    }
  }
  EXPECT_GT(found_better, 50);
}

}  // namespace
}  // namespace remote_touch::paired_verdict_test
