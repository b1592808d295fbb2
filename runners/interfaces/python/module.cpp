#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/clouds.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/python_class.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

PyObject* input_error_type = nullptr;  // belongs to the module, which is never unloaded

void bind_errors(py::module_& module) {
  input_error_type = py::register_exception<InputError>(module, "InputError", PyExc_ValueError).ptr();
  py::register_exception<MissingInput>(module, "MissingInput", input_error_type);
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

// The part of the Python package that is written in C++.
PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package remote_touch is made of.";
  bind_errors(module);
  bind_clouds(module);
  bind_classes(module);
  bind_stepper(module);
  bind_experiments(module);
  bind_sweeps(module);
  bind_chunks(module);
  bind_scorecards(module);
  bind_results(module);
  bind_studies(module);
  bind_theory(module);
  module.def("choose_kernels", &choose_python_kernels, py::arg("isa"),
             "The x86-64 level; empty: the fastest.");
  module.def("set_data_folder", &set_data_folder, py::arg("folder"), "Where recordings are.");
}

namespace {

// Adds Python classes to the catalog of this process.

template <class Entry>
void replace_or_add(std::vector<Entry>& entries, Entry entry) {
  std::erase_if(entries, [&](const Entry& other) { return other.name == entry.name; });
  entries.push_back(std::move(entry));
}

// The classes of this process, in the order in which they were registered.
struct PythonClasses {
  std::vector<RendererEntry> renderers;
  std::vector<ScenarioEntry> scenarios;
  std::vector<TrajectoryEntry> trajectories;

  Catalog with_built_in() const {
    Catalog catalog = built_in_catalog();
    for (const RendererEntry& entry : renderers) catalog.add(entry);
    for (const ScenarioEntry& entry : scenarios) catalog.add(entry);
    for (const TrajectoryEntry& entry : trajectories) catalog.add(entry);
    return catalog;
  }
};

PythonClasses& classes() {
  static PythonClasses all;
  return all;
}

template <class Choice>
Choice choice_of(const std::string& given, std::initializer_list<const char*> names,
                 const std::string& subject) {
  std::string known;
  int value = 0;
  for (const char* name : names) {
    if (given == name) return static_cast<Choice>(value);
    known += (known.empty() ? "" : ", ") + std::string(name), ++value;
  }
  throw InputError(subject + " = " + given, "expected " + known);
}

void add_renderer(PythonEntry entry, const py::object& type, PythonClasses& all) {
  const int freedom = type.attr("degrees_of_freedom").cast<int>();
  if (freedom != 3 && freedom != 6) throw InputError(entry.name + ": degrees_of_freedom", "expected 3 or 6");
  const auto model =
      choice_of<int>(type.attr("contact_model").cast<std::string>(),
                     {"points", "regions", "mesh", "sheet", "nothing", "oriented", "resting_points"},
                     entry.name + ": contact_model");
  std::vector<FrameNeed> needs;
  for (const py::handle need : type.attr("needs"))
    needs.push_back(choice_of<FrameNeed>(
        need.cast<std::string>(), {"normals", "organised", "regions", "view"}, entry.name + ": needs"));
  declare_contact_model(entry.name, kContactModels[model]);
  replace_or_add(
      all.renderers,
      renderer_entry_of(std::move(entry), freedom == 6 ? DegreesOfFreedom::six : DegreesOfFreedom::three,
                        std::move(needs)));
}

// A class replaces an earlier one of the same name, because a cell of a notebook may be run again.
void register_class(const std::string& kind, const std::string& name, const std::string& summary,
                    const py::object& type, const py::list& settings) {
  require_no_long_work("register");
  PythonEntry entry{name, summary, std::make_shared<const PythonClass>(kind, name, type),
                    PythonSettings(kind + " " + name, settings)};
  PythonClasses changed = classes();
  if (kind == "renderer")
    add_renderer(std::move(entry), type, changed);
  else if (kind == "scenario")
    replace_or_add(changed.scenarios, scenario_entry_of(std::move(entry)));
  else
    replace_or_add(changed.trajectories, trajectory_entry_of(std::move(entry)));
  use_catalog(changed.with_built_in());
  classes() = std::move(changed);
}

PythonOutput make_output(const py::object& proxy_m, const py::object& force_N, const py::object& slave_m,
                         const std::string& state, const py::object& normal, double surface_velocity_m_per_s,
                         double nearest_distance_m, const py::object& frame_correction_m, int steps,
                         bool converged, int contact_count, const std::string& status,
                         const py::object& torque_Nm, const py::object& tool_orientation) {
  PythonOutput made;
  RenderOutput& out = made.output;
  const auto take = [](const py::object& given, const char* name, Vec3& to) {
    if (!given.is_none())
      to = vector_of(
          given, [&] { return std::string("Output: ") + name; }, Allowed::any);
  };
  made.has_proxy = !proxy_m.is_none();
  take(proxy_m, "proxy_m", out.proxy_W), take(force_N, "force_N", out.force_N);
  take(slave_m, "slave_m", out.slave_W), take(normal, "normal", out.normal_W);
  take(frame_correction_m, "frame_correction_m", out.frame_correction_m);
  out.state = choice_of<ContactState>(state, {"free", "contact", "entrenched"}, "Output: state");
  out.status = choice_of<RenderStatus>(
      status, {"ok", "stale_frame_dropped", "degenerate_normal", "no_frame", "device_not_finite"},
      "Output: status");
  out.surface_velocity_m_per_s = surface_velocity_m_per_s, out.nearest_distance_m = nearest_distance_m;
  out.steps = steps, out.converged = converged, out.contact_count = contact_count;
  if (!torque_Nm.is_none()) take(torque_Nm, "torque_Nm", made.torque_Nm.emplace());
  if (!tool_orientation.is_none())
    made.tool_orientation = quaternion_of(tool_orientation, [] { return "Output: tool_orientation"; });
  return made;
}

// The columns of a trace that the renderer computes: those whose value in trace_columns.h needs the output
// only.
struct OutputTick {
  const RenderOutput& out;
};
using OutputColumns = std::map<std::string, std::function<py::object(const RenderOutput&)>>;

template <class Row, class Value>
void add_column(OutputColumns& columns, const char* name, TracePart part, Value value) {
  if constexpr (std::is_invocable_v<Value, OutputTick>)
    columns[name] = [=](const RenderOutput& out) -> py::object {
      if (part == TracePart::tool && !out.tool) return py::none();
      if (part == TracePart::guidance && !out.guidance) return py::none();
      if constexpr (std::is_arithmetic_v<Row>)
        return py::cast(static_cast<Row>(value(OutputTick{out})));
      else
        return array_of(Row(value(OutputTick{out})));
    };
}

OutputColumns output_columns() {
  OutputColumns columns;
#define TRACE_COLUMN(member, Row, name, unit, part, value, ...) \
  add_column<Row>(                                              \
      columns, name, TracePart::part, [](const auto& t) requires requires { value; } { return value; });
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
  return columns;
}

py::object column_of_output(const PythonOutput& made, const std::string& name) {
  static const OutputColumns columns = output_columns();
  const auto found = columns.find(name);
  if (found != columns.end()) return found->second(made.output);
  std::string known;
  for (const auto& [column, value] : columns) known += (known.empty() ? "" : ", ") + column;
  throw InputError("Output: " + name, "expected a column that the renderer computes: " + known);
}

constexpr const char* kOutput =
    R"(The output of one tick; metres, newtons, world frame.

proxy_m: position of the proxy, or of the tool's centre of mass; None: the HIP. force_N: force on the hand;
None: none.
slave_m: command to a slave robot; None: none yet. state: free, contact or entrenched. normal: unit, out of
the surface. nearest_distance_m: from the proxy to the nearest point. The others are the columns of a trace of
these names: rt.describe("trace"). torque_Nm, about the HIP, and tool_orientation, w x y z, are for classes
with degrees_of_freedom = 6.)";

}  // namespace

