// Judgements (better, worse, changed) of one number, and of the measures of sweeps.
#include "analysis/comparison/judgement.h"

#include <gtest/gtest.h>

#include "tests/analysis/comparison/example_sweeps.h"

namespace remote_touch::judgement_test {
namespace {

using namespace made_sweeps;

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
  EXPECT_EQ(judgement_of(compare(b, a, {}, {}, kSmaller), 0, false), Judgement::better);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kLarger), 0, false), Judgement::better);
  EXPECT_EQ(judgement_of(compare(a, b), 0, false), Judgement::changed);
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::equal);
  depth(a)[1] = 1, depth(b)[1] = kNaN;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::changed);
  depth(b)[3] = 2;
  EXPECT_EQ(judgement_of(compare(a, b, {}, {}, kSmaller), 1, false), Judgement::undecided);
  EXPECT_EQ(judgement_of(compare(b, a, {}, {}, kSmaller), 1, false), Judgement::undecided);
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
  EXPECT_EQ(judgement_of(compare(b, a, {}, {}, kSmaller), 0, false), Judgement::worse);
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
  EXPECT_EQ(judgement_of(compare(b, a, {}, {}, kSmaller), 0, true), Judgement::worse);
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
  EXPECT_EQ(judgement_of(compare(b, a, {}, {}, directions), 1, true), Judgement::worse);
}

}  // namespace
}  // namespace remote_touch::judgement_test
