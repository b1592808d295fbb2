#include "runners/cli/scorecard_runs.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/cli/progress.h"
#include "runners/provenance/provenance.h"
#include "runners/simulation/note_kinds.h"
#include "runners/sweep/sweep_notes.h"
#include "runners/view/trace_page.h"

namespace remote_touch {

namespace {

constexpr std::size_t kPageOfFailure = 3'000'000;  // bytes: there may be hundreds

}  // namespace

void do_scorecard_runs(const CommandLine& line, const std::vector<BenchmarkSweep>& sweeps) {
  Progress progress("scorecard", line.quiet);
  do_sweeps(sweeps, *line.kernels, line.stop, [&](std::size_t done, std::size_t all, double fraction) {
    progress.update((static_cast<double>(done) + fraction) / static_cast<double>(all));
  });
}

void make_failure_pages(const CommandLine& line, const std::string& folder, ScorecardReport& report) {
  std::vector<FailureTrace*> failures;
  for (auto& of_scene : report.failures)
    for (auto& one : of_scene)
      if (one && !one->file.empty()) failures.push_back(&*one);
  Progress progress("pages", line.quiet);
  ViewOptions options;
  options.max_bytes = kPageOfFailure;
  options.kernels = line.kernels, options.stop = line.stop;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    std::filesystem::path page = failures[i]->file;
    page.replace_extension(".html");
    const std::string html = trace_page({folder / std::filesystem::path(failures[i]->file)}, options).html;
    write_file_atomically(folder / page, html.data(), html.size());
    failures[i]->page = page.string();
    progress.update(i + 1, failures.size(), 0, "pages");
  }
}

void report_notes(const std::vector<BenchmarkSweep>& sweeps) {
  struct OfKind {
    std::string name, first;
    std::size_t runs;
  };
  std::vector<OfKind> kinds;
  std::size_t done = 0;
  for (const BenchmarkSweep& sweep : sweeps) {
    const SweepResult result = read_sweep(sweep.file).result;
    done += result.runs_in(RunState::done).size();
    for (const NoteCount& count : note_counts(result)) {
      const auto found = std::find_if(kinds.begin(), kinds.end(),
                                      [&](const OfKind& kind) { return kind.name == count.kind; });
      if (found != kinds.end())
        found->runs += count.runs;
      else
        kinds.push_back(
            {count.kind, sweep.file.string() + " " + option_of_run(result, count.first), count.runs});
    }
  }
  for (const OfKind& kind : kinds)
    std::printf("note: %zu of %zu runs: %s (the first: replay %s)\n", kind.runs, done,
                text_of_kind(kind.name).c_str(), printable(kind.first).c_str());
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
  std::fprintf(stderr, "%s: interrupted; finished runs are kept in %s, and the same command continues\n",
               program_identity().name.c_str(), folder.c_str());
  return kInterrupted;
}

}  // namespace remote_touch
