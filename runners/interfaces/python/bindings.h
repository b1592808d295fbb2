// The parts of the module remote_touch._core. Users call the Python files of remote_touch/ instead, which
// check and convert the arguments and make data sets of the columns.
#pragma once

#include <pybind11/pybind11.h>

namespace remote_touch {

void bind_clouds(pybind11::module_& module);   // Cloud, Frame, Device, Output, NoiseKey, Scene
void bind_classes(pybind11::module_& module);  // register_class
void bind_experiments(pybind11::module_& module);
void bind_sweeps(pybind11::module_& module);
void bind_chunks(pybind11::module_& module);  // runs of a sweep in workers of an executor
void bind_scorecards(pybind11::module_& module);
void bind_results(pybind11::module_& module);  // files, comparisons, descriptions

}  // namespace remote_touch
