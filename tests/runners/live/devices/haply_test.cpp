// The adapter of Haply's Inverse3 against a service on a simulated clock: what it reads and writes, what it
// does if the service fails, and the release of the device. Then the text of the messages.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/doubles/simulated_haply.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::haply_test {
namespace {

constexpr const char* kLate = "the Haply service does not answer";

Wrench force(const Vec3& force_N) {
  return {force_N, Vec3::Zero()};
}

// Returns the text of the fault, or nothing.
std::string fault_text(const DeviceFault& fault) {
  return fault ? fault.what : "";
}

class Haply : public testing::Test {
 protected:
  // Runs a tick of one millisecond. Returns its first fault; empty if there was none.
  std::string tick(HapticDevice& device, const Vec3& force_N = Vec3::Zero()) {
    const std::int64_t end_ns = clock_.now_ns() + ms(1);
    const std::string read = fault_text(device.read(reading_)),
                      written = fault_text(device.write(force(force_N)));
    clock_.sleep_until_ns(end_ns);
    return read.empty() ? written : read;
  }
  double newest_force_N() const { return service_.sent().back().command.force_N.norm(); }

  SimulatedClock clock_;
  SimulatedHaply service_{clock_};
  DeviceReading reading_;
};

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
  world.has_handle = false;
  EXPECT_EQ(service_.open()->traits().sensed_axes, 3);
  world.has_handle = world.is_handle_wired = world.a = true;
  const auto wired = service_.open();
  ASSERT_EQ(tick(*wired), "");
  EXPECT_EQ(wired->traits().sensed_axes, 6);
  EXPECT_EQ(reading_.buttons, 1u);

  world.is_handle_wired = false;
  world.c = true;
  world.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitZ());  // about the vertical
  const auto device = service_.open();
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

TEST_F(Haply, FindsDevicesByName) {
  service_.world.devices = {"049D", "04BA"};
  const auto device = service_.open("?device=04BA");
  ASSERT_EQ(tick(*device), "");
  EXPECT_EQ(reading_.position_m, Vec3(9, 9, -9));
  EXPECT_EQ(service_.sent().back().command.device_id, "04BA");
  service_.world.devices = {"049D"};
  tick(*device);
  EXPECT_EQ(tick(*device), "the Inverse3 is no longer in the states of the service");
}

// The service that is silent in the end is given a second.
TEST_F(Haply, RefusesWhatCannotBeOpened) {
  HaplyWorld no_device, no_handle, turned, no_state;
  no_device.devices.clear(), no_handle.has_handle = false, turned.basis = "XZY", no_state.answer = "{}";
  struct Refused {
    HaplyWorld world;
    std::string settings, message;
  };
  std::vector<Refused> all = {{{}, "?forse=values", "has no setting \"forse\": expected force"},
                              {{}, "?force=x", "haply:?force=x: force is \"x\": expected vector, values"},
                              {{}, "?rate=nan", "rate is \"nan\": expected a number from 100 to 8000"},
                              {{}, "?device=04BA", "lists no Inverse3 \"04BA\"; plug it in"},
                              {no_handle, "?handle=61548", "lists no handle \"61548\"; pair it"},
                              {no_device, "", "lists no Inverse3; plug it in"},
                              {turned, "", "is set to the basis XZY; set the basis"},
                              {no_state, "", "no first state (the Inverse3 is no longer"}};
  for (const char* inventory : {"garbage", "[]", "\xff\xff"}) {
    all.push_back({{}, "", "is this the Inverse service?"});
    all.back().world.inventory = inventory;
  }
  for (const Refused& refused : all) {
    service_.world = refused.world;
    EXPECT_HAS(refusal([&] { service_.open(refused.settings); }), refused.message);
  }
  service_.hang();
  const std::int64_t start_ns = clock_.now_ns();
  EXPECT_HAS(refusal([&] { service_.open(); }), "an inventory was expected; is this the Inverse service?");
  EXPECT_EQ(clock_.now_ns() - start_ns, ms(1000));
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

class HaplyFault : public Haply {
 protected:
  // Duration of a call, in microseconds.
  std::int64_t takes_us(const std::function<void()>& call) {
    const std::int64_t start_ns = clock_.now_ns();
    call();
    return (clock_.now_ns() - start_ns) / 1000;
  }
  // The first tick with a fault among 300 with this force, and the fault. The number is -1 if there is none.
  struct FirstFault {
    int tick = -1;
    std::string text;
  };
  FirstFault first_fault(HapticDevice& device, const Vec3& force_N) {
    for (int i = 0; i < 300; ++i)
      if (const std::string fault = tick(device, force_N); !fault.empty()) return {i, fault};
    return {};
  }
};

TEST_F(HaplyFault, ClosedConnectionStaysAFault) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device), "");
  service_.die();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(fault_text(device->read(reading_)), "the Haply service closed the connection");
    EXPECT_EQ(fault_text(device->write({})), "the Haply service closed the connection");
  }
}

