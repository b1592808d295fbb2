// A sweep as arrays over its axes.
#pragma once

#include <pybind11/pybind11.h>

#include "analysis/sweeps/sweep_file.h"
#include "runners/interfaces/python/arrays.h"

namespace remote_touch {

// {"axes", "measures", "error", "replicates", "attributes"}: measures are arrays over the axes and the
// replicates. So is `notes`, whose elements have one bit for each name of the attribute note_kinds.
pybind11::dict to_python(StoredSweep stored);

}  // namespace remote_touch
