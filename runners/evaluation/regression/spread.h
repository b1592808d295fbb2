// Runs one experiment or sweep with every build, on every instruction set and number of threads, and measures
// how far its numbers differ.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/trace.h"
#include "runners/evaluation/regression/stored_result.h"

namespace remote_touch {

// A temporary folder for runs whose results are read and then deleted.

// A new folder in TMPDIR. The destructor removes it with all its files; it must not contain folders. A
// program that is killed, or runs out of memory inside a library, leaves its folder; the next program removes
// it. A lock marks the folders that are in use, and a process loses its lock when it ends. Throws InputError
// if no folder can be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path path() const { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

// Runs this program, or another build of it, as a user would.

std::string this_program();  // the path of the running program

// Runs a program to its end, without output. environment: variables set in addition; errors: a file for its
// stderr. Throws InputError, naming the program, with the last line of its errors, if it cannot be started,
// or its exit code is not 0 or not known. When stop is set, ends it and throws Interrupted.
void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment, const std::filesystem::path& errors,
                 const std::atomic<bool>* stop);

// The columns of a result that are judged: those of a trace except the running hash, or the measures of a
// sweep.
std::vector<Column> judged_columns(const std::filesystem::path& file, const std::string& command);

struct MeasuredSpread {
  std::filesystem::path reference;  // made by the first program at this machine's highest level
  std::set<std::string> compilers = {};
  std::vector<std::string> over = {};  // compilers, levels and threads
  Tolerances spread = {};              // largest deviation from the reference, where it is not 0
};

// Runs the baseline's experiment with every program for all levels of this machine and 1, 2 and 8 threads,
// into the scratch folder. Throws InputError if a program fails or is of another source or configuration than
// the first. Throws InputError also if a state, a hash or the finiteness of a number differs, because these
// have no tolerance. Throws Interrupted when stop is set.
MeasuredSpread measure_spread(const std::filesystem::path& folder, const Baseline& baseline,
                              const std::vector<std::string>& programs, const std::filesystem::path& scratch,
                              const std::atomic<bool>* stop);

// Returns the new values, but with the old bits in every row that is within the tolerance. pre: old and new
// columns of the same result.
std::vector<Column> keep_old_bits(const std::vector<Column>& old, std::vector<Column> now,
                                  const Tolerances& tolerances);

}  // namespace remote_touch