// A tick with a hanging service ends well before the 10 ms after which the loop counts as hung.
TEST_F(HaplyFault, WaitsForALateOrAHangingServiceForABoundedTime) {
  const auto device = service_.open();
  service_.answers_after_ns = 5'900'000;
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->read(reading_)), ""); }), 5900);
  ASSERT_EQ(fault_text(device->write({})), "");
  service_.hang();
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->read(reading_)), kLate); }), 6000);
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->write({})), kLate); }), 1500);
}

// Every tick has a fault while the service hangs, and no command queues up. Then the service is back.
TEST_F(HaplyFault, AServiceThatHangsAndReturnsSendsItsLatestState) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device, {1, 0, 0}), "");
  service_.hang();
  const std::size_t before = service_.sent().size();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(fault_text(device->read(reading_)), kLate);
    EXPECT_EQ(fault_text(device->write(force({1, 0, 0}))), kLate);
  }
  EXPECT_EQ(service_.sent().size(), before);
  service_.world.position_m = Vec3(0.5, 0, 0);
  service_.resume();
  ASSERT_EQ(fault_text(device->read(reading_)), "");
  EXPECT_EQ(reading_.position_m, Vec3(0.5, 0, 0)) << "the state from before it hung";
  EXPECT_EQ(newest_force_N(), 0);
}

TEST_F(HaplyFault, GarbageInsteadOfAStateIsAFault) {
  const auto device = service_.open();
  const auto of_device = [](const std::string& state) {
    return R"({"inverse3":[{"device_id":"049D","state":{)" + state + "}}]}";
  };
  for (const auto& [answer, message] :
       {std::pair<std::string, std::string>{"garbage", ""},
        {"{}", ""},
        {"[]", ""},
        {of_device(""), ""},
        {of_device(R"("cursor_position":{"x":NaN,"y":0,"z":0})"), ""},
        {of_device(R"("cursor_position":{"x":0,"y":0,"z":0})"), "sent no cursor_velocity"}}) {
    service_.world.answer = answer;
    tick(*device);
    reading_.position_m = Vec3(1, 2, 3);
    const std::string fault = tick(*device);
    EXPECT_NE(fault, "") << answer;
    EXPECT_HAS(fault, message);
    EXPECT_EQ(reading_.position_m, Vec3(1, 2, 3)) << "a reading from a fault";
  }
  service_.world.answer.clear();
  tick(*device);
  EXPECT_EQ(tick(*device), "");
}

