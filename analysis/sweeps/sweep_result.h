// The outcome of a parameter sweep: axes, and over them one array for each measure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/columns.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

enum class RunState : std::int32_t {
  not_sampled = 0,  // refinement has not added it
  pending = 1,
  done = 2,
  failed = 3,    // `error` has the reason
  elsewhere = 4  // belongs to another shard, in a result that has an element for it
};

// The axes, cells and runs of a sweep. Cells are the nodes of the axes' grid, numbered with the last axis
// running fastest; every cell has the same number of replicates. A run is one replicate of one cell.
struct SweepGrid {
  std::vector<Column> axes;  // one row for each value; names are an enumeration
  int replicates = 1;
  std::vector<Column> measures;         // name, unit and meaning
  std::vector<std::string> note_kinds;  // names of the kinds of notes, at most 64; empty: notes are not known

  std::size_t cell_count() const;
  std::size_t run_count() const { return cell_count() * static_cast<std::size_t>(replicates); }
  std::size_t run(std::size_t cell, int replicate) const {
    return cell * static_cast<std::size_t>(replicates) + static_cast<std::size_t>(replicate);
  }
  std::size_t cell_of(std::size_t run) const { return run / static_cast<std::size_t>(replicates); }
  int replicate_of(std::size_t run) const {
    return static_cast<int>(run % static_cast<std::size_t>(replicates));
  }
  // Returns the index of a cell on each axis; cell_at() is the inverse.
  std::vector<std::size_t> axis_indices(std::size_t cell) const;
  std::size_t cell_at(const std::vector<std::size_t>& indices) const;
};

// The values of each run: a measure is NaN if the run is not done. The arrays have one element for each run
// that the result holds; its index is the *place* of the run.
struct SweepResult : SweepGrid {
  SweepResult() = default;
  explicit SweepResult(SweepGrid grid) : SweepGrid(std::move(grid)) {}

  // The numbers of the runs that the result holds, increasing. Without them it is whole: it holds every run,
  // and the place of a run is its number.
  std::optional<std::vector<std::uint64_t>> part;
  std::vector<RunState> state;
  std::vector<std::int32_t> round;  // round of refinement that added the run; empty without refinement
  std::vector<std::string> error;
  // One number for each run; bit i is set if the run has a note of the kind note_kinds[i]. It is 0 if the run
  // is not done. Empty without kinds.
  std::vector<std::uint64_t> notes;

  // True if a number of `notes` has bits of the first `kinds` kinds only.
  static bool are_known_notes(std::uint64_t bits, std::size_t kinds) {
    return kinds >= 64 || bits >> kinds == 0;
  }

  // Sizes the arrays and sets every run to not_sampled. pre: the grid and `part` are set.
  void start(bool refined);

  std::size_t held_count() const { return part ? part->size() : run_count(); }
  std::size_t run_at(std::size_t place) const { return part ? (*part)[place] : place; }
  // Returns the place of a run; none if the result does not hold it.
  std::optional<std::size_t> place_of(std::size_t run) const;

  // Returns the places of the runs in that state, increasing.
  std::vector<std::size_t> runs_in(RunState requested) const;
  const std::vector<double>& measure(const std::string& name) const;  // throws std::out_of_range
};

// Returns the grid of the result; its measures have no values.
SweepGrid grid_of(const SweepResult& result);

// True for a measure that is 1 if an event happened in a run, else 0. Its meaning begins with "1 when".
bool is_event(const Column& measure);

// The number of finished runs that have a note of one kind.
struct NoteCount {
  std::string kind;
  std::size_t runs = 0;
  std::size_t first = 0;  // the lowest number of such a run
};
// Returns the counts in the order of note_kinds, without kinds that no finished run has.
std::vector<NoteCount> note_counts(const SweepResult& result);

// Returns the whole result of a part: it has an element for each run, and the runs that the part does not
// hold are `elsewhere`, or not_sampled with refinement. Returns a whole result unchanged.
SweepResult whole_of(SweepResult result);

// Returns the outcomes of an event in the finished runs of a cell. The event happens if the measure is above
// the threshold; it is unknown if the measure is NaN. pre: the result is whole.
EventCounts event_counts(const SweepResult& result, const std::vector<double>& measure, std::size_t cell,
                         double above = 0.5);

