// Makes figures in parallel, with progress.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runners/evaluation/figures/figures.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/sweep/threads/work_pool.h"

namespace remote_touch {

struct FigureRun {
  const FigureEntry* entry;
  int coarse = 1;                           // uses every coarse-th value of the axes of its maps
  std::vector<std::string> overrides = {};  // settings, for a figure that takes a recording

  double expected_s() const {
    return entry->has_map ? entry->expected_s / (coarse * coarse) : entry->expected_s;
  }
};

// The progress of each run.
struct FigureProgress {
  std::vector<JobProgress> runs;
  TimeLeft left;
};

// Returns the runs in the order in which they begin: the quickest first.
std::vector<FigureRun> quickest_first(const std::vector<FigureRun>& runs);

// make: makes the figure of one run. finish: receives the figure of a run on the thread that made it, one at
// a time, in any order. report: called twice a second by the calling thread, and once at the end. All three
// may throw. If a figure fails, the others are still made. Then the exception of the first run that failed is
// thrown, in the order of the runs.
void make_figures(
    const CommandLine& line, const std::vector<FigureRun>& runs,
    const std::function<Figure(const FigureEntry& entry, FigureContext& context)>& make,
    const std::function<void(std::size_t run, const FigureContext& context, Figure figure)>& finish,
    const std::function<void(const FigureProgress& progress)>& report);

// Returns the progress as text: "12 of 23, making 4.13, bounds; about 85 s left".
std::string progress_text(const std::vector<FigureRun>& runs, const FigureProgress& progress);

}  // namespace remote_touch
