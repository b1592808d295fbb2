// A typical failure of each method in each scene, run again as a full trace.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark_run.h"

namespace remote_touch {

struct FailureTrace {
  std::size_t level = 0;  // lowest noise level with a failure
  int replicate = 0;
  std::string file;     // relative to the scorecard's folder; empty: the run ended with an error, no trace
  std::string command;  // command that makes the trace, to be run in that folder
  std::string error = {};
  std::string page = {};  // page that shows the trace, relative to the folder; empty: not requested
};

// Replays the typical failure, see typical_failure(), at the lowest noise level that has failures, into
// FOLDER/traces/NAME.h5, unless that file is the trace of this run already. If that run ended with an error,
// no trace is made and `error` is set. Returns none if every run succeeded.
std::optional<FailureTrace> trace_failure(const BenchmarkSweep& sweep, const StoredSweep& stored,
                                          const std::vector<Bound>& success,
                                          const std::filesystem::path& folder, const Kernels& kernels,
                                          const std::atomic<bool>* stop);

}  // namespace remote_touch
