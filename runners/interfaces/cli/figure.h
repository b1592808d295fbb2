// The command `figure`: makes figures in parallel, writes their folder, and prints what was made.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {

struct FigureRun {
  const FigureEntry* entry;
  int coarse = 1;  // uses every coarse-th value of the axes of its maps

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

// A folder into which figures are written, and the texts that are printed about them.
class FigureFolder {
 public:
  // The runs must outlive it. Throws InputError if a file that it would write is there already and is no
  // result of this program.
  FigureFolder(const CommandLine& line, const std::string& folder, const std::vector<FigureRun>& runs);
  ~FigureFolder();

  // make_figures() calls finish() and report().
  void finish(std::size_t run, const FigureContext& context, Figure figure);
  // Prints the lines of the figures in the order of the figures, whichever was made first.
  void report(const FigureProgress& progress, Progress& shown);

  // Returns kCheckFailed if a claim failed. Otherwise returns kBadInput if no figure was made, and kDone if
  // one was. Also prints on standard error which figures were not made, and why.
  int exit_code() const;

 private:
  std::filesystem::path file_of(const std::string& figure) const {
    return folder_ / ("fig" + figure + ".h5");
  }
  std::filesystem::path progress_file() const { return folder_ / "progress.json"; }
  void write_progress(const FigureProgress& progress);

  const CommandLine& line_;
  std::filesystem::path folder_;
  const std::vector<FigureRun>& runs_;
  ClaimsFile claims_;
  std::vector<std::string> printed_;
  std::size_t next_ = 0;
  bool all_hold_ = true;
  int made_ = 0;
  std::string not_made_;
  std::string written_;
};

}  // namespace remote_touch