// Parts of a sweep's grid, for statements about more than one cell.

// A box of cells: `ranges` has the range of indices [first, second) on each axis.
struct Region {
  std::string label;  // ranges on the split axes: "noise_sigma_m 0 to 0.005, velocity_estimate true"
  std::vector<std::pair<std::size_t, std::size_t>> ranges = {};
  bool contains(const std::vector<std::size_t>& indices) const;
};

// Region 0 is the whole. Then follow the parts, the last axis running fastest: numeric axes of 6 values or
// more are split into three parts of equal length, axes of 2 to 4 values into single values; others are not
// split. Axes are split in their order; one whose split would give more than 36 parts stays whole. No parts
// if no axis is split.
std::vector<Region> regions_of(const std::vector<Column>& axes);

// The cells of a sweep that have the same values on some of its axes.

struct CellGroup {
  std::vector<std::size_t> indices;  // the index on each axis that the group has in common
  std::vector<std::size_t> cells;    // increasing
};

// Returns the groups over the axes with these numbers, the last of them running fastest. Without axes there
// is one group of all cells.
std::vector<CellGroup> cell_groups(const SweepGrid& grid, const std::vector<std::size_t>& axes);

// Returns the axis as a column of a table: its value at the given index in each row.
Column axis_at(const Column& axis, const std::vector<std::size_t>& places);
// Returns one such column for each of the axes: the values that the groups have in common.
std::vector<Column> axes_of(const SweepGrid& grid, const std::vector<std::size_t>& axes,
                            const std::vector<CellGroup>& groups);

// Returns the values of a column of counts: integers or, if one of them is above 2^31 - 1, doubles.
Values counts_in_column(const std::vector<std::int64_t>& counts);

// Runs of a sweep that share random numbers, and runs that draw none.

// The random streams from which the runs of a cell draw. A stream of the cell has the key (seed, cell without
// the axes of common noise, replicate); that of the replicate, as of a registration error, the key (seed,
// replicate).
struct RandomStreams {
  bool of_cell = false, of_replicate = false;

  // The runs of a fixed cell draw no random number: its replicates are equal and count as one run.
  bool is_fixed() const { return !of_cell && !of_replicate; }
};

// The streams of all cells of a sweep.
struct CellStreams {
  std::vector<RandomStreams> draws;     // one for each cell
  std::vector<std::size_t> noise_cell;  // the cell whose stream each cell uses
  std::vector<std::size_t> seed;        // a number for the seed of each cell: equal for equal seeds
  std::string doubt = {};  // why the streams are not known, and what is assumed then; empty: they are known

  bool is_fixed(std::size_t cell) const { return draws[cell].is_fixed(); }
  // True if these cells must be taken together replicate by replicate: one of them draws from the stream of
  // its replicate.
  bool share_replicates(const std::vector<std::size_t>& cells) const;
  // True if no two of these cells that draw share random numbers.
  bool are_independent(const std::vector<std::size_t>& cells) const;
};

// Returns streams in which every cell draws from its own, as without axes of common noise.
CellStreams independent_streams(std::size_t cells);

// The runs of some cells, as clusters: the runs of a cluster share random numbers, and clusters share none. A
// fixed cell has one run here, its first, in a cluster of its own.
struct RunCluster {
  std::vector<std::size_t> runs;  // finished ones
  std::size_t noise_cell = 0;     // the one of its first run; the clusters of a cell are a stratum
  bool is_fixed = false;
};
// Returns the clusters of the finished runs of these cells, in the order of their first runs. by_replicate:
// one cluster for each seed and replicate, as if one of the cells drew from the stream of its replicate.
// pre: the result is whole.
std::vector<RunCluster> clusters_of(const SweepResult& result, const CellStreams& streams,
                                    const std::vector<std::size_t>& cells, bool by_replicate);

// Returns the note on cells whose replicates are equal by construction: "40 equal runs count as one"; empty
// if there is none. done: returns the number of finished runs of a cell.
std::string equal_runs_note(const CellStreams& streams, const std::vector<std::size_t>& cells,
                            const std::function<std::int64_t(std::size_t cell)>& done);

}  // namespace remote_touch
