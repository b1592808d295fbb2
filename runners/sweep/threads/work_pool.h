// Runs jobs that share the threads of the machine. Each thread does one job after another while there are
// jobs left. A thread that finds none helps with the independent pieces of the jobs that still run.
#pragma once

#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <vector>

#include "runners/sweep/threads/side_by_side.h"

namespace remote_touch {

enum class JobState { waiting, running, done };

struct JobProgress {
  JobState state = JobState::waiting;
  double spent_s = 0;  // summed over all threads
};

class WorkPool {
 public:
  explicit WorkPool(int threads) : threads_(threads) {}

  // Does all jobs, which begin in their order and must not throw. Meanwhile the calling thread calls report
  // every every_s seconds, and once after all have ended.
  void run(const std::vector<std::function<void()>>& jobs, double every_s,
           const std::function<void()>& report);

  // Called inside a job: does its pieces on this thread and on those that are free. See SideBySide.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

  // Returns the progress of all jobs. `report` may call it.
  std::vector<JobProgress> progress() const;

 private:
  struct Pieces {
    const std::function<void(std::size_t)>& work;
    std::size_t count, job;
    std::size_t next = 0, at_work = 0;
    std::vector<std::exception_ptr> failures = {};
  };
  void work();
  void do_job(std::unique_lock<std::mutex>& lock);
  void do_piece(Pieces& pieces, std::unique_lock<std::mutex>& lock);
  Pieces* open_pieces();

  const int threads_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  const std::vector<std::function<void()>>* jobs_ = nullptr;
  std::vector<JobProgress> progress_;
  std::vector<double> began_s_;
  std::size_t next_job_ = 0, ended_jobs_ = 0;
  std::list<Pieces> pieces_;  // pieces of the jobs that run, the oldest first
};

}  // namespace remote_touch
