// The end of a live run by an input that cannot be used: a frame of the sensor, or a file that has changed.
#include <gtest/gtest.h>
#include <array>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/parameters/parameter.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/servo.h"
#include "tests/doubles/simulated_haply.h"
#include "tests/doubles/spacenav_socket.h"
#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::live_refusal_test {
namespace {

constexpr int kMoved = 6;  // captured at 200 ms

// The camera of an experiment moves by 200 mm along its axis with frame kMoved. The points are right in the
// world.
class MovingCamera final : public Scenario {
 public:
  explicit MovingCamera(std::unique_ptr<const Scenario> scene) : scene_(std::move(scene)) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 100; }
  PointCloud cloud(int frame) const override {
    PointCloud cloud = scene_->cloud(0);
    if (frame < kMoved) return cloud;
    const RigidTransform X_WC = cloud.image->X_WC, moved = X_WC * Eigen::Translation3d(0, 0, 0.2);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p_W = moved * (X_WC.inverse() * cloud.point(i));
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
    }
    cloud.image->X_WC = moved;
    return cloud;
  }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scene_->signed_distance(p_W, time_s);
  }

 private:
  const std::unique_ptr<const Scenario> scene_;
};

class RefusedRun : public testing::Test {
 protected:
  LiveResult run(bool moves) {
    SimulatedRun run(clock_, press_experiment(), SimulatedRun::simulated_device,
                     [=](const Experiment& experiment, Clock& clock) -> std::unique_ptr<DepthSource> {
                       if (!moves) return SimulatedRun::scenario_camera(experiment, clock);
                       return std::make_unique<ScenarioCamera>(
                           std::make_unique<MovingCamera>(experiment.build_scenario(scenes::kernels())),
                           clock, FrameEncoder::Settings{.name = "./scene"});
                     });
    run.options.duration_s = 1;
    run.record(session());
    run.options.check_inputs = check_inputs_;
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  std::filesystem::path session() const { return folder_ / "session.h5"; }

  const TestFolder folder_{"live_refusal"};
  SimulatedClock clock_;
  std::function<void()> check_inputs_;
  std::vector<SimulatedRun::ReportedLine> reported_;
};

// The user's part checks every 10 ms.
TEST_F(RefusedRun, AFrameFromAnotherPlaceEndsTheRun) {
  const LiveResult result = run(true);
  EXPECT_HAS(result.refused, "./scene: frame 6 was captured from another pose (0.2 m and 0 deg");
  EXPECT_EQ(result.ended, result.refused);
  EXPECT_LE(clock_.now_ns(), 211'000'000);
  EXPECT_TRUE(reported_.empty()) << reported_[0].line;
  EXPECT_EQ(result.counts.camera.received, kMoved);
  const SessionReader recorded(session());
  EXPECT_EQ(recorded.frame_count(), static_cast<std::size_t>(kMoved)) << "the hand is kept until then";
  EXPECT_EQ(recorded.ended(), result.refused);
}

TEST_F(RefusedRun, AFileThatHasChangedIsAnInputError) {
  check_inputs_ = [] { throw InputError("./scene", "changed while it was read"); };
  const LiveResult result = run(false);
  EXPECT_EQ(result.refused, "./scene: changed while it was read");
  EXPECT_EQ(result.ended, "its duration has elapsed; ./scene: changed while it was read");
  EXPECT_EQ(SessionReader(session()).ended(), result.ended);
}

TEST_F(RefusedRun, OtherFailuresAreNoRefusal) {
  int checks = 0;
  check_inputs_ = [&] { ++checks; };
  const LiveResult result = run(false);
  EXPECT_EQ(checks, 1);
  EXPECT_EQ(result.refused, "");
  EXPECT_FALSE(result.failed) << result.ended;
  EXPECT_EQ(SessionReader(session()).ended(), "its duration has elapsed");
}

// The exchange of data between threads of the live loop. The tests are meant for the thread sanitizer, too.

constexpr int kValues = 200'000;

// A torn value would not hold the same number everywhere.
using Wide = std::array<int, 64>;

// Both sides yield instead of spinning, so that they alternate on a single free core, too.
TEST(TripleBuffer, GivesTheNewestWholeAndInOrder) {
  TripleBuffer<Wide> buffer;
  std::jthread producer([&](const std::stop_token& enough) {
    for (int i = 1; !enough.stop_requested(); ++i) {
      buffer.back().fill(i);
      buffer.publish();
      if (i % 16 == 0) std::this_thread::yield();
    }
  });
  int last = 0;
  for (int taken = 0; taken < kValues / 100;) {
    if (!buffer.take()) {
      std::this_thread::yield();
      continue;
    }
    const Wide& front = buffer.front();
    for (const int part : front) ASSERT_EQ(part, front[0]) << "torn";
    ASSERT_GT(front[0], last) << "reversed or repeated";
    last = front[0], ++taken;
  }
}

TEST(TripleBuffer, ReportsWhetherAValueWasOvertaken) {
  TripleBuffer<int> buffer;
  buffer.back() = 1;
  EXPECT_TRUE(buffer.publish());
  buffer.back() = 2;
  EXPECT_FALSE(buffer.publish());
  EXPECT_TRUE(buffer.take());
  EXPECT_EQ(buffer.front(), 2);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.front(), 2);
  buffer.back() = 3;
  EXPECT_TRUE(buffer.publish());
}

