#include "core/parameters/parameter.h"

#include <gtest/gtest.h>

#include <string>

namespace remote_touch::parameter_test {
namespace {

TEST(Unit, IsReadFromTheEndOfAName) {
  EXPECT_EQ(unit_of("r1_m")->text, std::string("m"));
  EXPECT_EQ(unit_of("stiffness_N_per_m")->text, std::string("N/m"));
  EXPECT_EQ(unit_of("force_rate_N_per_s")->text, std::string("N/s"));
  EXPECT_EQ(unit_of("damping_Nms_per_rad")->dimension, (Dimension{1, 1, 1}));
  for (const char* const name : {"rows", "gamma", "steps_per_tick", "m", ""})
    EXPECT_EQ(unit_of(name), nullptr) << name;
}

// An ending that comes too late in the table would never be found.
TEST(Unit, EveryUnitIsFoundByItsOwnEnding) {
  for (const Unit& unit : known_units())
    EXPECT_EQ(unit_of(std::string("x") + unit.ending), &unit) << unit.ending;
}

}  // namespace
}  // namespace remote_touch::parameter_test
