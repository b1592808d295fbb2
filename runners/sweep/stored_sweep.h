// Sweeps in files, and what a user reads of them: their cells and the notes on their runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/measures.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

struct Trace;

// Cells of a sweep as the user writes them.

// Returns the index on each axis, from 0: "3,4".
std::string cell_text(const SweepGrid& grid, std::size_t cell);

// text: the indices as cell_text() writes them, or a value of each axis, "noise_sigma_m=0.003,rule=none". A
// number names the value that is equal to it or, if there is none, the only value of the axis that has the
// same text with six digits.
struct NamedCell {
  std::string option;  // option with which the user named it, for errors: "--cell"
  std::string text;
};

// Throws InputError.
std::size_t cell_of(const NamedCell& cell, const SweepGrid& grid);

// The options of `replay` for a run: "--cell 0,3", and "--replicate 2" if there are several replicates.
std::string option_of_run(const SweepGrid& grid, std::size_t run);

// The notes on the runs of a sweep, as counts by kind.

// Returns a line for each kind of note that a finished run has:
//   "12 of 210 runs: no contact: no point was touched and no force was felt (the first: --cell 0,3)"
// Empty for a result that was stored without notes.
std::vector<std::string> note_lines(const SweepResult& result);
// The same for counts over several results of one sweep, of which `done` runs are finished.
std::vector<std::string> note_lines(const SweepGrid& grid, const std::vector<NoteCount>& counts,
                                    std::size_t done);

// The same for a tally.
std::vector<std::string> note_lines(const SweepTally& tally);

// Throws InputError with all these lines, for --strict. Does nothing if there is none.
void refuse_notes(const std::vector<std::string>& lines);

// Adds the note "outcome unknown" if the distance to the true surface is known in some tick with a frame but
// a measure of the outcome is NaN.
void add_unknown_outcome(std::span<const Measure> measures, const Trace& trace, std::vector<Note>& notes);

// The notes on runs that are not stored as one sweep, such as those of a figure. Any thread may add some.
class NoteCounts {
 public:
  void add(const std::vector<Note>& notes);  // the notes of one run
  void add_run(std::uint64_t bits);          // the same as note_bits()
  void add(const SweepResult& result);       // the notes of its finished runs; pre: run_sweep() has made it
  // Returns a line for each kind: "12 of 210 runs: no contact: no point was touched and no force was felt".
  std::vector<std::string> lines() const;

 private:
  mutable std::mutex mutex_;
  std::size_t runs_ = 0;
  std::map<std::size_t, std::size_t> of_kind_;  // key: number of the kind
};

// These functions read a whole sweep, as read_sweep() does: the runs of other shards are `elsewhere`.
StoredSweep read_stored_sweep(const Hdf5Reader& file);
StoredSweep read_stored_sweep(const std::filesystem::path& file);

// Returns one line with the number of runs of a sweep in progress that have a wrong checksum; empty if there
// are none.
std::string damage_text(const StoredSweep& stored);

// A sweep as its file keeps it: with its runs, or with a tally of each cell. Commands read either as one.
struct KeptSweep {
  std::variant<SweepResult, SweepTally> kept;
  TextAttributes attributes;
  std::string warning = {};  // one line if some runs are known to be wrong or are left out

  const SweepGrid& grid() const {
    return std::visit([](const SweepGrid& grid) -> const SweepGrid& { return grid; }, kept);
  }
};

// whole: runs of other shards are `elsewhere`; as_stored: a part stays a part.
enum class Extent { whole, as_stored };
// Throws InputError for a file that is not a sweep or a tally.
KeptSweep read_kept_sweep(const std::filesystem::path& file, Extent extent);

// Returns the number of runs in a state. A tally knows those that are done or failed.
std::size_t count_of(const SweepResult& result, RunState state);
std::size_t count_of(const SweepTally& tally, RunState state);

}  // namespace remote_touch
