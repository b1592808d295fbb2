// A typical failure of each method in each scene, run again as a full trace.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "core/kernels/kernels.h"
#include "runners/scorecard/benchmark_run.h"

namespace remote_touch {

struct FailureTrace {
  std::size_t level = 0;  // of noise: the lowest with a failure
  int replicate = 0;
  std::string file;     // from the scorecard's folder; empty: the run ended with an error and has no trace
  std::string command;  // to be given in that folder
  std::string error = {};
};

// Of the failures at the lowest noise level that has some, the one in the middle, replayed into
// FOLDER/traces/NAME.h5 unless it is there. An error where that is what is typical. None where every run
// succeeded.
std::optional<FailureTrace> trace_failure(const BenchmarkSweep& sweep, const StoredSweep& stored,
                                          const std::vector<Bound>& success,
                                          const std::filesystem::path& folder, const Kernels& kernels,
                                          const std::atomic<bool>* stop);

}  // namespace remote_touch
