// The direction in which each measure gets better.
#include "analysis/measures/better.h"

#include <gtest/gtest.h>

#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::better_test {
namespace {

TEST(BetterOfMeasures, IsInTheirTable) {
  for (const char* name : {"popped_through", "rms_contact_error", "rms_force_jump", "force_noise",
                           "tool_popped_through", "max_tool_penetration", "guidance_error"})
    EXPECT_EQ(measure_named(name).better, Better::smaller) << name;
  for (const char* name : {"min_slave_distance", "min_clearance"})
    EXPECT_EQ(measure_named(name).better, Better::not_negative) << name;
  EXPECT_EQ(measure_named("contact_force_fraction").better, Better::larger);
  EXPECT_EQ(measure_named("mean_height").better, Better::near_zero);
  // More force is no better and no worse: a proxy that popped through exerts none.
  for (const char* name :
       {"max_force", "max_torque", "energy_injected", "force_fraction", "last_force_time", "end_distance"})
    EXPECT_EQ(measure_named(name).better, Better::neither) << name;
}

double nothing(const Trace&) {
  return 0;
}

TEST(BetterOfMeasures, IsNeitherIfAProgramGivesNone) {
  EXPECT_EQ((Measure{"own", "1", "a measure of a program", MeasuredRuns::all, nothing}.better),
            Better::neither);
}

TEST(Badness, IsSmallerWhereItIsBetter) {
  EXPECT_LT(badness(1, Better::smaller), badness(2, Better::smaller));
  EXPECT_GT(badness(1, Better::larger), badness(2, Better::larger));
  EXPECT_LT(badness(-1, Better::near_zero), badness(2, Better::near_zero));
  EXPECT_LT(badness(1, Better::near_zero), badness(-2, Better::near_zero));
  EXPECT_LT(badness(-1, Better::not_negative), badness(-2, Better::not_negative));
  EXPECT_LT(badness(0, Better::not_negative), badness(-1, Better::not_negative));
  EXPECT_EQ(badness(1, Better::not_negative), badness(2, Better::not_negative));
}

TEST(DirectionOf, AnUnlistedMeasureHasNoDirection) {
  const Directions directions = {{"x", Better::larger}};
  EXPECT_EQ(direction_of(directions, "x"), Better::larger);
  EXPECT_EQ(direction_of(directions, "y"), Better::neither);
  EXPECT_STREQ(text_of(direction_of(directions, "y")), "has no direction");
}

}  // namespace
}  // namespace remote_touch::better_test
