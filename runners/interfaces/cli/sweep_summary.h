// The texts that the commands about sweeps print.
#pragma once

#include <string>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

std::string extent_text(const SweepResult& result);  // "76 x 71"

// Prints the cells, the runs, the mean and range of each measure, and the number of runs with each kind of
// note. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepResult& result);

}  // namespace remote_touch
