// The notes on the runs of a sweep, as counts by kind.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// The options of `replay` for a run: "--cell 0,3", and "--replicate 2" if there are several replicates.
std::string option_of_run(const SweepResult& result, std::size_t run);

// Returns a line for each kind of note that a finished run has:
//   "12 of 210 runs: no contact: no point was touched and no force was felt (the first: --cell 0,3)"
// Empty for a result that was stored without notes.
std::vector<std::string> note_lines(const SweepResult& result);

// Throws InputError with all these lines, for --strict. Does nothing if there is none.
void refuse_notes(const SweepResult& result);

}  // namespace remote_touch
