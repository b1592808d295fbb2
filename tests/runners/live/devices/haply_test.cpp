// The adapter of Haply's Inverse3 against a service on a simulated clock: what it reads and writes.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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

}  // namespace
}  // namespace remote_touch::haply_test
