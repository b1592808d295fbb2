#include "runners/sweep/threads/time_left.h"

#include <algorithm>
#include <numeric>

namespace remote_touch {

namespace {

constexpr double kPrior_s =
    2;  // so much work counts as done in its expected time, so that a first short job decides little
constexpr double kMinShareLeft = 0.05;  // least share of its time that a job has left, even if it is late

// Returns the factor by which jobs take longer here than expected.
double slowness(const std::vector<double>& expected_s, const std::vector<JobProgress>& progress) {
  double expected = kPrior_s, spent = kPrior_s;
  for (std::size_t i = 0; i < progress.size(); ++i)
    if (progress[i].state == JobState::done) expected += expected_s[i], spent += progress[i].spent_s;
  return spent / expected;
}

}  // namespace

std::vector<std::size_t> shortest_first(const std::vector<double>& expected_s) {
  std::vector<std::size_t> order(expected_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return expected_s[a] < expected_s[b]; });
  return order;
}

TimeLeft time_left(const std::vector<double>& expected_s, const std::vector<JobProgress>& progress,
                   int threads) {
  const double slower = slowness(expected_s, progress);
  TimeLeft left{std::vector<double>(progress.size())};
  double running = 0;
  for (const JobProgress& job : progress) running += job.state == JobState::running ? 1 : 0;
  for (std::size_t i = 0; i < progress.size(); ++i) {
    if (progress[i].state == JobState::done) continue;
    const double whole_s = slower * expected_s[i];
    left.of_job_s[i] = std::max(whole_s - progress[i].spent_s, kMinShareLeft * whole_s);
    left.all_s += left.of_job_s[i] / threads;
    // Threads without a job help those that run.
    if (progress[i].state == JobState::running) left.of_job_s[i] *= std::min(1.0, running / threads);
  }
  return left;
}

}  // namespace remote_touch
