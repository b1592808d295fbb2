// Jobs that share threads, the time that is left, and threads that cannot be started.
#include "runners/sweep/work_pool.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <latch>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/support/test_files.h"

namespace remote_touch::work_pool_test {
namespace {

using Jobs = std::vector<std::function<void()>>;

void nothing() {}

TEST(WorkPool, OneThreadDoesTheJobsInTheirOrder) {
  std::string done;
  Jobs jobs;
  for (const char name : {'a', 'b', 'c'}) jobs.emplace_back([&done, name] { done += name; });
  WorkPool(1).run(jobs, 1, nothing);
  EXPECT_EQ(done, "abc");
}

TEST(WorkPool, JobsRunSideBySide) {
  std::latch both(2);  // neither job ends before the other has begun
  const auto job = [&] { both.arrive_and_wait(); };
  WorkPool(2).run({job, job}, 1, nothing);
}

TEST(WorkPool, AThreadWithoutAJobHelpsWithThePiecesOfAnother) {
  WorkPool pool(2);
  std::latch both(2);
  pool.run({[&] { pool.for_each(2, [&](std::size_t) { both.arrive_and_wait(); }); }}, 1, nothing);
}

TEST(WorkPool, EachPieceIsDoneOnce) {
  constexpr std::size_t kPieces = 1000;
  WorkPool pool(3);
  std::vector<std::atomic<int>> count(2 * kPieces);
  const auto job = [&](std::size_t from) {
    pool.for_each(kPieces, [&count, from](std::size_t i) { ++count[from + i]; });
  };
  pool.run({[&] { job(0); }, [&] { job(kPieces); }}, 1, nothing);
  for (const std::atomic<int>& each : count) EXPECT_EQ(each, 1);
}

TEST(WorkPool, TheFirstFailureInTheOrderOfThePiecesIsThrownAfterAllHaveEnded) {
  WorkPool pool(2);
  std::atomic<int> ended{0};
  std::string thrown;
  const auto piece = [&](std::size_t i) {
    ++ended;
    if (i == 3 || i == 7) throw std::runtime_error(std::to_string(i));
  };
  pool.run({[&] {
             try {
               pool.for_each(10, piece);
             } catch (const std::runtime_error& error) {
               thrown = error.what();
             }
           }},
           1, nothing);
  EXPECT_EQ(thrown, "3");
  EXPECT_EQ(ended, 10);
}

TEST(WorkPool, ReportSeesTheStatesOfTheJobs) {
  WorkPool pool(1);
  std::atomic<bool> was_seen{false};
  std::vector<JobProgress> during, after;
  const auto report = [&] {
    after = pool.progress();
    if (after[0].state != JobState::running) return;
    during = after;
    was_seen = true;
  };
  const auto until_seen = [&] {
    while (!was_seen) std::this_thread::yield();
  };
  pool.run({until_seen, nothing}, 0.001, report);
  ASSERT_EQ(during.size(), 2u);
  EXPECT_EQ(during[1].state, JobState::waiting);
  EXPECT_EQ(during[1].spent_s, 0);
  EXPECT_GT(during[0].spent_s, 0);
  for (const JobProgress& job : after) EXPECT_EQ(job.state, JobState::done);
  EXPECT_GE(after[0].spent_s, during[0].spent_s);
}

// The only job ends while the first report is still running, which has read its state before.
TEST(WorkPool, TheLastReportSeesThatAllHaveEnded) {
  WorkPool pool(1);
  std::atomic<bool> was_looked_at{false};
  JobState seen = JobState::waiting;
  const auto report = [&] {
    seen = pool.progress()[0].state;
    was_looked_at = true;
    while (pool.progress()[0].state != JobState::done) std::this_thread::yield();
  };
  const auto until_looked_at = [&] {
    while (!was_looked_at) std::this_thread::yield();
  };
  pool.run({until_looked_at}, 0.001, report);
  EXPECT_EQ(seen, JobState::done);
}

struct LeftCase {
  std::vector<double> expected_s;
  std::vector<JobProgress> jobs;
  int threads;
  TimeLeft left;
};

TEST(TimeLeft, IsThatOfTheJobsThatAreLeft) {
  constexpr JobState kWaiting = JobState::waiting, kRunning = JobState::running, kDone = JobState::done;
  const LeftCase cases[] = {
      {{10, 30}, {{kWaiting, 0}, {kWaiting, 0}}, 2, {{10, 30}, 20}},  // the expected lines
      // The speed of the machine: the prior counts 2 s, and a job of 8 s took 18 s, so 20 s for 10 s.
      {{8, 30}, {{kDone, 18}, {kWaiting, 0}}, 1, {{0, 60}, 60}},
      {{10}, {{kRunning, 4}}, 1, {{6}, 6}},
      {{10}, {{kRunning, 40}}, 1, {{0.5}, 0.5}},  // a running job counts for a twentieth at least
      {{10}, {{kRunning, 2}}, 4, {{2}, 2}},       // threads without a job help the one that runs
      {{10, 1}, {{kDone, 1}, {kDone, 1}}, 2, {{0, 0}, 0}}};
  for (const LeftCase& each : cases) {
    const TimeLeft left = time_left(each.expected_s, each.jobs, each.threads);
    EXPECT_DOUBLE_EQ(left.all_s, each.left.all_s);
    ASSERT_EQ(left.of_job_s.size(), each.jobs.size());
    for (std::size_t i = 0; i < each.jobs.size(); ++i)
      EXPECT_DOUBLE_EQ(left.of_job_s[i], each.left.of_job_s[i]);
  }
  EXPECT_EQ(shortest_first({3, 1, 2, 1}), (std::vector<std::size_t>{1, 3, 2, 0}))
      << "equal ones keep their order";
}

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

TEST(UseThreads, RefusesThoseThatCannotBeStarted) {
  EXPECT_EQ(outcome_of(kMaxThreads + 1).problem, "--threads = 4097: expected 1 to 4096");
  const LittleMemory limit;
  EXPECT_HAS(outcome_of(256).problem,
             "--threads = 256: this number of threads cannot be started: expected fewer");
}

}  // namespace
}  // namespace remote_touch::work_pool_test
