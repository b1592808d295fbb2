// The notes on the runs of a sweep, as counts by kind.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/tally/sweep_tally.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

struct Trace;

// The options of `replay` for a run: "--cell 0,3", and "--replicate 2" if there are several replicates.
std::string option_of_run(const SweepResult& result, std::size_t run);

// Returns a line for each kind of note that a finished run has:
//   "12 of 210 runs: no contact: no point was touched and no force was felt (the first: --cell 0,3)"
// Empty for a result that was stored without notes.
std::vector<std::string> note_lines(const SweepResult& result);
// The same for counts over several results of one sweep, of which `done` runs are finished.
std::vector<std::string> note_lines(const SweepResult& sweep, const std::vector<NoteCount>& counts,
                                    std::size_t done);

// The same of a tally.
std::vector<std::string> note_lines(const SweepTally& tally);

// Throws InputError with all these lines, for --strict. Does nothing if there is none.
void refuse_notes(const SweepResult& result);
void refuse_notes(const SweepTally& tally);

// Adds the note "outcome unknown" if the distance to the true surface is known in some tick with a frame but
// a measure of the outcome is NaN.
void add_unknown_outcome(std::span<const Measure> measures, const Trace& trace, std::vector<Note>& notes);

// The notes on runs that are not stored as one sweep, such as those of a figure. Any thread may add some.
class NoteCounts {
 public:
  void add(const std::vector<Note>& notes);  // the notes of one run
  void add(const SweepResult& result);       // the notes of its finished runs; pre: run_sweep() has made it
  // Returns a line for each kind: "12 of 210 runs: no contact: no point was touched and no force was felt".
  std::vector<std::string> lines() const;

 private:
  void add_run(std::uint64_t bits);
  mutable std::mutex mutex_;
  std::size_t runs_ = 0;
  std::map<std::size_t, std::size_t> of_kind_;  // key: number of the kind
};

}  // namespace remote_touch