TEST(Ring, HandsOverEveryValueInOrder) {
  Ring<Wide> ring(60);
  std::jthread producer([&](const std::stop_token& enough) {
    for (int i = 0; i < kValues && !enough.stop_requested();) {
      Wide* const next_slot = ring.next_slot();
      if (!next_slot) {
        std::this_thread::yield();
        continue;
      }
      next_slot->fill(i++);
      ring.push();
    }
  });
  for (int i = 0; i < kValues;) {
    const Wide* const oldest = ring.oldest();
    if (!oldest) {
      std::this_thread::yield();
      continue;
    }
    for (const int part : *oldest) ASSERT_EQ(part, i);
    ring.pop(), ++i;
  }
  producer.join();
  EXPECT_EQ(ring.oldest(), nullptr);
}

TEST(Ring, HasNoRoomWhenFull) {
  Ring<int> ring(4);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(ring.next_slot(), nullptr);
    *ring.next_slot() = i;
    ring.push();
  }
  EXPECT_EQ(ring.next_slot(), nullptr);
  ring.pop();
  EXPECT_NE(ring.next_slot(), nullptr);
}

// A live run whose device is behind a service of its vendor, on a simulated clock. The services are Haply's,
// and spacenavd, which a socket of the test replaces.

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

// The threads of a live run, in real time: how they exchange data, and how they end. The tests are meant for
// the thread sanitizer, too. They do not depend on how long anything takes, because they wait for events.

// A live run in a thread of its own.
class BackgroundRun {
 public:
  explicit BackgroundRun(const std::string& device) {
    options_.device = device;
    options_.kernels = &scenes::kernels();
    options_.stop = &stop_;
    options_.rearm = &rearm_;
    options_.report = &report_;
    options_.on_report = [this](const LiveReport&) { ++reports_; };
    options_.report_line = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      reported_ += line + "\n";
    };
    thread_ = std::thread([this] { run(); });
  }
  ~BackgroundRun() { ended_by_stop(); }
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  const LiveResult& ended() {
    if (thread_.joinable()) thread_.join();
    return result_;
  }
  const LiveResult& ended_by_stop() {
    stop_ = true;
    return ended();
  }
  std::string reported() {
    const std::lock_guard lock(mutex_);
    return reported_;
  }
  void rearm() { rearm_ = true; }
  void ask_for_a_report() { report_ = true; }
  int reports() const { return reports_; }

 private:
  void run() try { result_ = run_live(press_experiment(), options_); } catch (const std::exception& error) {
    result_.ended = error.what(), result_.failed = true;
  }

  std::atomic<bool> stop_ = false, rearm_ = false, report_ = false;
  std::atomic<int> reports_ = 0;
  std::mutex mutex_;
  std::string reported_;
  LiveOptions options_;
  LiveResult result_;
  std::thread thread_;
};

class LiveThreads : public testing::TestWithParam<const VendorDevice*> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait_until([&] { return double_->now().has_motors_on; })) << "no tick: " << run_.reported();
  }

  DoubleInstalled double_{*GetParam()};
  BackgroundRun run_{GetParam()->uri};
};

TEST_P(LiveThreads, AStopEndsThem) {
  const LiveResult& result = run_.ended_by_stop();
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_FALSE(result.failed);
  EXPECT_GT(result.log.trace.length(), 0u);
  EXPECT_FALSE(double_->now().has_motors_on);
}

TEST_P(LiveThreads, ADeviceThatFailsEndsThem) {
  double_->set([](DeviceDouble::State& state) { state.reading_error = GetParam()->error; });
  const LiveResult& result = run_.ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: ");
  EXPECT_FALSE(double_->now().has_motors_on);
}

TEST_P(LiveThreads, AnotherThreadReleasesAHangingLoopAndTheRunContinues) {
  double_->hang_next(DeviceDouble::write_force);
  ASSERT_TRUE(wait_until([&] { return double_->is_hanging(); }));
  EXPECT_TRUE(wait_until([&] { return !double_->now().has_motors_on; }));
  double_->release();
  EXPECT_TRUE(wait_until([&] { return double_->now().has_motors_on; }));
  const LiveResult& result = run_.ended_by_stop();
  EXPECT_GE(result.counts.stalls, 1);
  EXPECT_FALSE(result.failed) << result.ended;
}

TEST_P(LiveThreads, ALatchIsReportedAndRearmed) {
  const auto turn = [&](double rad_per_s) {
    double_->set([&](DeviceDouble::State& state) { state.turning = {rad_per_s, 0, 0}; });
  };
  turn(100);
  EXPECT_TRUE(
      wait_until([&] { return run_.reported().find("the handle turns too fast") != std::string::npos; }));
  turn(0);
  EXPECT_TRUE(wait_until([&] {
    run_.rearm();
    return run_.reported().find("re-armed: ") != std::string::npos;
  }));
  EXPECT_FALSE(run_.ended_by_stop().failed);
}

TEST_P(LiveThreads, AReportIsMadeWhileTheyRun) {
  run_.ask_for_a_report();
  EXPECT_TRUE(wait_until([&] { return run_.reports() == 1; }));
  EXPECT_FALSE(run_.ended_by_stop().failed);
}

INSTANTIATE_TEST_SUITE_P(Vendors, LiveThreads, testing::Values(&kForceDimension, &kOpenHaptics, &kEntact),
                         [](const auto& device) { return device.param->name; });

TEST(LiveThreadsEnd, SwitchesTheMotorsOffIfReportingThrows) {
  const DoubleInstalled behind(kForceDimension);
  LiveOptions options;
  options.kernels = &scenes::kernels();
  options.device = "fd:0";
  options.report_line = [](const std::string&) { throw std::runtime_error("nobody listens"); };
  behind->set([](DeviceDouble::State& state) { state.turning = {100, 0, 0}; });
  EXPECT_THROW(run_live(press_experiment(), options), std::runtime_error);
  EXPECT_FALSE(behind->now().has_motors_on);
}

}  // namespace
}  // namespace remote_touch::live_refusal_test
