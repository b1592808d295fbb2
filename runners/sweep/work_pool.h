// Work on several threads: jobs that share them, the time that is left, and whether there are enough threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <vector>

namespace remote_touch {

// Independent pieces of work on several threads.

// Calls work(0) ... work(count - 1), each once, on any thread and in any order, and returns after all have
// ended. If some threw, it then throws the exception of the one with the lowest number.
using SideBySide = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

// Uses as many threads as OpenMP does.
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work);

// Runs jobs that share the threads of the machine. Each thread does one job after another while there are
// jobs left. A thread that finds none helps with the independent pieces of the jobs that still run.

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

// Estimates the time left for jobs that share threads, from their expected times and the time spent so far.

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

// Checks that the system can start the threads of OpenMP. If it cannot, the library would end the program.

inline constexpr int kMaxThreads = 4096;

// Sets the number of OpenMP's threads; 0: the number that OpenMP chooses, from OMP_NUM_THREADS or the
// processors. A child process starts the threads first, as a test. Throws InputError if there are more than
// kMaxThreads, or if the system refuses them. pre: OpenMP has not been used yet.
void use_threads(int wanted);

}  // namespace remote_touch
