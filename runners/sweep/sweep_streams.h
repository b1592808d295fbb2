// The random streams of the runs of a stored sweep.
#pragma once

#include <string>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Returns the streams of all cells, from the configuration with which the sweep was made (JSON): it states
// every deviation and probability, the axes with common noise, and seeds. So they are known for every stored
// sweep and tally, of any version. If the configuration cannot be read, as that of an experiment with a scene
// that only the program that made it knows, `doubt` says so; then runs of one replicate count as one, and so
// do the runs of a cell that are equal in all measures. Only the outline of the result is needed; without
// values no runs count as equal.
CellStreams streams_of(const SweepResult& result, const std::string& config);

}  // namespace remote_touch
