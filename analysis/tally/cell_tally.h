// The tally of the runs of one cell.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/tally/measure_tally.h"

namespace remote_touch {

// The layout that all tallies of one sweep have.
struct TallyLayout {
  std::size_t measures = 0;    // number of measures
  std::size_t note_kinds = 0;  // number of kinds of notes, at most 64
  std::vector<std::size_t>
      events;  // the measures whose runs are listed, increasing; empty for keep = "tally"
};

// Runs with a note of one kind.
struct NoteTally {
  std::int64_t runs = 0;
  std::uint64_t first = 0;  // lowest number of such a run; without meaning (0) if there is none

  bool operator==(const NoteTally&) const = default;
};

// The same runs, in any order and in any parts that are added to each other, give equal bits. Numbers of runs
// are those of SweepResult: cell times replicates plus replicate. The caller adds no run twice.
struct CellTally {
  CellTally() = default;
  explicit CellTally(const TallyLayout& layout)
      : measures(layout.measures), notes(layout.note_kinds), events(layout.events.size()) {}

  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::uint64_t first_failed = 0;  // lowest number of a failed run; without meaning (0) if none failed
  std::string first_error;         // why that run failed
  std::vector<MeasureTally> measures;
  std::vector<NoteTally> notes;  // one for each kind
  // One list for each of the layout's events: the numbers of the runs in which it is above 0.5, increasing.
  std::vector<std::vector<std::uint64_t>> events;

  std::int64_t runs() const { return done + failed; }
  // Adds a run that was done. values: one for each measure; NaN if unknown. note_bits: bit i is set if the
  // run has a note of kind i. pre: the tally was made for this layout.
  void add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                std::uint64_t note_bits);
  // Adds a run that failed. It counts in no measure and has no notes.
  void add_failed(std::uint64_t run, const std::string& error);
  // pre: both tallies were made for the same layout.
  void add(const CellTally& other);

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the runs of a note exceed the
  // finished runs"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const CellTally&) const = default;
};

}  // namespace remote_touch
