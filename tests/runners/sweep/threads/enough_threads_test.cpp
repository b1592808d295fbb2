#include "runners/sweep/threads/enough_threads.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "tests/support/test_files.h"

namespace remote_touch::enough_threads_test {
namespace {

// Result of use_threads() in a thread where OpenMP has not run yet: the number of threads there afterwards,
// and the refusal, empty if none.
struct Outcome {
  int threads = 0;
  std::string problem;
};
Outcome outcome_of(int wanted) {
  Outcome outcome;
  std::thread([&] {
    try {
      use_threads(wanted);
    } catch (const InputError& error) {
      outcome.problem = error.what();
    }
    outcome.threads = omp_get_max_threads();
  }).join();
  return outcome;
}

// Limits this process to little more memory than it has, as long as the object lives.
class LittleMemory {
 public:
  LittleMemory() {
    EXPECT_EQ(::getrlimit(RLIMIT_AS, &before_), 0);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit now = before_;
    now.rlim_cur = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (64u << 20);
    EXPECT_EQ(::setrlimit(RLIMIT_AS, &now), 0);
  }
  ~LittleMemory() { ::setrlimit(RLIMIT_AS, &before_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};

TEST(UseThreads, AcceptsTheThreadsThatTheSystemGives) {
  const Outcome three = outcome_of(3);
  EXPECT_EQ(three.problem, "");
  EXPECT_EQ(three.threads, 3);
  EXPECT_EQ(outcome_of(0).problem, "");
}

TEST(UseThreads, RefusesMoreThanThereCanBe) {
  EXPECT_EQ(outcome_of(kMaxThreads + 1).problem, "--threads = 4097: expected 1 to 4096");
}

TEST(UseThreads, RefusesThoseThatCannotBeStarted) {
  const LittleMemory limit;
  EXPECT_HAS(outcome_of(256).problem,
             "--threads = 256: this number of threads cannot be started: expected fewer");
}

}  // namespace
}  // namespace remote_touch::enough_threads_test
