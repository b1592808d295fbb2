// Small pieces of the work that takes most time: steps of the proxy, noise, disks of a tool, and two rows of
// the depth pipeline.
#pragma once

#include <vector>

#include "runners/experiment/provenance/level_timing.h"

namespace remote_touch {

// Returns the tasks. Their inputs are made once. The tasks share nothing and write to memory of their own.
std::vector<KernelTask> representative_tasks();

}  // namespace remote_touch
