#include "runners/cli/scorecard_runs.h"

#include <cstdio>
#include <filesystem>

#include "core/parameters/input_error.h"
#include "runners/cli/progress.h"

namespace remote_touch {

void make_scorecard_folder(const std::string& folder) {
  for (const char* part : {"runs", "traces"}) {
    const std::filesystem::path path = std::filesystem::path(folder) / part;
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure)
      throw InputError(path.string(),
                       "cannot be made (" + failure.message() + "): expected a writable folder");
  }
}

void do_scorecard_runs(const CommandLine& line, const std::vector<BenchmarkSweep>& sweeps) {
  Progress progress("scorecard", line.quiet);
  do_sweeps(sweeps, *line.kernels, line.stop, [&](std::size_t done, std::size_t all, double fraction) {
    progress.update((static_cast<double>(done) + fraction) / static_cast<double>(all));
  });
}

int report_failed_runs(const std::vector<BenchmarkSweep>& sweeps) {
  std::size_t failed = 0;
  std::string first;
  for (const BenchmarkSweep& sweep : sweeps) {
    const StoredSweep stored = read_sweep(sweep.file);
    const auto runs = stored.result.runs_in(RunState::failed);
    if (!runs.empty() && first.empty()) first = sweep.name + ": " + stored.result.error[runs.front()];
    failed += runs.size();
  }
  if (failed == 0) return kDone;
  std::printf("%zu runs failed; the first: %s\n", failed, first.c_str());
  return kCheckFailed;
}

int report_interrupted(const std::string& folder) {
  std::fprintf(stderr,
               "remote-touch: interrupted; finished runs are kept in %s, and the same command goes on\n",
               folder.c_str());
  return kInterrupted;
}

}  // namespace remote_touch
