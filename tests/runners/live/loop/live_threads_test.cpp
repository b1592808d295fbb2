// The threads of a live run, in real time: how they exchange data, and how they end. The tests are meant for
// the thread sanitizer, too. They do not depend on how long anything takes, because they wait for events.
#include <gtest/gtest.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/runners/live/loop/pressed_hand.h"
#include "tests/support/test_files.h"
#include "tests/support/wait_until.h"

namespace remote_touch::live_threads_test {
namespace {

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
}  // namespace remote_touch::live_threads_test
