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
  EXPECT_EQ(count(with, "device_force"), 1);
  EXPECT_EQ(count(without, "device_force"), 1);
}

}  // namespace
}  // namespace remote_touch::live_rows_test
