// The module remote_touch._core: the part of the Python package that is written in C++.
#include <pybind11/pybind11.h>

#include "core/parameters/input_error.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/python_class.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

PyObject* input_error_type = nullptr;  // belongs to the module, which is never unloaded

void bind_errors(py::module_& module) {
  input_error_type = py::register_exception<InputError>(module, "InputError", PyExc_ValueError).ptr();
  // pybind11 calls this translator before the one above. The exception that a class raised becomes the cause
  // of the InputError.
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const PythonProblem& problem) {
      problem.raised().restore();
      py::raise_from(input_error_type, problem.what());
    } catch (const Interrupted&) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package remote_touch is made of.";
  bind_errors(module);
  bind_clouds(module);
  bind_classes(module);
  bind_experiments(module);
  bind_sweeps(module);
  bind_chunks(module);
  bind_scorecards(module);
  bind_results(module);
  module.def("choose_kernels", &choose_python_kernels, py::arg("isa"),
             "The x86-64 level; empty: the fastest.");
  module.def("set_data_folder", &set_data_folder, py::arg("folder"), "Where recordings are.");
}

}  // namespace remote_touch
