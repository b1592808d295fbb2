// How long jobs that share threads will still take, from what each was expected to take and what was spent so
// far.
#pragma once

#include <cstddef>
#include <vector>

#include "runners/schedule/work_pool.h"

namespace remote_touch {

// The jobs in the order in which they begin: the shortest first, so that there is something to see soon.
// Equal ones keep their order.
std::vector<std::size_t> shortest_first(const std::vector<double>& expected_s);

struct TimeLeft {
  std::vector<double> of_job_s;  // 0 where it is done
  double all_s = 0;
};
// expected_s: what a job takes of one thread, on a machine like that on which it was measured. How this
// machine compares is taken from the jobs that are done.
TimeLeft time_left(const std::vector<double>& expected_s, const std::vector<JobProgress>& progress,
                   int threads);

}  // namespace remote_touch
