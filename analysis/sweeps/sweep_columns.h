// The arrays of a sweep in its file, beside the measures.
#pragma once

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Each has the values of the result; without values if it has none.
Column state_column(const SweepResult& result);
Column notes_column(const SweepResult& result);
// Returns the numbers of a stored column of notes. Earlier results store them in 32 bits.
std::vector<std::uint64_t> note_numbers(const Column& notes);
Column error_column(const SweepResult& result);
Column round_column(const SweepResult& result);
// The numbers of the runs of a part. pre: the result is a part.
Column run_column(const SweepResult& result);
// The scale of the last dimension, if there are several replicates.
Column replicate_column(const SweepResult& result);

}  // namespace remote_touch
