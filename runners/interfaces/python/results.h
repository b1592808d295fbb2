// Results for Python: files, sweeps and tallies as arrays over their axes, comparisons and scorecards.
#pragma once

#include <pybind11/pybind11.h>

#include "runners/interfaces/python/arrays.h"
#include "runners/sweep/kept_sweep.h"

namespace remote_touch {

// A sweep with its runs is {"kind", "axes", "measures", "error", "replicates", "attributes", "warning"}:
// measures are arrays over the axes and the replicates. So is `notes`, whose elements have one bit for each
// name of the attribute note_kinds. A tally is {"kind", "axes", "columns", "attributes", "warning"}: the
// columns are arrays over the axes, zero or NaN for a cell without runs. `runs` and `failed` count runs. Each
// measure has MEASURE_values, the number of its finite values, and their MEASURE_mean,
// MEASURE_standard_deviation, MEASURE_least and MEASURE_greatest. Throws InputError if a tally has more than
// 1e7 cells.
pybind11::dict to_python(KeptSweep stored);

}  // namespace remote_touch
