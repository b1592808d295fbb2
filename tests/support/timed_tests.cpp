#include "tests/support/timed_tests.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace remote_touch {

namespace {

constexpr double kBearable_s = 0.002;
constexpr int kMaxTries = 6;
constexpr const char* kTry = "REMOTE_TOUCH_TRY";  // of the process that was started again

using Clock = std::chrono::steady_clock;
constexpr auto kNap = std::chrono::milliseconds(1);

// How long the machine has kept threads from running that had nothing to wait for.
class Pauses {
 public:
  Pauses() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(cpu, &allowed)) watches_.emplace_back([this, cpu] { watch(cpu); });
    while (watching_ < static_cast<int>(watches_.size())) std::this_thread::yield();
  }
  // The longest.
  double end_s() {
    stop_ = true;
    for (std::thread& watch : watches_) watch.join();
    return max_s_;
  }

 private:
  void watch(int cpu) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(cpu, &only);
    ::sched_setaffinity(0, sizeof only, &only);
    Clock::time_point due = Clock::now() + kNap;
    ++watching_;
    while (!stop_) {
      std::this_thread::sleep_until(due);
      const Clock::time_point now = Clock::now();
      note(std::chrono::duration<double>(now - due).count());
      due = now + kNap;
    }
  }
  void note(double late_s) {
    double max_s = max_s_;
    while (late_s > max_s && !max_s_.compare_exchange_weak(max_s, late_s)) {
    }
  }

  std::atomic<int> watching_ = 0;
  std::atomic<bool> stop_ = false;
  std::atomic<double> max_s_ = 0;
  std::vector<std::thread> watches_;
};

// As --gtest_filter takes them.
std::string names_of_the_failed() {
  std::string names;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j)
      if (const testing::TestInfo& test = *suite.GetTestInfo(j); test.result()->Failed())
        names += (names.empty() ? "" : ":") + std::string(test.test_suite_name()) + "." + test.name();
  }
  return names;
}

int tries_so_far() {
  const char* const text = std::getenv(kTry);
  return text ? std::max(1, std::atoi(text)) : 1;
}

// Threads that a failed test has left end with the process.
void start_again(std::vector<std::string> arguments, const std::string& only, int next_try) {
  arguments.push_back("--gtest_filter=" + only);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::setenv(kTry, std::to_string(next_try).c_str(), 1);
  std::fflush(nullptr);
  ::execv("/proc/self/exe", pointers.data());
  std::perror("cannot start again");
}

}  // namespace

int run_timed_tests(int argc, char** argv) {
  const std::vector<std::string> arguments(argv, argv + argc);
  testing::InitGoogleTest(&argc, argv);
  Pauses pauses;
  const int failed = RUN_ALL_TESTS();
  const double max_s = pauses.end_s();
  const std::string names = names_of_the_failed();
  if (failed == 0 || names.empty()) return failed;
  const int tries = tries_so_far();
  std::printf("the machine paused for %.1f ms; try %d of %d\n", 1e3 * max_s, tries, kMaxTries);
  if (max_s > kBearable_s && tries < kMaxTries) start_again(arguments, names, tries + 1);
  return failed;
}

}  // namespace remote_touch
