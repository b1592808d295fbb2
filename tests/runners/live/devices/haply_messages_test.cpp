// The text that Haply's service and its client exchange: samples of its documentation, and texts that are no
// message.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "runners/evaluation/contract/allocation_counter.h"

namespace remote_touch::haply_messages_test {
namespace {

using nlohmann::json;

// The state of the documentation of 3.5, with members in the order of its samples, which is not alphabetical.
const std::string kState = R"({
  "inverse3": [ { "state": {
      "cursor_velocity": {"z": -0.043197, "x": -0.011969013, "y": 1.2e-3},
      "current_cursor_position": {"x": 7, "y": 7, "z": 7},
      "current_cursor_force": {"x": 0.5, "y": -1, "z": 2.25},
      "cursor_position": {"x": 0.07842738, "y": -0.14836666, "z": 0.14297646},
      "transform": {"scale": {"x": 1, "y": 1, "z": 1}}, "mode": "idle" },
    "status": {"calibrated": false, "text": "a \"quoted\" { brace \\"}, "device_id": "04BA" },
    { "device_id": "04BB", "state": {"cursor_position": {"x": 1, "y": 2, "z": 3}} } ],
  "verse_grip": [],
  "wireless_verse_grip": [ { "device_id": "61548", "state": { "battery_level": null,
    "buttons": {"a": true, "b": false, "c": true},
    "orientation": {"x": -0.5019531, "y": 0.8632202, "z": -0.048095703, "w": -0.022338867} } } ]
})";

TEST(HaplyMessage, ReadsTheSampleOfTheDocumentation) {
  HaplyMessage message;
  ASSERT_TRUE(read_haply_message(kState, "", "", message));
  ASSERT_TRUE(message.device && message.handle);
  EXPECT_EQ(message.device->id, "04BA");
  EXPECT_EQ(message.device->position_m, Vec3(0.07842738, -0.14836666, 0.14297646));
  EXPECT_EQ(message.device->velocity_m_per_s, Vec3(-0.011969013, 1.2e-3, -0.043197));
  EXPECT_EQ(message.device->force_N, Vec3(0.5, -1, 2.25));
  EXPECT_EQ(message.handle->id, "61548");
  EXPECT_EQ(message.handle->orientation, Eigen::Vector4d(-0.5019531, 0.8632202, -0.048095703, -0.022338867));
  EXPECT_EQ(message.handle->buttons, 0b101u);
}

TEST(HaplyMessage, FindsDevicesAndHandlesByName) {
  HaplyMessage message;
  ASSERT_TRUE(read_haply_message(kState, "04BB", "", message));
  ASSERT_TRUE(message.device);
  EXPECT_EQ(message.device->position_m, Vec3(1, 2, 3));
  EXPECT_FALSE(message.device->force_N);
  ASSERT_TRUE(read_haply_message(kState, "04BC", "61549", message));
  EXPECT_FALSE(message.device || message.handle);
  ASSERT_TRUE(read_haply_message("{}", "", "", message));
  EXPECT_FALSE(message.device || message.handle);
}

TEST(HaplyMessage, ReadsAWiredHandleAndTheBasis) {
  HaplyMessage message;
  ASSERT_TRUE(read_haply_message(
      R"({"inverse3":[{"device_id":"1","config":{"basis":{"permutation":"XZY"}},"state":{}}],)"
      R"("verse_grip":[{"device_id":"2","state":{"button":true,"orientation":{"x":0,"y":0,"z":0,"w":1}}}]})",
      "", "", message));
  EXPECT_EQ(message.device->basis, "XZY");
  EXPECT_FALSE(message.device->position_m || message.device->velocity_m_per_s);
  EXPECT_EQ(message.handle->buttons, 1u);
}

std::string with_x(const std::string& x) {
  return R"({"inverse3":[{"state":{"cursor_position":{"x":)" + x + R"(,"y":0,"z":0}}}]})";
}

TEST(HaplyMessage, RefusesWhatIsNotAMessage) {
  HaplyMessage message;
  EXPECT_TRUE(read_haply_message(with_x("-1e-3"), "", "", message));
  for (const char* x :
       {"nan", "NaN", "-nan", "inf", "-inf", "Infinity", "null", "\"1\"", "1e999", "-", "", "+1", "[1]"})
    EXPECT_FALSE(read_haply_message(with_x(x), "", "", message)) << x;
  for (const char* text :
       {"", " ", "{", "[]", "{}{}", "garbage", "\xff\xfe", R"({"inverse3":{}})", R"({"inverse3":[1]})",
        R"({"inverse3":[{"state":{"cursor_position":{"x":1,"y":2}}}]})", R"({"a" 1})", R"({"a":1,})",
        R"({"a":tru})", R"({"a":"\)", "{\"a\":\"\n\"}"})
    EXPECT_FALSE(read_haply_message(text, "", "", message)) << text;
  EXPECT_FALSE(read_haply_message("{\"a\":" + std::string(100000, '['), "", "", message));
}

// Every beginning of a message, and messages with bytes changed, are refused or read within their bounds.
// Each is in memory of its own, so that the address sanitizer finds a read outside.
TEST(HaplyMessage, BrokenTextIsReadWithinItsBounds) {
  HaplyMessage message;
  for (std::size_t size = 0; size < kState.size(); ++size) {
    const std::vector<char> part(kState.begin(), kState.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(read_haply_message({part.data(), part.size()}, "", "", message)) << size;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::vector<char> changed(kState.begin(), kState.end());
    for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
    if (read_haply_message({changed.data(), changed.size()}, "", "", message) && message.device) {
      EXPECT_TRUE(message.device->position_m.value_or(Vec3::Zero()).allFinite());
    }
  }
}

TEST(HaplyForceCommand, IsTheCommandOfTheDocumentation) {
  HaplyForceCommand command;
  for (const auto key : {HaplyForceKey::vector, HaplyForceKey::values}) {
    ASSERT_TRUE(command.set_device("049D", key));
    for (const Vec3& force : {Vec3(0, 0, 1.5), Vec3(-1e-12, 123.456789, -1e300)}) {
      const json sent = json::parse(command.text(force));
      const json& commands = sent.at("inverse3").at(0).at("commands");
      EXPECT_EQ(sent.at("inverse3").at(0).at("device_id"), "049D");
      const json& numbers =
          commands.at("set_cursor_force").at(key == HaplyForceKey::vector ? "vector" : "values");
      const Vec3 read(numbers.at("x"), numbers.at("y"), numbers.at("z"));
      EXPECT_TRUE(read.isApprox(force, 1e-8)) << read.transpose();
    }
  }
  EXPECT_FALSE(command.set_device("", HaplyForceKey::vector));
  EXPECT_FALSE(command.set_device("a\"b", HaplyForceKey::vector));
  EXPECT_FALSE(command.set_device(std::string(300, 'a'), HaplyForceKey::vector));
}

TEST(HaplyMessage, ReadingAndWritingAllocateNothing) {
  HaplyForceCommand command;
  ASSERT_TRUE(command.set_device("049D", HaplyForceKey::vector));
  const double smallest = -std::numeric_limits<double>::denorm_min();
  HaplyMessage message;
  const std::size_t before = allocation_count();
  const bool is_read = read_haply_message(kState, "04BA", "61548", message);
  const std::size_t length = command.text(Vec3::Constant(smallest)).size();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(is_read);
  EXPECT_LT(length, 200u);
}

}  // namespace
}  // namespace remote_touch::haply_messages_test
