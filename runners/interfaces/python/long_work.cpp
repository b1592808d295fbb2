#include "runners/interfaces/python/long_work.h"

#include <omp.h>
#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

constexpr std::chrono::milliseconds kSignalCheckPeriod{50};  // time between two checks for signals

// A forked process has none of the threads that work.
std::atomic<int> works_in_progress{0};
[[maybe_unused]] const int kIsForgotten = ::pthread_atfork(nullptr, nullptr, [] { works_in_progress = 0; });

const Kernels*& kernels_in_use() {
  static const Kernels* kernels = supported_kernels().back();
  return kernels;
}

// The end of the work, for the thread that waits for it.
class Ending {
 public:
  void tell(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(failure), has_ended_ = true;
    changed_.notify_all();
  }
  bool has_come_within(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [this] { return has_ended_; });
  }
  std::exception_ptr failure() const { return failure_; }  // pre: it has come

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
};

// The thread keeps one state of the interpreter, so that calls of Python classes need not make one each.
void work_in_thread(int threads, const std::function<void()>& work, Ending& ending) {
  std::exception_ptr failure;
  {
    const py::gil_scoped_acquire known_to_the_interpreter;
    const py::gil_scoped_release without_lock;
    try {
      if (threads > 0) omp_set_num_threads(threads);
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  ending.tell(std::move(failure));
}

// Returns null, or the exception that a signal's handler or the report has raised.
std::shared_ptr<py::error_already_set> check_signals(const py::object& report, double fraction) {
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!report.is_none()) report(fraction);
  } catch (py::error_already_set& error) {
    return std::make_shared<py::error_already_set>(error);
  }
  return nullptr;
}

std::shared_ptr<py::error_already_set> wait(Ending& ending, const py::object& report,
                                            const std::atomic<double>& fraction, std::atomic<bool>& stop) {
  std::shared_ptr<py::error_already_set> raised;
  while (!ending.has_come_within(kSignalCheckPeriod)) {
    if (raised) continue;
    const py::gil_scoped_acquire lock;
    raised = check_signals(report, fraction);
    if (raised) stop = true;
  }
  return raised;
}

std::mutex file_mutex;
bool sweep_is_written = false;  // guarded by file_mutex
thread_local bool has_turn = false;

void require_no_sweep() {
  if (sweep_is_written)
    throw InputError("a file",
                     "a sweep is being written by this process: expected the call before or after it");
}

}  // namespace

UnchangedCatalog::UnchangedCatalog() {
  ++works_in_progress;
}

UnchangedCatalog::~UnchangedCatalog() {
  --works_in_progress;
}

void do_long_work(const py::object& report, int threads, const std::function<void(const LongWork&)>& work) {
  std::atomic<bool> stop{false};
  std::atomic<double> fraction{0};
  Ending ending;
  const LongWork given{chosen_python_kernels(), stop, [&](double done) { fraction = done; }};
  std::shared_ptr<py::error_already_set> raised;
  {
    const UnchangedCatalog unchanged;
    const py::gil_scoped_release without_lock;
    try {
      const auto given_work = [&] { work(given); };
      const std::jthread thread([&] { work_in_thread(threads, given_work, ending); });
      raised = wait(ending, report, fraction, stop);
    } catch (...) {  // the thread could not be started
      ending.tell(std::current_exception());
    }
  }
  if (raised) throw py::error_already_set(*raised);
  if (ending.failure()) std::rethrow_exception(ending.failure());
  if (!report.is_none()) report(1.0);
}

void require_no_long_work(const char* subject) {
  if (works_in_progress > 0)
    throw InputError(subject, "a run or a sweep is in progress: expected the call before or after it");
}

void choose_python_kernels(const std::string& forced) {
  kernels_in_use() = &kernels_of_level(forced);
}

const Kernels& chosen_python_kernels() {
  return *kernels_in_use();
}

FileTurn::FileTurn(For duration) : duration_(duration) {
  if (has_turn)
    throw InputError("a file",
                     "this thread reads or writes another one: expected the call before or after it");
  std::unique_lock lock(file_mutex);
  require_no_sweep();
  if (duration == For::a_sweep) {
    sweep_is_written = true;
  } else {
    lock.release();  // locked until the destructor
    has_turn = true;
  }
}

FileTurn::~FileTurn() {
  if (duration_ == For::a_moment) {
    has_turn = false;
    file_mutex.unlock();
    return;
  }
  const std::lock_guard lock(file_mutex);
  sweep_is_written = false;
}

}  // namespace remote_touch
