// The notes on the runs of a sweep, as counts by kind.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// A line for each kind of note that a finished run has:
//   "12 of 210 runs: no contact: no point was touched and no force was felt (the first: --cell 0,3)"
// --replicate follows where there are several. Empty for a result that was stored without notes.
std::vector<std::string> note_lines(const SweepResult& result);

// Throws InputError with the first of the lines, for --strict. Does nothing without a note.
void refuse_notes(const SweepResult& result);

}  // namespace remote_touch
