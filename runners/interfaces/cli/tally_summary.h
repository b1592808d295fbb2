// The text that commands print about a tally.
#pragma once

#include <string>

#include "analysis/tally/sweep_tally.h"

namespace remote_touch {

// Prints the cells, the runs, the mean and range of each measure over all runs, the number of runs with each
// kind of note, and the first failed run of each cell. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepTally& tally, const std::string& digest);

}  // namespace remote_touch
