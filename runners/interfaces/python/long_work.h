// Work that takes a while, called from Python: without the interpreter's lock, and stopped by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>

#include "core/kernels/kernels.h"

namespace remote_touch {

// The inputs of the work.
struct LongWork {
  const Kernels& kernels;
  const std::atomic<bool>& stop;         // set by Ctrl-C: the work ends with Interrupted
  std::function<void(double)> progress;  // receives the fraction that is done; any thread may call it
};

// Does the work in a thread of its own, with this number of OpenMP threads (0: OpenMP decides). Meanwhile
// this thread waits without the lock and checks for signals. report: None, or a callable that receives the
// fraction about 20 times a second. Throws the exception of the work, or error_already_set if a signal or the
// report raised an exception.
void do_long_work(const pybind11::object& report, int threads,
                  const std::function<void(const LongWork&)>& work);

// Keeps the catalog as it is while it exists: a class that is registered again would belong to some runs of a
// sweep only. A process that is forked meanwhile may change its own catalog.
class UnchangedCatalog {
 public:
  UnchangedCatalog();
  ~UnchangedCatalog();
  UnchangedCatalog(const UnchangedCatalog&) = delete;
  UnchangedCatalog& operator=(const UnchangedCatalog&) = delete;
};

// Throws InputError while long work is running or the catalog is kept as it is.
void require_no_long_work(const char* subject);

// Chooses the kernels that all calls use: those of the forced x86-64 level, or of the fastest one if `forced`
// is empty. Throws InputError if the machine does not have that level.
void choose_python_kernels(const std::string& forced);
const Kernels& chosen_python_kernels();

// The HDF5 library is not made for several threads: one call reads or writes at a time, and none while a
// sweep or a scorecard is written. Throws InputError instead of waiting for the end of a sweep, or of another
// turn of the same thread, because the caller may be a class in Python that this sweep or turn calls.
class FileTurn {
 public:
  enum class For { a_moment, a_sweep };
  explicit FileTurn(For duration = For::a_moment);
  ~FileTurn();
  FileTurn(const FileTurn&) = delete;
  FileTurn& operator=(const FileTurn&) = delete;

 private:
  const For duration_;
};

}  // namespace remote_touch
