// The rule by which pairs of runs lead to a verdict: what passes, what does not, and how often it is wrong.
#include "analysis/sweeps/sweep_comparison.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/analysis/sweeps/example_sweeps.h"

namespace remote_touch::paired_verdict_test {
namespace {

using namespace made_sweeps;

const Directions kSmaller = {{"event", Better::smaller}, {"depth", Better::smaller}};
const Directions kLarger = {{"event", Better::larger}, {"depth", Better::larger}};

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

TEST(PairedVerdictOf, FlipsOneWayAreAChange) {
  for (const bool in_candidate : {true, false}) {
    SweepResult a = map(), b = a;
    for (std::size_t i = 0; i < 30; ++i) flip(a, b, i * 179, in_candidate);
    const SweepComparison c = compare(a, b, {}, {}, kSmaller);
    EXPECT_EQ(c.paired, PairedVerdict::changed);
    EXPECT_EQ(judgement_of(c, 0, true), in_candidate ? Judgement::worse : Judgement::better);
    EXPECT_GT(c.at(0, 0).adjusted_p, c.at(0, 0).difference.p);
    EXPECT_EQ(compare(a, b, {}, {0.02, 0.1, 1e-12}).paired, PairedVerdict::within_margin);
  }
}

// 3 % of the runs of a part get worse. More than 300 flips elsewhere hide that in the whole; if they are
// flips to the better, the whole gets better.
TEST(PairedVerdictOf, OnePartThatGotWorseIsWorse) {
  for (const bool elsewhere_better : {false, true}) {
    SweepResult a = map(), b = a;
    const Region part = compare(a, a).regions[5];
    int flipped = 0;
    for (std::size_t run = 0; run < 5396; ++run)
      if (part.contains(a.axis_indices(run))) {
        if (run % 33 == 0) flip(a, b, run, true);
      } else if (run % 15 == 0) {
        flip(a, b, run, !elsewhere_better && flipped++ % 2 == 0);
      }
    const SweepComparison c = compare(a, b, {}, {}, kSmaller);
    EXPECT_EQ(whole(c, 0), elsewhere_better ? Judgement::better : Judgement::within_margin);
    EXPECT_EQ(c.at(5, 0).judgement, Judgement::worse);
    EXPECT_EQ(c.regions[5].label, "sigma 0.005 to 0.0098, acceleration 2.3 to 4.6");
    EXPECT_EQ(judgement_of(c, 0, true), Judgement::worse);
    EXPECT_EQ(c.paired, PairedVerdict::changed);
  }
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

TEST(Judged, JudgementFollowsTheDirectionOfTheMeasure) {
  constexpr Better kSmall = Better::smaller, kGap = Better::not_negative;
  const struct {
    double before, now;
    Better better;
    Judgement judgement;
  } rows[] = {{1, 2, kSmall, Judgement::worse},
              {2, 1, kSmall, Judgement::better},
              {1, 2, Better::larger, Judgement::better},
              {-3, 2, Better::near_zero, Judgement::better},
              {-1, 1, Better::near_zero, Judgement::changed},
              {1, 2, Better::neither, Judgement::changed},
              // A renderer that follows the surface more closely has a smaller gap, which is no fault.
              {0.005, 0.0047, kGap, Judgement::changed},
              {0.005, -0.001, kGap, Judgement::worse},
              {1, kInfinity, kSmall, Judgement::worse},
              {1, 1 + 1e-12, kSmall, Judgement::changed},  // may be rounding
              {1, 1 + 1e-8, kSmall, Judgement::worse},
              {0, 1e-12, kSmall, Judgement::worse},
              {kNaN, kNaN, kSmall, Judgement::equal},
              {1, kNaN, kSmall, Judgement::changed},
              {kNaN, 1, kSmall, Judgement::changed},
              {-1, kNaN, kGap, Judgement::changed}};
  for (const auto& row : rows)
    EXPECT_EQ(judge_value(row.before, row.now, row.better, {}), row.judgement)
        << row.before << " " << row.now;
  EXPECT_EQ(judge_value(1, 2, kSmall, {1, 0}), Judgement::equal);
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
