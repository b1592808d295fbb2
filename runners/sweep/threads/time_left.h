// Estimates the time left for jobs that share threads, from their expected times and the time spent so far.
#pragma once

#include <cstddef>
#include <vector>

#include "runners/sweep/threads/work_pool.h"

namespace remote_touch {

// Returns the order in which the jobs begin, as indices: the shortest first, so that first results appear
// soon. Jobs of equal length keep their order.
std::vector<std::size_t> shortest_first(const std::vector<double>& expected_s);

struct TimeLeft {
  std::vector<double> of_job_s;  // 0 if it is done
  double all_s = 0;
};
// expected_s: time of a job on one thread of the machine where it was measured. The ratio to this machine's
// speed is estimated from the jobs that are done.
TimeLeft time_left(const std::vector<double>& expected_s, const std::vector<JobProgress>& progress,
                   int threads);

}  // namespace remote_touch
