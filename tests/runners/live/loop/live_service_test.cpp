// A live run whose device is behind a service of its vendor, on a simulated clock. The services are Haply's,
// and spacenavd, which a socket of the test replaces.
#include <gtest/gtest.h>

#include <memory>

#include "runners/live/devices/device_table.h"
#include "tests/doubles/simulated_haply.h"
#include "tests/doubles/spacenav_socket.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_service_test {
namespace {

class PressedInverse3 : public testing::Test {
 protected:
  void SetUp() override {
    hold(kAbove_m);
    clock_.at(kPressed_s, [&] { hold(kBelow_m); });
    run_.options.duration_s = 0.5;
  }
  // The service's z axis points up.
  void hold(double above_m) { service_.world.position_m = Vec3(0, 0, height_m_ + above_m); }
  // Forces that the service received.
  ForceOverTime force() const {
    ForceOverTime force;
    for (const auto& [at_ns, command] : service_.sent())
      force.pieces.push_back({at_ns, command.force_N.norm()});
    return force;
  }

  const double height_m_ = table_height_m();
  SimulatedClock clock_;
  SimulatedHaply service_{clock_};
  SimulatedRun run_{clock_, press_experiment(),
                    [this](const Experiment&, Clock&) { return service_.open(); }};
};

TEST_F(PressedInverse3, AStopEndsTheForceInTheNextTick) {
  std::atomic<bool> stop = false;
  run_.options.stop = &stop;
  clock_.at(0.3, [&] { stop = true; });
  const LiveResult result = run_.run();
  EXPECT_GT(force().at(ms(299.9)), 1);
  EXPECT_GE(force().force_end_ns(), ms(300));
  EXPECT_LE(force().force_end_ns(), ms(301));
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_FALSE(result.failed);
}

// The device idles without messages, and no program can command it any more.
TEST_F(PressedInverse3, AServiceThatDiesEndsTheRun) {
  clock_.at(0.3, [&] { service_.die(); });
  const LiveResult result = run_.run();
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.ended, "the device failed: the Haply service closed the connection");
  EXPECT_LE(clock_.now_ns(), ms(311));
}

TEST_F(PressedInverse3, AServiceThatHangsEndsTheRun) {
  clock_.at(0.3, [&] { service_.hang(); });
  const LiveResult result = run_.run();
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.ended, "the device failed: the Haply service does not answer");
}

TEST_F(PressedInverse3, AStateWithoutANumberEndsTheForceAndTheRun) {
  clock_.at(0.3, [&] {
    service_.world.answer =
        R"({"inverse3": [{"device_id": "049D", "state": {"cursor_position": {"x": null}}}]})";
  });
  const LiveResult result = run_.run();
  EXPECT_GT(force().at(ms(299.9)), 1);
  EXPECT_GE(force().force_end_ns(), ms(300));
  EXPECT_LE(force().force_end_ns(), ms(302));
  EXPECT_TRUE(result.failed);
}

TEST(LiveSpaceMouse, AKilledDaemonEndsTheRun) {
  const TestFolder folder("live_service_test");
  const std::string path = (folder / "sock").string();
  SpacenavSocket daemon(path);
  SimulatedClock clock;
  SimulatedRun run(clock, press_experiment(), [&](const Experiment&, Clock& of_device) {
    auto device = open_spacenav(path, of_device);
    daemon.accept();
    return device;
  });
  run.options.duration_s = 1;
  clock.at(0.2, [&] { daemon.close(); });
  const LiveResult result = run.run();
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(result.ended, "the device failed: spacenavd has closed the connection");
  EXPECT_EQ(clock.now_ns(), ms(210));
}

}  // namespace
}  // namespace remote_touch::live_service_test
