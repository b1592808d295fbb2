#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/sweep/sweep_run.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Runs an experiment, or repeats one run of a sweep.

namespace py = pybind11;

namespace {

// The file that a call writes, if it writes one: if the name is empty, there is no file.
class OutputFile {
 public:
  // Throws InputError, before any work is done, unless the result can be written there. The folder must be
  // writable. The file must be none of the inputs. An existing file must be a result of this project or
  // empty, unless force is given. Holds the lock of the file.
  OutputFile(const std::string& file, bool force, const std::string& subject,
             const std::vector<InputPart>& inputs)
      : file_(file) {
    if (file.empty()) return;
    require_different_file(file, subject);
    for (const InputPart& part : inputs) require_different_file(file, part.path);
    require_output(file, {.is_ours = has_result_header, .force = force, .force_option = "force=True"});
    lock_.emplace(file);
  }
  // Writes the trace while no other call uses the HDF5 library. Returns its digest.
  std::string write(const std::vector<Column>& columns, const TextAttributes& origin,
                    const std::vector<double>& durations) const {
    if (file_.empty()) return digest(columns);
    const FileTurn turn;
    return write_trace(file_, columns, origin, durations);
  }

 private:
  const std::string file_;
  std::optional<FileLock> lock_;
};

using Texts = std::vector<std::string>;

SimulationOptions options_of(const LongWork& work) {
  SimulationOptions options;
  options.kernels = &work.kernels;
  options.stop = &work.stop;
  options.progress = work.progress;
  return options;
}

// The result of a run for Python.
struct RunResult {
  std::vector<Column> columns, measures, timing;
  TextAttributes attributes;
  std::string warning = {};  // one line; empty: none
};

std::vector<Column> measures_of(const Trace& trace) {
  std::vector<Column> list;
  for (const Measure& measure : measures())
    if (applies(measure, trace))
      list.push_back(
          {measure.name, measure.unit, measure.meaning, std::vector<double>{measure.compute(trace)}});
  return list;
}

TextAttributes trace_attributes(const TextAttributes& origin, const std::string& digest_of_all,
                                const std::vector<Column>& columns) {
  TextAttributes list = {{"schema", schema_name("trace")}};
  list.insert(list.end(), origin.begin(), origin.end());
  list.insert(list.end(), {{"digest", digest_of_all}, {"columns", joined(names_of(columns), ",")}});
  return list;
}

RunResult run(const std::string& subject, const std::optional<std::string>& text, const Texts& overrides,
              const std::string& file_or_none, bool force, bool timing, const LongWork& work) {
  const Experiment experiment = experiment_of(subject, text, overrides);
  const OutputFile output(file_or_none, force, subject, experiment.inputs());
  SimulationOptions options = options_of(work);
  options.hash_frames = options.find_true_contact = true;
  std::vector<double> durations;
  RunReport report;
  options.report = &report;
  if (timing) options.step_duration_s = &durations;
  const std::string inputs = input_hashes(experiment.inputs());
  TextAttributes origin =
      provenance(experiment.to_json(), Recipe{"run", subject, overrides}, work.kernels.isa, inputs);
  const Trace trace = simulate(experiment, options);
  require_unchanged(experiment.inputs(), inputs);
  experiment.add_depth_device(origin);
  add_unknown_outcome(measures(), trace, report.notes);
  add_report(origin, report);
  RunResult result{trace.columns(), measures_of(trace), {}, {}};
  result.attributes =
      trace_attributes(origin, output.write(result.columns, origin, durations), result.columns);
  if (timing) result.timing.push_back({"step_duration", "s", "wall clock of one tick", std::move(durations)});
  return result;
}

py::dict as_dict(RunResult result) {
  py::dict all;
  all["columns"] = to_python(std::move(result.columns));
  all["measures"] = to_python(std::move(result.measures));
  all["timing"] = to_python(std::move(result.timing));
  all["attributes"] = to_python(result.attributes);
  all["warning"] = result.warning;
  return all;
}

py::dict run_experiment(const std::string& subject, const std::optional<std::string>& text,
                        const Texts& overrides, const std::string& output, bool force, bool timing,
                        const py::object& report) {
  RunResult result;
  do_long_work(report, 0, [&](const LongWork& work) {
    result = run(subject, text, overrides, output, force, timing, work);
  });
  return as_dict(std::move(result));
}

// --- replay ---

// Runs a run of the sweep in a file again, or, without a file, of the sweep that these attributes describe.
RunResult replay(const std::string& file, const TextAttributes& attributes, const std::string& cell_text,
                 int replicate, const std::string& file_or_none, bool force, const LongWork& work) {
  std::optional<KeptSweep> stored;
  if (!file.empty()) {
    const FileTurn turn;
    stored = read_kept_sweep(file, Extent::as_stored);
  }
  const TextAttributes of_sweep = stored ? stored->attributes : provenance_of(attributes);
  const Sweep sweep =
      Sweep::from_json(attribute(of_sweep, "config"), stored ? file + " config" : "config of the data set");
  const SweepGrid grid = sweep.outline();
  if (stored) sweep.require_fits(stored->grid(), file);
  const std::size_t cell = cell_of({"cell", cell_text}, grid);
  if (replicate < 0 || replicate >= grid.replicates)
    throw InputError("replicate = " + std::to_string(replicate),
                     "expected 0 to " + std::to_string(grid.replicates - 1));
  const OutputFile output(file_or_none, force, file, {});
  Replay again = replay_run(of_sweep, sweep, grid.run(cell, replicate), options_of(work), "");
  RunResult result{again.trace.columns(), measures_of(again.trace), {}, {}};
  if (!file_or_none.empty()) output.write(result.columns, again.attributes, {});
  result.attributes = trace_attributes(again.attributes, again.digest, result.columns);
  result.warning = distrust_of(of_sweep);
  return result;
}

py::dict replay_sweep(const std::string& file, const TextAttributes& attributes, const std::string& cell,
                      int replicate, const std::string& output, bool force, const py::object& report) {
  RunResult result;
  do_long_work(report, 0, [&](const LongWork& work) {
    result = replay(file, attributes, cell, replicate, output, force, work);
  });
  return as_dict(std::move(result));
}

}  // namespace

Experiment experiment_of(const std::string& subject, const std::optional<std::string>& text,
                         const std::vector<std::string>& overrides) {
  return text ? Experiment::from_json(*text, subject, overrides) : Experiment::load(subject, overrides);
}

Sweep sweep_of(const std::string& subject, const std::optional<std::string>& text,
               const std::vector<std::string>& overrides) {
  return text ? Sweep::from_json(*text, subject, overrides) : Sweep::load(subject, overrides);
}

void bind_experiments(py::module_& module) {
  module.def("run", &run_experiment, py::arg("subject"), py::arg("text"), py::arg("overrides"),
             py::arg("output"), py::arg("force"), py::arg("timing"), py::arg("report"),
             "Runs an experiment: columns, measures and attributes of its trace.");
  module.def("replay", &replay_sweep, py::arg("file"), py::arg("attributes"), py::arg("cell"),
             py::arg("replicate"), py::arg("output"), py::arg("force"), py::arg("report"),
             "Runs a run of a sweep again.");
}

}  // namespace remote_touch
