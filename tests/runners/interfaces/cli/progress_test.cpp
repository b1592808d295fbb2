#include "runners/interfaces/cli/progress.h"

#include <gtest/gtest.h>

namespace remote_touch::progress_test {
namespace {

TEST(ProgressText, StatesTheKnownProgress) {
  EXPECT_EQ(progress_text(0.25, 10), " 25 %, 2.5 %/s, 30 s left");
  EXPECT_EQ(progress_text(1, 10), "100 %, 10.0 %/s, 0 s left");
  EXPECT_EQ(progress_text(30, 100, 10, "runs", 10), "30 of 100 runs, 2/s, 35 s left");
}

// The remaining time is unknown before anything is done, which differs from 0 s.
TEST(ProgressText, PromisesNothingBeforeAnythingIsDone) {
  EXPECT_EQ(progress_text(0, 10), "  0 %");
  EXPECT_EQ(progress_text(10, 100, 10, "runs", 10), "10 of 100 runs");
  EXPECT_EQ(progress_text(0, 100, 0, "runs", 0), "0 of 100 runs");
}

}  // namespace
}  // namespace remote_touch::progress_test
