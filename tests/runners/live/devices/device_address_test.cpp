#include "runners/live/devices/device_address.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::device_address_test {
namespace {

const std::vector<std::string> kKnown{"rate", "force"};

TEST(DeviceAddress, HasAPathAndSettings) {
  const DeviceAddress address("fd", "0?rate=500&force=vector", kKnown);
  EXPECT_EQ(address.place(), "0");
  EXPECT_EQ(address.refusal("x").what(), std::string("fd:0?rate=500&force=vector: x"));
  EXPECT_EQ(address.number("rate", 1000, 1, 4000), 500);
  EXPECT_EQ(address.choice("force", {"values", "vector"}), "vector");
  EXPECT_EQ(address.word("force", "none"), "vector");
}

TEST(DeviceAddress, MissingSettingsHaveTheirDefaults) {
  const DeviceAddress address("fd", "", kKnown);
  EXPECT_EQ(address.place(), "");
  EXPECT_FALSE(address.has("rate"));
  EXPECT_EQ(address.number("rate", 1000, 1, 4000), 1000);
  EXPECT_EQ(address.choice("force", {"values", "vector"}), "values");
  EXPECT_EQ(address.word("force", "none"), "none");
}

TEST(DeviceAddress, WrongSettingsAreNamed) {
  const auto refused = [](const std::string& written) {
    return refusal([&] { DeviceAddress("fd", written, kKnown).number("rate", 1000, 1, 4000); });
  };
  EXPECT_HAS(refused("0?moon=1"), "fd:0?moon=1: has no setting \"moon\": expected rate, force");
  EXPECT_HAS(refused("0?rate="), "the setting rate has no value; write rate=VALUE");
  EXPECT_HAS(refused("0?rate"), "the setting rate has no value; write rate=VALUE");
  EXPECT_HAS(refused("0?rate=5&rate=6"), "the setting rate is given twice: expected once");
  for (const char* number : {"0.5", "4001", "x", "nan"})
    EXPECT_HAS(refused(std::string("?rate=") + number), "expected a number from 1 to 4000") << number;
}

TEST(DeviceAddress, MessagesBeginWithTheAddressAndOneColon) {
  const auto message = [](const std::string& written) {
    return refusal([&] { throw DeviceAddress("haply", written, kKnown).refusal("no service"); });
  };
  EXPECT_EQ(message(""), "haply: no service");
  EXPECT_EQ(message("ws://127.0.0.1:10001"), "haply:ws://127.0.0.1:10001: no service");
}

}  // namespace
}  // namespace remote_touch::device_address_test
