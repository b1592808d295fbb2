#include "runners/sweep/threads/time_left.h"

#include <gtest/gtest.h>

namespace remote_touch {
namespace {

constexpr JobState kWaiting = JobState::waiting, kRunning = JobState::running, kDone = JobState::done;

TEST(ShortestFirst, EqualOnesKeepTheirOrder) {
  EXPECT_EQ(shortest_first({3, 1, 2, 1}), (std::vector<std::size_t>{1, 3, 2, 0}));
}

TEST(TimeLeft, IsWhatWasExpectedBeforeAnythingIsDone) {
  const TimeLeft left = time_left({10, 30}, {{kWaiting, 0}, {kWaiting, 0}}, 2);
  EXPECT_DOUBLE_EQ(left.of_job_s[0], 10);
  EXPECT_DOUBLE_EQ(left.of_job_s[1], 30);
  EXPECT_DOUBLE_EQ(left.all_s, 20);
}

TEST(TimeLeft, TakesTheSpeedOfTheMachineFromWhatIsDone) {
  // The prior counts 2 s, and a job of 8 s took 18 s: 20 s for 10 s.
  const TimeLeft left = time_left({8, 30}, {{kDone, 18}, {kWaiting, 0}}, 1);
  EXPECT_EQ(left.of_job_s[0], 0);
  EXPECT_DOUBLE_EQ(left.of_job_s[1], 60);
  EXPECT_DOUBLE_EQ(left.all_s, 60);
}

TEST(TimeLeft, ARunningJobCountsForATwentiethAtLeast) {
  EXPECT_DOUBLE_EQ(time_left({10}, {{kRunning, 4}}, 1).all_s, 6);
  EXPECT_DOUBLE_EQ(time_left({10}, {{kRunning, 40}}, 1).all_s, 0.5);
}

TEST(TimeLeft, ThreadsWithoutAJobHelpTheOneThatRuns) {
  const TimeLeft left = time_left({10}, {{kRunning, 2}}, 4);
  EXPECT_DOUBLE_EQ(left.of_job_s[0], 2);
  EXPECT_DOUBLE_EQ(left.all_s, 2);
}

TEST(TimeLeft, IsZeroWhenAllJobsAreDone) {
  const TimeLeft left = time_left({10, 1}, {{kDone, 1}, {kDone, 1}}, 2);
  EXPECT_EQ(left.all_s, 0);
}

}  // namespace
}  // namespace remote_touch
