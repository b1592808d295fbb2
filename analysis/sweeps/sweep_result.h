// The outcome of a parameter sweep: axes, and over them one array for each measure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/interval_estimates.h"
#include "analysis/trace/column.h"

namespace remote_touch {

enum class RunState : std::int32_t {
  not_sampled = 0,  // refinement has not added it
  pending = 1,
  done = 2,
  failed = 3,    // `error` has the reason
  elsewhere = 4  // belongs to another shard, in a result that has an element for it
};

// Cells are the nodes of the axes' grid, numbered with the last axis running fastest; every cell has the same
// number of replicates. A run is one replicate of one cell. The arrays have one element for each run that the
// result holds; its index is the *place* of the run.
struct SweepResult {
  std::vector<Column> axes;  // one row for each value; names are an enumeration
  int replicates = 1;
  // The numbers of the runs that the result holds, increasing. Without them it is whole: it holds every run,
  // and the place of a run is its number.
  std::optional<std::vector<std::uint64_t>> part;
  std::vector<Column> measures;  // NaN if the run is not done
  std::vector<RunState> state;
  std::vector<std::int32_t> round;  // round of refinement that added the run; empty without refinement
  std::vector<std::string> error;
  // note_kinds: the names of the kinds of notes. notes: one number for each run; bit i is set if the run has
  // a note of the kind note_kinds[i]. It is 0 if the run is not done. Both are empty in results that were
  // stored without notes.
  std::vector<std::string> note_kinds;
  std::vector<std::uint64_t> notes;

  // True if a number of `notes` has bits of the first `kinds` kinds only.
  static bool are_known_notes(std::uint64_t bits, std::size_t kinds) {
    return kinds >= 64 || bits >> kinds == 0;
  }

  // Sizes the arrays and sets every run to not_sampled. pre: axes, replicates, part, measures and note_kinds
  // are set.
  void start(bool refined);

  std::size_t cell_count() const;
  std::size_t run_count() const { return cell_count() * static_cast<std::size_t>(replicates); }
  std::size_t held_count() const { return part ? part->size() : run_count(); }
  std::size_t run_at(std::size_t place) const { return part ? (*part)[place] : place; }
  // Returns the place of a run; none if the result does not hold it.
  std::optional<std::size_t> place_of(std::size_t run) const;
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

  // Returns the places of the runs in that state, increasing.
  std::vector<std::size_t> runs_in(RunState requested) const;
  const std::vector<double>& measure(const std::string& name) const;  // throws std::out_of_range
};

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
// Returns a result without its runs that are `elsewhere`, as a part. Returns a result without such runs
// unchanged.
SweepResult without_others(SweepResult result);

// Returns the outcomes of an event in the finished runs of a cell. The event happens if the measure is above
// the threshold; it is unknown if the measure is NaN. pre: the result is whole.
EventCounts event_counts(const SweepResult& result, const std::vector<double>& measure, std::size_t cell,
                         double above = 0.5);

}  // namespace remote_touch
