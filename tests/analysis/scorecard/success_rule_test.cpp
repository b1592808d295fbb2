#include "analysis/scorecard/success_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace remote_touch::success_rule_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two levels of noise, five replicates each.
SweepResult sweep_of(const std::vector<double>& depth, const std::vector<double>& time) {
  SweepResult result;
  result.axes = {{"noise", "m", "", std::vector<double>{0, 0.001}}};
  result.replicates = 5;
  result.measures = {{"depth", "m", "", {}}, {"time", "s", "", {}}};
  result.start(false);
  for (RunState& state : result.state) state = RunState::done;
  result.measures[0].values = depth;
  result.measures[1].values = time;
  return result;
}

const std::vector<Bound> kBounds = {{"depth", -1}, {"time", 2, 3}};

TEST(SuccessRule, EveryBoundMustHoldIncludingItsEnds) {
  const SweepResult sweep =
      sweep_of({-1, -1.01, 5, kNan, 0, 0, 0, 0, 0, 0}, {2, 2, 3, 2, kNan, 3.01, 1.99, 2.5, 2, 3});
  EXPECT_EQ(successes(sweep, kBounds),
            (std::vector<bool>{true, false, true, false, false, false, false, true, true, true}));
  EXPECT_THROW(successes(sweep, {{"height"}}), std::out_of_range);
}

TEST(SuccessRule, ARunThatFailedIsNoSuccessWhateverTheBounds) {
  SweepResult sweep = sweep_of(std::vector<double>(10, 0), std::vector<double>(10, 2.5));
  sweep.state[4] = RunState::failed;
  for (const std::vector<Bound>& bounds : {kBounds, {}}) {
    const std::vector<bool> won = successes(sweep, bounds);
    EXPECT_EQ(std::count(won.begin(), won.end(), true), 9);
    EXPECT_FALSE(won[4]);
  }
}

TEST(SuccessRule, TheTypicalFailureIsTheOneInTheMiddle) {
  const SweepResult sweep = sweep_of({0, 0, 0, 0, 0, -4, -2, 0, -3, kNan}, std::vector<double>(10, 2.5));
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), -1);
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 8);  // the second of -4, -3, -2 and NaN
}

TEST(SuccessRule, ErrorsAreFailuresBehindAllOthers) {
  SweepResult sweep = sweep_of({0, 0, 0, 0, 0, -4, -2, 0, 0, 0}, std::vector<double>(10, 2.5));
  sweep.state[2] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), 2);
  sweep.state[7] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 6);  // the second of -4, -2 and an error
}

}  // namespace
}  // namespace remote_touch::success_rule_test
