// What happens to a live run whose device is behind a service of its vendor: Haply's, simulated, and
// spacenavd, of which a socket of the test's own stands in.
#include <gtest/gtest.h>

#include <memory>

#include "tests/doubles/haply_service.h"
#include "tests/doubles/spacenav_socket.h"
#include "tests/runners/live/loop/background_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_service_test {
namespace {

class PressedInverse3 : public testing::Test {
 protected:
  void SetUp() override {
    const auto start = [&] { return std::make_unique<BackgroundRun>(kPress, "haply:" + service_.address()); };
    ASSERT_TRUE(
        press_in(run_, start, {[&] { hold(0.03); }, [&] { hold(-0.002); }, [&] { return force_N(); }}))
        << "never touched";
  }

  // The service's z is up.
  void hold(double above_m) {
    world_.position_m = Vec3(0, 0, height_m_ + above_m);
    service_.set(world_);
  }
  // What the service was told last.
  double force_N() const {
    const auto commands = service_.commands();
    return commands.empty() ? 0 : commands.back().force_N.norm();
  }

  const double height_m_ = table_height_m();
  HaplyWorld world_;
  HaplyService service_;
  std::unique_ptr<BackgroundRun> run_;
};

TEST_F(PressedInverse3, AStopEndsTheForce) {
  run_->stop();
  EXPECT_LT(time_to_nothing_s([&] { return force_N(); }), kPromise_s);
  EXPECT_EQ(run_->ended().ended, "stopped by a signal");
  EXPECT_EQ(force_N(), 0);
}

// Without messages the device idles; nobody can tell it anything.
TEST_F(PressedInverse3, AServiceThatDiesEndsTheRun) {
  service_.die();
  const LiveResult& result = run_->ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: the Haply service closed the connection");
}

TEST_F(PressedInverse3, AServiceThatHangsEndsTheRun) {
  service_.hang();
  const LiveResult& result = run_->ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: the Haply service does not answer");
}

TEST_F(PressedInverse3, AStateThatIsNoNumberEndsTheForceAndTheRun) {
  world_.answer = R"({"inverse3": [{"device_id": "049D", "state": {"cursor_position": {"x": null}}}]})";
  service_.set(world_);
  EXPECT_LT(time_to_nothing_s([&] { return force_N(); }), kPromise_s);
  EXPECT_TRUE(run_->ended().failed);
}

TEST(LiveSpaceMouse, AKilledDaemonEndsTheRun) {
  const TestFolder folder("live_service_test");
  const std::string path = (folder / "sock").string();
  SpacenavSocket daemon(path);
  BackgroundRun run(kPress, "spnav:" + path);
  daemon.accept();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(run.told().find("failed"), std::string::npos);
  daemon.close();
  const LiveResult& result = run.ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: ");
}

}  // namespace
}  // namespace remote_touch::live_service_test
