// Results for Python: files, sweeps and tallies as arrays over their axes, comparisons and scorecards.
#pragma once

#include <pybind11/pybind11.h>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "runners/interfaces/python/arrays.h"

namespace remote_touch {

// {"axes", "measures", "error", "replicates", "attributes", "warning"}: measures are arrays over the axes and
// the replicates. So is `notes`, whose elements have one bit for each name of the attribute note_kinds.
// warning: one line if some runs are left out because their checksum is wrong, else empty.
pybind11::dict to_python(StoredSweep stored);

// {"axes", "columns", "attributes", "warning"}: the columns are arrays over the axes, zero or NaN for a cell
// without runs. `runs` and `failed` count runs. Each measure has MEASURE_values, the number of its finite
// values, and their MEASURE_mean, MEASURE_standard_deviation, MEASURE_least and MEASURE_greatest. warning:
// one line if some runs are known to be wrong, else empty. Throws InputError if the sweep has more than 1e7
// cells.
pybind11::dict to_python(const StoredTally& stored);

}  // namespace remote_touch
