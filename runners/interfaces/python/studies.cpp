#include <pybind11/stl.h>

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/clouds.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

// The runs of a study, and the files that it writes: those of a figure.

namespace py = pybind11;

namespace {

using Json = nlohmann::ordered_json;
using Texts = std::vector<std::string>;
using OptionalText = std::optional<std::string>;

// Makes the runs of one study. Several threads may call run() and uses() at the same time. The hash of a
// recording is computed once, however many runs read it.
class StudyRuns {
 public:
  // Returns the configuration, the columns of the trace, the measures, and the notes of a run as bits.
  py::tuple run(const std::string& subject, const OptionalText& text, const Texts& overrides) {
    std::string config;
    Trace trace;
    std::vector<Column> measures_of_run;
    std::uint64_t notes = 0;
    do_long_work(py::none(), 1, [&](const LongWork& work) {
      const Experiment experiment = experiment_of(subject, text, overrides);
      config = noted(experiment);
      SimulationOptions options;
      options.kernels = &work.kernels, options.stop = &work.stop;
      RunReport report;
      options.report = &report;
      trace = simulate(experiment, options);
      notes = note_bits(report.notes);
      notes_.add_run(notes);
      for (const auto& [measure, value] : measured_values(measures(), trace))
        measures_of_run.push_back(
            {measure->name, measure->unit, measure->meaning, std::vector<double>{value}});
    });
    return py::make_tuple(config, to_python(trace.columns()), to_python(std::move(measures_of_run)), notes);
  }
  // Returns the configuration of an experiment that is used without a run.
  std::string uses(const std::string& subject, const OptionalText& text, const Texts& overrides) {
    return noted(experiment_of(subject, text, overrides));
  }
  // Returns the configuration of a sweep, and the numbers of its runs with and without `coarse`.
  py::tuple uses_sweep(const std::string& subject, const OptionalText& text, const Texts& overrides,
                       int coarse) {
    const Sweep whole = sweep_of(subject, text, overrides);
    const Sweep made = coarse > 1 ? whole.thinned(coarse) : whole;
    add_inputs(made.inputs());
    return py::make_tuple(made.to_json(), made.plan().run_count(), whole.plan().run_count());
  }
  // Makes all runs of a sweep of this configuration, in memory. Throws InputError if one of them failed.
  py::dict sweep(const std::string& config) {
    KeptSweep made;
    do_long_work(py::none(), 0, [&](const LongWork& work) {
      const Sweep sweep = Sweep::from_json(config, "config");
      SweepResult result = run_sweep(sweep, {&work.kernels, &work.stop});
      const auto failed = result.runs_in(RunState::failed);
      if (!failed.empty()) throw InputError(sweep.title(), "a run failed: " + result.error[failed.front()]);
      notes_.add(result);
      made = {std::move(result), provenance(config, Recipe{"sweep", sweep.title()}, "", "")};
    });
    return to_python(std::move(made));
  }
  // Adds the notes of a run that was made elsewhere.
  void add_notes(std::uint64_t bits) { notes_.add_run(bits); }
  Texts note_lines() const { return notes_.lines(); }
  // Returns the attributes of the study's file. Throws InputError if an input has changed since it was read.
  py::list origin(const std::string& configurations, const std::string& command) {
    inputs_.require_unchanged();
    return to_python(provenance(configurations, command, chosen_python_kernels().isa, inputs_.text()));
  }

 private:
  std::string noted(const Experiment& experiment) {
    add_inputs(experiment.inputs());
    return experiment.to_json();
  }
  void add_inputs(const std::vector<InputPart>& parts) {
    const std::lock_guard lock(mutex_);
    inputs_.add(parts);
  }

