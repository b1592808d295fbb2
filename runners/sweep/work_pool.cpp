#include "runners/sweep/work_pool.h"

#include <fcntl.h>
#include <omp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <thread>

#include "core/parameters/parameter.h"

namespace remote_touch {

void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::vector<std::exception_ptr> failures(count);
  // An exception must not leave the loop, it would end the program.
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < count; ++i) {
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

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

namespace {

// Runs in the child process, which prints nothing and is ended after some seconds.
[[noreturn]] void start_threads() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGABRT, SIGALRM})
    std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::alarm(20);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO), ::dup2(nowhere, STDERR_FILENO);
  std::atomic<int> started{0};
#pragma omp parallel
  ++started;
  ::_exit(started > 0 ? 0 : 1);
}

bool can_start_threads() {
  const pid_t child = ::fork();
  if (child == 0) start_threads();
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void use_threads(int wanted) {
  if (wanted > 0) omp_set_num_threads(wanted);
  const int threads = omp_get_max_threads();
  const std::string subject = (wanted > 0 ? "--threads = " : "OMP_NUM_THREADS = ") + std::to_string(threads);
  if (threads > kMaxThreads) throw InputError(subject, "expected 1 to " + std::to_string(kMaxThreads));
  if (threads > 1 && !can_start_threads())
    throw InputError(
        subject,
        "this number of threads cannot be started: expected fewer, or higher limits of processes "
        "and memory");
}

}  // namespace remote_touch
