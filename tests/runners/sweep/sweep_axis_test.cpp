#include "runners/sweep/sweep_axis.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace remote_touch::sweep_axis_test {
namespace {

std::string unit_over(const std::string& parameter) {
  return read_axis({{"parameter", parameter}, {"values", {1, 2}}}, "test", 0).coordinate.units;
}

TEST(SweepAxis, StatesTheUnitOfEveryKindOfParameter) {
  EXPECT_EQ(unit_over("scenario.noise_sigma_m"), "m");
  EXPECT_EQ(unit_over("scenario.turbidity_per_m"), "1/m");
  EXPECT_EQ(unit_over("safety.max_force_N"), "N");
  EXPECT_EQ(unit_over("scenario.rate_per_min"), "1/min");
  EXPECT_EQ(unit_over("device.mass_kg"), "kg");
  EXPECT_EQ(unit_over("renderer.steps_per_tick"), "1");
}

TEST(SweepAxis, StatesTheUnitOfOneElementOfAList) {
  EXPECT_EQ(unit_over("trajectory.poses.2.4"), "deg");
  EXPECT_EQ(unit_over("trajectory.poses.2.6"), "s");
  EXPECT_EQ(unit_over("trajectory.waypoints.0.3"), "m/s");
  EXPECT_EQ(unit_over("trajectory.waypoints.0.99"), "1");
  EXPECT_EQ(unit_over("scenario.centre_m.1"), "m");
}

}  // namespace
}  // namespace remote_touch::sweep_axis_test
