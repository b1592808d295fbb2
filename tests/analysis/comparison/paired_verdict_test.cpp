// The rule by which pairs of runs lead to a verdict: what passes, what does not, and how often it is wrong.
#include "analysis/comparison/sweep_comparison.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/analysis/comparison/example_sweeps.h"

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

}  // namespace
}  // namespace remote_touch::paired_verdict_test