void bind_classes(py::module_& module) {
  const py::object none = py::none();
  py::class_<PythonOutput>(module, "Output", kOutput)
      .def(py::init(&make_output), py::kw_only(), py::arg("proxy_m") = none, py::arg("force_N") = none,
           py::arg("slave_m") = none, py::arg("state") = "free", py::arg("normal") = none,
           py::arg("surface_velocity_m_per_s") = 0.0,
           py::arg("nearest_distance_m") = std::numeric_limits<double>::infinity(),
           py::arg("frame_correction_m") = none, py::arg("steps") = 0, py::arg("converged") = false,
           py::arg("contact_count") = 0, py::arg("status") = "ok", py::arg("torque_Nm") = none,
           py::arg("tool_orientation") = none)
      .def_property_readonly("force_N", [](const PythonOutput& o) { return array_of(o.output.force_N); })
      .def_property_readonly("proxy_m",
                             [](const PythonOutput& o) -> py::object {
                               if (!o.has_proxy) return py::none();
                               return array_of(o.output.proxy_W);
                             })
      .def_property_readonly("torque_Nm",
                             [](const PythonOutput& o) -> py::object {
                               if (!o.torque_Nm) return py::none();
                               return array_of(*o.torque_Nm);
                             })
      .def_property_readonly("tool_orientation",
                             [](const PythonOutput& o) -> py::object {
                               if (!o.tool_orientation) return py::none();
                               return array_of(*o.tool_orientation);
                             })
      .def_property_readonly("normal", [](const PythonOutput& o) { return array_of(o.output.normal_W); })
      .def_property_readonly(
          "state",
          [](const PythonOutput& o) {
            return std::array{"free", "contact", "entrenched"}[static_cast<std::size_t>(o.output.state)];
          })
      .def(
          "__getitem__", &column_of_output, py::arg("column"),
          "Of a step, a column of the trace of rt.run(), such as \"proxy_steps\"; None if this renderer has none.");
  module.def("register_class", &register_class, py::arg("kind"), py::arg("name"), py::arg("summary"),
             py::arg("type"), py::arg("settings"), "Puts a class into the catalog.");
  module.def(
      "identify_program",
      [](const std::string& name, const std::string& sha256) {
        require_no_long_work("register");
        identify_program({name, sha256, {}});
      },
      py::arg("name"), py::arg("sha256"), "Results record this from now on.");
}

}  // namespace remote_touch
