// A sweep, or a part of one, that keeps a tally of each cell instead of the values of its runs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/tally/cell_tally.h"
#include "analysis/tally/run_ranges.h"
#include "analysis/trace/column.h"

namespace remote_touch {

// Cells and runs are numbered as in SweepResult: the last axis runs fastest, and a run is the cell times the
// replicates plus the replicate. The same runs in any order, and in any parts, give an equal tally.
struct SweepTally {
  std::vector<Column> axes;             // one row for each value
  int replicates = 1;                   // number of runs of every cell
  std::vector<Column> measures;         // name, unit and meaning; no values
  std::vector<std::string> note_kinds;  // names of the kinds, at most 64
  bool keeps_events = false;            // keep = "events": the numbers of the runs in which an event happened
  std::vector<std::uint64_t> cells;     // the cells of which there are runs, increasing
  std::vector<CellTally> tallies;       // one for each of these cells
  RunRanges held;                       // the runs in the tallies, done or failed

  std::uint64_t cell_count() const;  // number of cells of the whole sweep
  std::uint64_t run_count() const { return cell_count() * static_cast<std::uint64_t>(replicates); }
  bool is_whole() const { return held.count() == run_count(); }
  RunRanges missing() const { return held.missing_in({0, run_count()}); }
  // The events are the measures for which is_event() is true, if keeps_events.
  TallyLayout layout() const;

  // Adds one run, see CellTally. Throws std::invalid_argument if the tally has it already, or if there is no
  // such run. layout: what layout() returns.
  void add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                std::uint64_t note_bits);
  void add_failed(const TallyLayout& layout, std::uint64_t run, const std::string& error);

  // Returns why the other tally cannot be added, for example "runs 12 to 15 are in both"; empty if it can.
  std::string obstacle(const SweepTally& other) const;
  // Adds another part of the same sweep. Throws InputError with the obstacle; then nothing is changed.
  void add(SweepTally other);

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the runs of a note exceed the
  // finished runs"; empty if it is consistent.
  std::string contradiction() const;

 private:
  CellTally& tally_for(const TallyLayout& layout, std::uint64_t run);
};

}  // namespace remote_touch
