#include "core/dissertation/tool_motion/tool_motion.h"

#include <gtest/gtest.h>

namespace remote_touch::tool_motion_test {
namespace {

TEST(MotionProgress, HasNotEndedWhileTheToolComesNearer) {
  MotionProgress progress(0.125, 2);
  for (double left = 10; left > 0; left -= 0.25) {
    progress.update(left);
    EXPECT_FALSE(progress.has_ended()) << left;
  }
}

TEST(MotionProgress, EndsAfterTheGivenNumberOfStepsWithoutProgress) {
  MotionProgress progress(0.125, 2);
  progress.update(10);
  progress.update(10 - 0.125);  // equal to the minimum, which counts as no progress
  EXPECT_FALSE(progress.has_ended());
  progress.update(11);
  EXPECT_TRUE(progress.has_ended());
}

TEST(MotionProgress, CountsAgainFromTheNearestWay) {
  MotionProgress progress(0, 2);
  progress.update(10);
  progress.update(12);
  progress.update(9);
  EXPECT_FALSE(progress.has_ended());
  progress.update(11);
  progress.update(9.5);  // nearer than one step before, but not than the nearest
  EXPECT_TRUE(progress.has_ended());
}

}  // namespace
}  // namespace remote_touch::tool_motion_test
