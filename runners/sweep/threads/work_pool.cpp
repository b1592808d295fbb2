#include "runners/sweep/threads/work_pool.h"

#include <omp.h>

#include <chrono>
#include <limits>
#include <thread>

namespace remote_touch {

namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The job that this thread does, or did last.
thread_local std::size_t own_job = std::numeric_limits<std::size_t>::max();

}  // namespace

void WorkPool::run(const std::vector<std::function<void()>>& jobs, double every_s,
                   const std::function<void()>& report) {
  jobs_ = &jobs, next_job_ = ended_jobs_ = 0;
  progress_.assign(jobs.size(), {}), began_s_.assign(jobs.size(), 0);
  std::vector<std::thread> threads;
  for (int i = 0; i < threads_; ++i) threads.emplace_back([this] { work(); });
  const auto all_ended = [&] { return ended_jobs_ == jobs.size(); };
  for (bool ended = false; !ended;) {
    std::unique_lock lock(mutex_);
    // A report does not see jobs that end while it runs. The loop therefore ends after a later report.
    ended = changed_.wait_for(lock, std::chrono::duration<double>(every_s), all_ended);
    lock.unlock();
    report();
  }
  for (std::thread& thread : threads) thread.join();
}

void WorkPool::work() {
  omp_set_num_threads(
      1);  // parallel loops inside a piece of a job would only take turns with those of the other jobs
  std::unique_lock lock(mutex_);
  while (ended_jobs_ < jobs_->size()) {
    if (next_job_ < jobs_->size())
      do_job(lock);
    else if (Pieces* pieces = open_pieces())
      do_piece(*pieces, lock);
    else
      changed_.wait(lock);
  }
}

void WorkPool::do_job(std::unique_lock<std::mutex>& lock) {
  own_job = next_job_++;
  progress_[own_job].state = JobState::running;
  began_s_[own_job] = now_s();
  lock.unlock();
  (*jobs_)[own_job]();
  lock.lock();
  progress_[own_job].spent_s += now_s() - began_s_[own_job];
  progress_[own_job].state = JobState::done;
  ++ended_jobs_;
  changed_.notify_all();
}

WorkPool::Pieces* WorkPool::open_pieces() {
  for (Pieces& pieces : pieces_)
    if (pieces.next < pieces.count) return &pieces;
  return nullptr;
}

void WorkPool::do_piece(Pieces& pieces, std::unique_lock<std::mutex>& lock) {
  const std::size_t i = pieces.next++;
  ++pieces.at_work;
  lock.unlock();
  const double begin_s = now_s();
  std::exception_ptr failure;
  try {
    pieces.work(i);
  } catch (...) {
    failure = std::current_exception();
  }
  const double end_s = now_s();
  lock.lock();
  pieces.failures[i] = failure;
  if (own_job != pieces.job) progress_[pieces.job].spent_s += end_s - begin_s;
  if (--pieces.at_work == 0) changed_.notify_all();
}

void WorkPool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::unique_lock lock(mutex_);
  const auto pieces = pieces_.insert(pieces_.end(), {work, count, own_job});
  pieces->failures.resize(count);
  changed_.notify_all();
  while (pieces->next < count) do_piece(*pieces, lock);
  changed_.wait(lock, [&] { return pieces->at_work == 0; });
  const std::vector<std::exception_ptr> failures = std::move(pieces->failures);
  pieces_.erase(pieces);
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

std::vector<JobProgress> WorkPool::progress() const {
  const std::lock_guard lock(mutex_);
  std::vector<JobProgress> progress = progress_;
  for (std::size_t i = 0; i < progress.size(); ++i)
    if (progress[i].state == JobState::running) progress[i].spent_s += now_s() - began_s_[i];
  return progress;
}

}  // namespace remote_touch
