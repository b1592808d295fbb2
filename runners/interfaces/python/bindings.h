// The parts of the module remote_touch._core. Users call the Python files of remote_touch/ instead, which
// check and convert the arguments and make data sets of the columns.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

void bind_clouds(pybind11::module_& module);   // Cloud, Frame, Device, Output, NoiseKey, Scene
void bind_classes(pybind11::module_& module);  // register_class
void bind_experiments(pybind11::module_& module);
void bind_sweeps(pybind11::module_& module);
void bind_chunks(pybind11::module_& module);  // runs of a sweep in workers of an executor
void bind_scorecards(pybind11::module_& module);
void bind_results(pybind11::module_& module);  // files, comparisons, descriptions
void bind_studies(pybind11::module_& module);  // runs of a study, its figure file and its claims
void bind_theory(pybind11::module_& module);   // closed forms and estimates, as the module _core.theory

// The experiment or the sweep of a call: that of a name or a file, or of a text in JSON, whose label the
// subject then is.
Experiment experiment_of(const std::string& subject, const std::optional<std::string>& text,
                         const std::vector<std::string>& overrides);
Sweep sweep_of(const std::string& subject, const std::optional<std::string>& text,
               const std::vector<std::string>& overrides);

// Results for Python: files, sweeps and tallies as arrays over their axes, comparisons and scorecards.

// A sweep with its runs is {"kind", "axes", "measures", "error", "replicates", "attributes", "warning"}:
// measures are arrays over the axes and the replicates. So is `notes`, whose elements have one bit for each
// name of the attribute note_kinds. A tally is {"kind", "axes", "columns", "attributes", "warning"}: the
// columns are arrays over the axes, zero or NaN for a cell without runs. `runs` and `failed` count runs. Each
// measure has MEASURE_values, the number of its finite values, and their MEASURE_mean,
// MEASURE_standard_deviation, MEASURE_least and MEASURE_greatest. Throws InputError if a tally has more than
// 1e7 cells.
pybind11::dict to_python(KeptSweep stored);

}  // namespace remote_touch
