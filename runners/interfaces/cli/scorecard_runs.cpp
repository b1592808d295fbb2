#include "runners/interfaces/cli/scorecard_runs.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/interfaces/cli/progress.h"
#include "runners/presentation/view/trace_page.h"
#include "runners/sweep/sweep_notes.h"

namespace remote_touch {

namespace {

constexpr std::size_t kPageOfFailure = 3'000'000;  // bytes of one page; there may be hundreds of pages

struct NoteOfRuns {
  std::string kind, first;  // first: a run that has it, as arguments of `replay`
  std::size_t runs;
};

void add_notes(const SweepResult& result, const std::string& file, std::vector<NoteOfRuns>& notes) {
  for (const NoteCount& count : note_counts(result)) {
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [&](const NoteOfRuns& note) { return note.kind == count.kind; });
    if (found != notes.end())
      found->runs += count.runs;
    else
      notes.push_back({count.kind, file + " " + option_of_run(result, count.first), count.runs});
  }
}

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

int report_runs(const std::vector<BenchmarkSweep>& sweeps) {
  std::vector<NoteOfRuns> notes;
  std::size_t done = 0, failed = 0;
  std::string first_error;
  for (const BenchmarkSweep& sweep : sweeps) {
    const SweepResult result = read_sweep(sweep.file).result;
    done += result.runs_in(RunState::done).size();
    add_notes(result, sweep.file.string(), notes);
    const auto runs = result.runs_in(RunState::failed);
    if (!runs.empty() && first_error.empty()) first_error = sweep.name + ": " + result.error[runs.front()];
    failed += runs.size();
  }
  for (const NoteOfRuns& note : notes)
    std::printf("note: %zu of %zu runs: %s (the first: replay %s)\n", note.runs, done,
                text_of_kind(note.kind).c_str(), printable(note.first).c_str());
  if (failed == 0) return kDone;
  std::printf("%zu runs failed; the first: %s\n", failed, first_error.c_str());
  return kCheckFailed;
}

int report_interrupted(const std::string& folder) {
  std::fprintf(stderr, "%s: interrupted; finished runs are kept in %s, and the same command continues\n",
               program_identity().name.c_str(), folder.c_str());
  return kInterrupted;
}

}  // namespace remote_touch
