// The texts that the commands about sweeps print.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

std::string extent_text(const SweepGrid& grid);  // "76 x 71"

// Prints the cells, the runs, the mean and range of each measure, and the number of runs with each kind of
// note. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepResult& result);

// Prints the cells, the runs, the mean and range of each measure over all runs, the number of runs with each
// kind of note, and the first failed run of each cell. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepTally& tally);

// Prints a note on the cells whose replicates are equal, because they draw no random numbers. grid: of the
// sweep with this configuration (JSON). Prints nothing if each cell has one run, and for more than 1e6 cells.
void print_equal_runs(const SweepGrid& grid, const std::string& config);

// Returns, for example, "mean 0.25 0 .. 1 1, median 0, of 4 of 5 runs": mean, range, unit, median, and how
// many runs have a finite value.
std::string measure_text(const MeasureTally& all, const std::string& units);

// The summary of a sweep whose runs come in blocks; prints what print_summary() prints.
class SweepSummary {
 public:
  explicit SweepSummary(SweepGrid grid) : grid_(std::move(grid)), ranges_(grid_.measures.size()) {}
  // block: a part of the sweep, or all of it. The blocks come in increasing order of their runs.
  void add(const SweepResult& block);
  int print(const std::string& file, const std::string& digest) const;

 private:
  // The finite values of a measure.
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    std::size_t count = 0;
  };
  std::string text_of(const Range& range, const std::string& units) const;
  void add_notes(const std::vector<NoteCount>& counts);
  SweepGrid grid_;
  std::size_t held_ = 0, done_ = 0, failed_ = 0, elsewhere_ = 0;
  int rounds_ = 0;                     // 0 without refinement
  std::vector<Range> ranges_;          // one for each measure
  std::vector<std::string> failures_;  // the first of them
  std::vector<NoteCount> notes_;
};

}  // namespace remote_touch
