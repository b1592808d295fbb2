// Runs one experiment or sweep with every build, on every instruction set and number of threads, and measures
// how far its numbers differ.
#pragma once

#include <atomic>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/column.h"
#include "runners/evaluation/regression/manifest.h"

namespace remote_touch {

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