  std::mutex mutex_;
  InputHashes inputs_;
  NoteCounts notes_;
};

// --- figures ---

Vec3 vec3_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::optional<std::pair<double, double>> pair_of(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return std::nullopt;
  return std::pair{found->at(0).get<double>(), found->at(1).get<double>()};
}

ScenePart part_of(const Json& json) {
  ScenePart part;
  const auto kind = json.at("kind").get<std::string>();
  if (kind != "points" && kind != "segments" && kind != "solid")
    throw std::invalid_argument("unknown kind of a part: " + kind);
  part.kind = kind == "points"     ? ScenePart::Kind::points
              : kind == "segments" ? ScenePart::Kind::segments
                                   : ScenePart::Kind::solid;
  part.table = json.at("table").get<std::string>();
  part.colour = json.value("colour", part.colour), part.size_m = json.value("size_m", part.size_m);
  part.label = json.value("label", ""), part.triangles = json.value("triangles", "");
  part.poses = json.value("poses", ""), part.pose_row = json.value("pose_row", 0);
  part.opacity = json.value("opacity", 1.0), part.coloured_by = json.value("coloured_by", "");
  return part;
}

Scene scene_of(const Json& json) {
  Scene scene{vec3_of(json.at("eye")), vec3_of(json.at("target")), vec3_of(json.at("up"))};
  scene.width_m = json.value("width_m", scene.width_m);
  scene.height_per_width = json.value("height_per_width", scene.height_per_width);
  for (const Json& part : json.at("parts")) scene.parts.push_back(part_of(part));
  return scene;
}

Panel panel_of(const Json& json) {
  Panel panel{json.at("title"), json.at("x_label"), json.at("y_label"), json.value("equal_aspect", false)};
  for (const Json& curve : json.at("curves"))
    panel.curves.push_back({curve.at("table"), curve.at("x"), curve.at("y"),
                            curve_style_named(curve.at("style")), curve.value("label", ""),
                            curve.value("radius", 0.0), curve.value("z", "")});
  panel.x_range = pair_of(json, "x_range"), panel.y_range = pair_of(json, "y_range");
  panel.grid_position = pair_of(json, "at");
  if (const auto scene = json.find("scene"); scene != json.end() && !scene->is_null())
    panel.scene = scene_of(*scene);
  return panel;
}

// tables: (name, title, columns). panels: JSON text of a list. origin: (name, value).
std::string write(const std::string& file, const std::string& name, const std::string& title,
                  const std::string& caption, const std::vector<py::tuple>& tables, const std::string& panels,
                  const TextAttributes& origin) {
  Figure figure{name, title, caption};
  for (const py::tuple& given : tables) {
    Table table{given[0].cast<std::string>(), given[1].cast<std::string>()};
    for (const py::handle& column : given[2]) table.columns.push_back(column_of(column));
    figure.tables.push_back(std::move(table));
  }
  try {
    for (const Json& panel : Json::parse(panels)) figure.panels.push_back(panel_of(panel));
  } catch (const std::exception& error) {
    throw InputError("study " + name, std::string("a panel: ") + error.what());
  }
  const py::gil_scoped_release without_lock;
  const FileTurn turn;
  return write_figure(file, figure, origin);
}

// Returns the claim with its verdict. kind: at most, at least, between or differs. low: the limit of the
// first two.
Claim claim(const std::string& kind, const std::string& figure, const std::string& text,
            const std::string& paper, double measured, double low, double high, const std::string& unit) {
  if (kind == "at most") return claim_at_most(figure, text, paper, measured, low, unit);
  if (kind == "at least") return claim_at_least(figure, text, paper, measured, low, unit);
  if (kind == "between") return claim_between(figure, text, paper, measured, low, high, unit);
  if (kind == "differs") return claim_differs(figure, text, paper, measured, low, high, unit);
  throw InputError("claim " + kind, "unknown: expected at most, at least, between or differs");
}

}  // namespace

void bind_studies(py::module_& module) {
  py::class_<StudyRuns>(module, "StudyRuns", "The runs of one study, and their inputs and notes.")
      .def(py::init<>())
      .def("run", &StudyRuns::run, py::arg("subject"), py::arg("text"), py::arg("overrides"))
      .def("uses", &StudyRuns::uses, py::arg("subject"), py::arg("text"), py::arg("overrides"))
      .def("uses_sweep", &StudyRuns::uses_sweep, py::arg("subject"), py::arg("text"), py::arg("overrides"),
           py::arg("coarse"))
      .def("sweep", &StudyRuns::sweep, py::arg("config"))
      .def("add_notes", &StudyRuns::add_notes, py::arg("bits"))
      .def("note_lines", &StudyRuns::note_lines)
      .def("origin", &StudyRuns::origin, py::arg("configurations"), py::arg("command"));
  py::class_<Claim>(module, "Claim", "A statement with a criterion, compared with a measured number.")
      .def_readonly("claim", &Claim::claim)
      .def_readonly("measured", &Claim::measured)
      .def_readonly("criterion", &Claim::criterion)
      .def_readonly("unit", &Claim::unit)
      .def_readwrite("source", &Claim::source)
      .def_readwrite("of_map", &Claim::of_map)
      .def_readwrite("set_up", &Claim::set_up)
      .def_property_readonly("verdict", [](const Claim& one) { return verdict_name(one.verdict); })
      .def("leave_open", &leave_open)
      .def("__str__", &line_of);
  module.def(
      "require_result",
      [](const std::string& file) {
        require_output(file, {.is_ours = has_result_header, .force_option = "another folder"});
      },
      py::arg("file"), "Refuses a file that cannot be written, or that is no result of this program.");
  module.def("claim", &claim, py::arg("kind"), py::arg("figure"), py::arg("text"), py::arg("paper"),
             py::arg("measured"), py::arg("low"), py::arg("high"), py::arg("unit"), "A claim of a figure.");
  module.def("coarse_text", &coarse_text, py::arg("made_runs"), py::arg("runs"), py::arg("coarse"),
             "What a caption says of maps that were made in part.");
  module.def("claim_not_run", &claim_not_run, py::arg("figure"), py::arg("claim"), py::arg("reason"));
  module.def("write_figure", &write, py::arg("file"), py::arg("name"), py::arg("title"), py::arg("caption"),
             py::arg("tables"), py::arg("panels"), py::arg("origin"), "Writes the file of a figure.");
  module.def(
      "replace_claims",
      [](const std::string& file, const Texts& order, const std::string& figure,
         const std::vector<Claim>& claims) { ClaimsFile(file, order).replace(figure, claims); },
      py::arg("file"), py::arg("order"), py::arg("figure"), py::arg("claims"),
      "Replaces a figure's claims in claims.json.");
}

}  // namespace remote_touch
