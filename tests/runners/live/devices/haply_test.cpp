// The adapter of Haply's Inverse3 against a service on a simulated clock: what it reads and writes.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/runners/live/devices/haply_ticks.h"
#include "tests/support/test_files.h"

namespace remote_touch::haply_test {
namespace {

using Haply = SimulatedHaplyTest;

TEST_F(Haply, ConvertsAxesAndUnits) {
  const auto device = service_.open();
  EXPECT_EQ(device->traits().name, "Haply Inverse3 049D");
  EXPECT_EQ(device->traits().actuated_axes, 3);
  for (const auto& sent : service_.sent())
    EXPECT_TRUE(sent.command.force_N.isZero()) << "before the first write";

  service_.world.position_m = Vec3(0.1, 0.2, 0.3);  // right, away from the user, up
  service_.world.velocity_m_per_s = Vec3(1, 2, 3);
  ASSERT_EQ(tick(*device), "");
  EXPECT_TRUE(reading_.position_m.isApprox(Vec3(0.1, 0.3, -0.2), 1e-12));
  EXPECT_TRUE(reading_.velocity_m_per_s.isApprox(Vec3(1, 3, -2), 1e-12));

  ASSERT_EQ(tick(*device, {1, 2, 3}), "");  // right, up, towards the user
  const HaplyCommand& command = service_.sent().back().command;
  EXPECT_EQ(command.force_N, Vec3(1, -3, 2));
  EXPECT_EQ(command.key, "vector");
  EXPECT_EQ(command.device_id, "049D");
}

TEST_F(Haply, ReadsOrientationAndButtonsOfTheHandle) {
  HaplyWorld& world = service_.world;
  world.a = world.c = true;
  world.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitZ());  // about the vertical
  const auto device = service_.open();
  EXPECT_EQ(device->traits().sensed_axes, 6);
  ASSERT_EQ(tick(*device), "");
  EXPECT_EQ(reading_.buttons, 0b101u);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  EXPECT_LT(reading_.orientation.angularDistance(expected), 1e-9);

  world.b = true;
  world.a = false;
  world.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitY());  // about the axis that points away from the user
  ASSERT_EQ(tick(*device), "");                               // the answer to what was sent before
  ASSERT_EQ(tick(*device), "");
  EXPECT_EQ(reading_.buttons, 0b110u);
  const Eigen::Quaterniond rolled(Eigen::AngleAxisd(-0.5, Vec3::UnitZ()));
  EXPECT_LT(reading_.orientation.angularDistance(rolled), 1e-9);

  world.orientation.coeffs().setZero();
  tick(*device);
  EXPECT_EQ(tick(*device), "the handle sent an orientation that is not a unit quaternion");
  world.has_handle = false;
  tick(*device);
  EXPECT_EQ(tick(*device), "the handle is no longer in the states of the service");
}

TEST_F(Haply, AcceptsNoHandleAndAWiredOne) {
  service_.world.has_handle = false;
  EXPECT_EQ(service_.open()->traits().sensed_axes, 3);
  EXPECT_HAS(refusal([&] { service_.open("?handle=61548"); }), "lists no handle \"61548\"; pair it");
  service_.world.has_handle = service_.world.is_handle_wired = service_.world.a = true;
  const auto device = service_.open();
  ASSERT_EQ(tick(*device), "");
  EXPECT_EQ(device->traits().sensed_axes, 6);
  EXPECT_EQ(reading_.buttons, 1u);
}

TEST_F(Haply, FindsDevicesByName) {
  service_.world.devices = {"049D", "04BA"};
  {
    const auto device = service_.open("?device=04BA");
    ASSERT_EQ(tick(*device), "");
    EXPECT_EQ(reading_.position_m, Vec3(9, 9, -9));
    EXPECT_EQ(service_.sent().back().command.device_id, "04BA");
    service_.world.devices = {"049D"};
    tick(*device);
    EXPECT_EQ(tick(*device), "the Inverse3 is no longer in the states of the service");
  }
  EXPECT_HAS(refusal([&] { service_.open("?device=04BA"); }), "lists no Inverse3 \"04BA\"; plug it in");
}

TEST_F(Haply, RefusesWhatCannotBeOpened) {
  const auto refused = [&](const HaplyWorld& world, const std::string& settings = "") {
    service_.world = world;
    return refusal([&] { service_.open(settings); });
  };
  EXPECT_HAS(refused({}, "?forse=values"), "has no setting \"forse\": expected force");
  EXPECT_HAS(refused({}, "?force=x"), "haply:?force=x: force is \"x\": expected vector, values");
  EXPECT_HAS(refused({}, "?rate=nan"), "rate is \"nan\": expected a number from 100 to 8000");
  HaplyWorld world;
  world.devices.clear();
  EXPECT_HAS(refused(world), "lists no Inverse3; plug it in");
  world = {};
  world.basis = "XZY";
  EXPECT_HAS(refused(world), "is set to the basis XZY; set the basis");
  world = {};
  world.answer = "{}";
  EXPECT_HAS(refused(world), "no first state (the Inverse3 is no longer");
  for (const char* inventory : {"garbage", "[]", "\xff\xff"}) {
    world = {};
    world.inventory = inventory;
    EXPECT_HAS(refused(world), "is this the Inverse service?");
  }
}

TEST_F(Haply, AServiceThatIsSilentIsRefusedAfterASecond) {
  service_.hang();
  EXPECT_HAS(refusal([&] { service_.open(); }), "an inventory was expected; is this the Inverse service?");
  EXPECT_EQ(clock_.now_ns(), ms(1000));
}

// The rate of commands at the service is that of the loop.
TEST_F(Haply, SendsOneCommandPerTickAtTheRequestedRate) {
  for (const int rate_hz : {1000, 4000}) {
    const auto device = service_.open("?rate=" + std::to_string(rate_hz));
    EXPECT_EQ(device->traits().tick_rate_hz, rate_hz);
    const std::int64_t start_ns = clock_.now_ns();
    run_ticks(*device, rate_hz, [&](int) {
      DeviceReading reading;
      EXPECT_FALSE(device->read(reading));
      EXPECT_FALSE(device->write(force({0, 0.2, 0})));
    });
    std::vector<std::int64_t> pushed_ns;
    for (const auto& sent : service_.sent())
      if (sent.at_ns >= start_ns && !sent.command.force_N.isZero()) pushed_ns.push_back(sent.at_ns);
    ASSERT_EQ(pushed_ns.size(), static_cast<std::size_t>(rate_hz));
    // Returns the first tick from which on all answers, which need 0.2 ms, arrive in time.
    constexpr int kFirst = 10;
    EXPECT_EQ(pushed_ns.back() - pushed_ns[kFirst], (rate_hz - 1 - kFirst) * (ms(1000) / rate_hz));
  }
}

// A state that was measured for a command long ago does not describe the present.
TEST_F(Haply, AStateThatIsOlderThan20MsIsAskedForAgain) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device), "");
  for (const auto& [pause_ms, commands] : {std::pair{19, 1}, {21, 2}}) {
    clock_.sleep_s(1e-3 * (pause_ms - 1));
    const std::size_t before = service_.sent().size();
    ASSERT_EQ(tick(*device), "");
    EXPECT_EQ(static_cast<int>(service_.sent().size() - before), commands) << pause_ms;
  }
}

// The text that Haply's service and its client exchange: samples of its documentation, and texts that are no
// message.

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
}  // namespace remote_touch::haply_test