TEST_F(HaplyFault, ReportsANanForceAndSendsZero) {
  const auto device = service_.open();
  const Vec3 none(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(tick(*device, none), "the commanded force is not finite");
  EXPECT_EQ(tick(*device), "");
  for (const auto& sent : service_.sent()) EXPECT_TRUE(sent.command.force_N.isZero());
}

// The tick that reports a force which has not followed for 50 ms. Ticks begin at 0.2 ms. The answer to the
// first one, at 0.4 ms, is the last that agrees with the force that was given.
constexpr int kUnfollowedTick = 51;

TEST_F(HaplyFault, TriesBothForceKeys) {
  EXPECT_EQ(first_fault(*service_.open(), {0, 1, 0}).tick, -1);
  const FirstFault values = first_fault(*service_.open("?force=values"), {0, 1, 0});
  EXPECT_HAS(values.text, "try force=vector");
  EXPECT_EQ(values.tick, kUnfollowedTick);

  service_.world.force_key = "values";
  EXPECT_EQ(first_fault(*service_.open("?force=values"), {0, 1, 0}).tick, -1);
  EXPECT_EQ(service_.sent()[service_.sent().size() - 2].command.key, "values");
  const FirstFault vector = first_fault(*service_.open("?force=vector"), {0, 1, 0});
  EXPECT_HAS(vector.text, "try force=values");
  EXPECT_EQ(vector.tick, kUnfollowedTick);
  EXPECT_EQ(first_fault(*service_.open("?force=vector&check=off"), {0, 1, 0}).tick, -1);
  EXPECT_EQ(first_fault(*service_.open("?force=vector"), {0, 0.1, 0}).tick, -1) << "too small a force";
}

TEST_F(HaplyFault, AForceThatDoesNotFollowTheCommandIsAFault) {
  HaplyWorld& world = service_.world;
  world.force_factor = 0.3;  // the gate of the documentation's sample
  EXPECT_EQ(first_fault(*service_.open(), {0, 3, 0}).tick, -1);
  world.force_factor = -1;
  const FirstFault opposite = first_fault(*service_.open(), {0, 1, 0});
  EXPECT_HAS(opposite.text, "does not apply the force that it is sent");
  EXPECT_EQ(opposite.tick, kUnfollowedTick);
  world.force_factor = 1;
  world.other_N = Vec3(0, 0, 2);
  EXPECT_HAS(first_fault(*service_.open(), {0, 0, 0}).text, "applies a force that it was not sent");
  world.reports_force = false;
  EXPECT_EQ(first_fault(*service_.open(), {0, 1, 0}).tick, -1);
}

class HaplyRelease : public HaplyFault {
 protected:
  // Releases the device at that moment, as another thread would. Stores the duration in took_us_, in
  // microseconds.
  void release_at(HapticDevice& device, double moment_s) {
    clock_.at(moment_s, [&] { took_us_ = takes_us([&] { device.release(); }); });
  }
  std::int64_t took_us_ = -1;
};

TEST_F(HaplyRelease, TheLastCommandIsNoForce) {
  {
    const auto device = service_.open();
    ASSERT_EQ(tick(*device, {3, 0, 0}), "");
  }
  EXPECT_EQ(newest_force_N(), 0);
  EXPECT_EQ(service_.sent()[service_.sent().size() - 2].command.force_N, Vec3(3, 0, 0));
  EXPECT_TRUE(service_.is_cut());
}

TEST_F(HaplyRelease, ReleaseBetweenTwoTicksSendsZeroForceAtOnce) {
  const auto device = service_.open();
  release_at(*device, 0.0207);
  std::string last;
  for (int i = 0; i < 40; ++i) last = tick(*device, {1, 0, 0});
  EXPECT_EQ(took_us_, 200);  // it waits for the service's answer
  EXPECT_EQ(last, "the device was released");
  EXPECT_EQ(service_.sent().back().at_ns, 20'700'000);
  EXPECT_EQ(newest_force_N(), 0);
  device->release();
  EXPECT_EQ(service_.sent().back().at_ns, 20'700'000);
}

// A thread that hangs between reading and writing sends nothing when it comes back.
TEST_F(HaplyRelease, SendsZeroForceWhileATickHangs) {
  const auto device = service_.open();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(tick(*device, {1, 0, 0}), "");
  ASSERT_EQ(fault_text(device->read(reading_)), "");
  release_at(*device, 0.02);
  clock_.sleep_s(0.1);
  EXPECT_EQ(fault_text(device->write(force({1, 0, 0}))), "the device was released");
  EXPECT_EQ(service_.sent().back().at_ns, ms(20));
  EXPECT_EQ(newest_force_N(), 0);
}

// The call in progress is given 5 ms. No command can be sent meanwhile, so the connection is cut.
TEST_F(HaplyRelease, SendsZeroForceWhileAReadWaits) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device, {1, 0, 0}), "");
  service_.hang();
  release_at(*device, clock_.now_s() + 0.001);
  EXPECT_TRUE(device->read(reading_));
  EXPECT_EQ(took_us_, 5000);
  EXPECT_TRUE(service_.is_cut());
  EXPECT_EQ(fault_text(device->write(force({1, 0, 0}))), "the Haply service closed the connection");
}

TEST_F(HaplyRelease, CutsTheConnectionAfter20MsIfTheServiceHangs) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device, {1, 0, 0}), "");
  service_.hang();
  EXPECT_EQ(takes_us([&] { device->release(); }), 20'000);
  EXPECT_EQ(newest_force_N(), 0);
  EXPECT_TRUE(service_.is_cut());
  EXPECT_EQ(fault_text(device->write(force({1, 0, 0}))), "the device was released");
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
  ASSERT_TRUE(read_haply_message(kState, "04BB", "61549", message));
  ASSERT_TRUE(message.device);
  EXPECT_EQ(message.device->position_m, Vec3(1, 2, 3));
  EXPECT_FALSE(message.device->force_N || message.handle);
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
  for (std::size_t size = 0; size < kState.size(); ++size)
    EXPECT_FALSE(read_haply_message(std::string_view(kState).substr(0, size), "", "", message)) << size;
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

}  // namespace
}  // namespace remote_touch::haply_test
