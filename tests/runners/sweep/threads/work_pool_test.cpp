#include "runners/sweep/threads/work_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <stdexcept>
#include <string>
#include <thread>

namespace remote_touch {
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

}  // namespace
}  // namespace remote_touch
