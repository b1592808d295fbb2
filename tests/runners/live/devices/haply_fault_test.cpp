// The adapter of Haply's Inverse3 with a faulty service on a simulated clock, and the release of the device.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "runners/live/devices/haply.h"
#include "tests/runners/live/devices/haply_ticks.h"
#include "tests/support/test_files.h"

namespace remote_touch::haply_fault_test {
namespace {

class HaplyFault : public SimulatedHaplyTest {
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
TEST_F(HaplyFault, WaitsForAHangingServiceForABoundedTime) {
  const auto device = service_.open();
  ASSERT_EQ(tick(*device), "");
  service_.hang();
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->read(reading_)), kLate); }), 6000);
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->write({})), kLate); }), 1500);
}

TEST_F(HaplyFault, AnAnswerThatIsLateIsWaitedFor) {
  const auto device = service_.open();
  service_.answers_after_ns = 5'900'000;
  EXPECT_EQ(takes_us([&] { EXPECT_EQ(fault_text(device->read(reading_)), ""); }), 5900);
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
  const std::string nan =
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":NaN,"y":0,"z":0}}}]})";
  for (const std::string& answer : {nan, std::string("garbage"), std::string("{}"), std::string("[]"),
                                    std::string(R"({"inverse3":[{"device_id":"049D","state":{}}]})")}) {
    service_.world.answer = answer;
    tick(*device);
    reading_.position_m = Vec3(1, 2, 3);
    EXPECT_NE(tick(*device), "") << answer;
    EXPECT_EQ(reading_.position_m, Vec3(1, 2, 3)) << "a reading from a fault";
  }
  service_.world.answer.clear();
  tick(*device);
  EXPECT_EQ(tick(*device), "");
}

TEST_F(HaplyFault, AStateWithoutVelocityIsAFault) {
  const auto device = service_.open();
  service_.world.answer =
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0,"y":0,"z":0}}}]})";
  tick(*device);
  EXPECT_HAS(tick(*device), "sent no cursor_velocity");
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

}  // namespace
}  // namespace remote_touch::haply_fault_test
