// The texts that the commands about sweeps print.
#pragma once

#include <string>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

std::string extent_text(const SweepResult& result);  // "76 x 71"

// Cells, runs, each measure's mean and range, and the notes on the runs as counts by kind. Returns kDone, or
// kCheckFailed when a run failed.
int print_summary(const std::string& file, const SweepResult& result);

}  // namespace remote_touch
