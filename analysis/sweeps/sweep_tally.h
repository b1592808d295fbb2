// A sweep, or a part of one, that keeps a tally of each cell instead of the values of its runs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/sweeps/cell_tally.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// A set of runs, as ranges of their numbers.

struct RunRange {
  std::uint64_t first = 0, end = 0;  // first .. end - 1

  bool operator==(const RunRange&) const = default;
};

class RunRanges {
 public:
  // Adds the runs first .. end - 1. pre: the set has none of them.
  void add(RunRange range);
  // pre: the sets have no run in common.
  void add(const RunRanges& other);

  // Increasing; between two ranges is at least one run that the set does not have.
  const std::vector<RunRange>& ranges() const { return ranges_; }
  std::uint64_t count() const;  // number of runs
  // Number of runs in this range.
  std::uint64_t count_in(RunRange range) const;
  // Returns the first range of runs in both sets; an empty one if there is none.
  RunRange first_common(const RunRanges& other) const;
  // Returns the runs of first .. end - 1 that the set does not have.
  RunRanges missing_in(RunRange range) const;

  bool operator==(const RunRanges&) const = default;

 private:
  std::vector<RunRange> ranges_;
};

// The same runs in any order, and in any parts, give an equal tally. The measures of the grid have no values.
struct SweepTally : SweepGrid {
  SweepTally() = default;
  SweepTally(SweepGrid grid, bool with_events) : SweepGrid(std::move(grid)), keeps_events(with_events) {}

  bool keeps_events = false;         // keep = "events": the numbers of the runs in which an event happened
  std::vector<std::uint64_t> cells;  // the cells of which there are runs, increasing
  std::vector<CellTally> tallies;    // one for each of these cells
  RunRanges held;                    // the runs in the tallies, done or failed

  bool is_whole() const { return held.count() == run_count(); }
  RunRanges missing() const { return held.missing_in({0, run_count()}); }
  CellTally over_all_cells() const;                     // the sum of the tallies
  const CellTally* tally_of(std::uint64_t cell) const;  // null if there is no run of the cell
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

// Returns the outcomes of an event in the finished runs of a cell. pre: the measure of that number is an
// event (is_event()).
EventCounts event_counts(const SweepTally& tally, std::size_t measure, std::uint64_t cell);

// Returns the number of finished runs of a cell with a note. If there are several kinds of notes, it is that
// of the most frequent kind: a tally does not know how many runs have two kinds.
std::int64_t noted_runs(const SweepTally& tally, std::uint64_t cell);

}  // namespace remote_touch
