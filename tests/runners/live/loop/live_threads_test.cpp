// The threads of a live run, in real time: how they exchange data, and how they end. The tests are meant for
// the thread sanitizer, too. They do not depend on how long anything takes, because they wait for events.
#include <gtest/gtest.h>
#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "runners/live/loop/servo.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/wait_until.h"

namespace remote_touch::live_threads_test {
namespace {

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

// A live run in a thread of its own. It ends at its stop, or when its device fails.
class BackgroundRun {
 public:
  explicit BackgroundRun(const std::string& device) {
    options_.device = device;
    options_.kernels = &scenes::kernels();
    options_.stop = &stop_;
    options_.rearm = &rearm;
    options_.report = &report;
    options_.on_report = [this](const LiveReport&) { ++reports; };
    options_.report_line = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      reported_ += line + "\n";
    };
    thread_ = std::thread([this] {
      try {
        result_ = run_live(press_experiment(), options_);
      } catch (const std::exception& error) {
        result_.ended = error.what(), result_.failed = true;
      }
    });
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
  bool has_reported(const std::string& part) {
    const std::lock_guard lock(mutex_);
    return reported_.find(part) != std::string::npos;
  }

  std::atomic<bool> rearm = false, report = false;  // what the user asks for
  std::atomic<int> reports = 0;

 private:
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::string reported_;
  LiveOptions options_;
  LiveResult result_;
  std::thread thread_;
};

class LiveThreads : public testing::TestWithParam<const VendorDevice*> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait_until([&] { return double_->now().has_motors_on; })) << "no tick";
  }

  DoubleInstalled double_{*GetParam()};
  BackgroundRun run_{GetParam()->uri};
};

TEST_P(LiveThreads, AReportIsMadeWhileTheyRunAndAStopEndsThem) {
  run_.report = true;
  EXPECT_TRUE(wait_until([&] { return run_.reports == 1; }));
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
  EXPECT_TRUE(wait_until([&] { return run_.has_reported("the handle turns too fast"); }));
  turn(0);
  EXPECT_TRUE(wait_until([&] {
    run_.rearm = true;
    return run_.has_reported("re-armed: ");
  }));
  EXPECT_FALSE(run_.ended_by_stop().failed);
}

INSTANTIATE_TEST_SUITE_P(Vendors, LiveThreads, kVendors, vendor_name);

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
