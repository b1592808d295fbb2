// Verdicts of claims. A known difference from the dissertation is not a failure, unless the measured value
// leaves its known range.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/storage/result_file.h"

namespace remote_touch::claim_test {
namespace {

Verdict differs(double measured) {
  return claim_differs("1.1", "speed", "16", measured, 28, 30, "m/s").verdict;
}

TEST(Claim, DiffersIfItIsInTheKnownRange) {
  EXPECT_EQ(differs(29), Verdict::differs);
  EXPECT_EQ(differs(28), Verdict::differs);
  EXPECT_EQ(differs(16), Verdict::fail) << "what the paper prints is no longer different: to be looked at";
  EXPECT_EQ(differs(30.1), Verdict::fail);
  EXPECT_EQ(differs(std::nan("")), Verdict::fail);
  EXPECT_EQ(claim_differs("1.1", "speed", "16", 29, 28, 30, "m/s").paper, "16");
}

TEST(Claim, TheCriterionIsInWordsWithItsNumbers) {
  EXPECT_EQ(claim_between("1.1", "speed", "16", 29, 28, 30.5, "m/s").criterion, "from 28 to 30.5");
  EXPECT_EQ(claim_at_most("1.1", "depth", "-", 1, 0.001, "m").criterion, "at most 0.001");
  EXPECT_EQ(claim_at_least("1.1", "depth", "-", 1, -2, "m").criterion, "at least -2");
  EXPECT_EQ(claim_differs("1.1", "speed", "16", 29, 28, 30, "m/s").criterion, "expected here: from 28 to 30");
  EXPECT_EQ(claim_at_most("1.1", "depth", "-", 1, 1.0 / 3, "m").criterion, "at most 0.333333");
}

TEST(Claim, ASetUpCheckIsMarkedAndStillJudged) {
  const Claim good = set_up(claim_at_most("1.1", "depth", "-", 1, 2, "m")),
              bad = set_up(claim_at_most("1.1", "depth", "-", 3, 2, "m"));
  EXPECT_TRUE(good.set_up && bad.set_up);
  EXPECT_EQ(good.verdict, Verdict::pass);
  EXPECT_EQ(bad.verdict, Verdict::fail);
  EXPECT_FALSE(claim_at_most("1.1", "depth", "-", 1, 2, "m").set_up);
}

TEST(Claim, EveryVerdictHasItsName) {
  EXPECT_STREQ(verdict_name(Verdict::pass), "pass");
  EXPECT_STREQ(verdict_name(Verdict::fail), "fail");
  EXPECT_STREQ(verdict_name(Verdict::open), "open");
  EXPECT_STREQ(verdict_name(Verdict::differs), "differs");
  EXPECT_STREQ(verdict_name(Verdict::not_run), "not run");
}

}  // namespace
}  // namespace remote_touch::claim_test
