// The columns of a live run that a page receives.
#include "runners/live/view/live_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace remote_touch::live_rows_test {
namespace {

std::vector<std::string> names_with(const std::optional<SlaveState>& slave) {
  LiveTick tick;
  tick.slave = slave;
  LiveRows rows;
  rows.append(tick, 1000, DevicePlacement({}));
  std::vector<std::string> names;
  for (const Column& column : rows.columns()) names.push_back(column.name);
  return names;
}

TEST(LiveRows, HaveTheColumnsOfASlaveAndOneForceOfTheDevice) {
  const auto count = [](const std::vector<std::string>& names, const char* name) {
    return std::count(names.begin(), names.end(), name);
  };
  const std::vector<std::string> with = names_with(SlaveState{}), without = names_with({});
  for (const char* name : {"received_command", "slave_position", "slave_force", "slave_clearance"}) {
    EXPECT_EQ(count(with, name), 1) << name;
    EXPECT_EQ(count(without, name), 0) << name;
  }
  EXPECT_EQ(count(with, "commanded_force"), 1);
  EXPECT_EQ(count(without, "commanded_force"), 0) << "it is the renderer's force";
  EXPECT_EQ(count(with, "device_force"), 1);
  EXPECT_EQ(count(without, "device_force"), 1);
}

// The hand feels the slave here, and the safety gate has reduced its force.
TEST(LiveRows, TheCommandedForceIsThatBeforeTheGate) {
  LiveTick tick;
  tick.slave = SlaveState{};
  tick.out.force_N = Vec3(0, 20, 0);
  tick.command.force_N = Vec3(0, 0.5, 0);
  tick.written.force_N = Vec3(0, 0.25, 0);
  LiveRows rows;
  rows.append(tick, 1000, DevicePlacement({}));
  const std::pair<const char*, double> expected[] = {
      {"force", 20}, {"commanded_force", 0.5}, {"device_force", 0.25}};
  const std::vector<Column> columns = rows.columns();
  for (const auto& [name, value_N] : expected) {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [name = name](const Column& column) { return column.name == name; });
    ASSERT_NE(found, columns.end()) << name;
    EXPECT_EQ(std::get<std::vector<double>>(found->values)[1], value_N) << name;
  }
}

}  // namespace
}  // namespace remote_touch::live_rows_test
