// Runs a sweep, in memory or into a file.
#include <pybind11/stl.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/schema.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/sweep_arrays.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

SweepResult in_memory(const Sweep& sweep, const LongWork& work) {
  SweepResult result = sweep.plan();
  std::size_t done = 0;
  SweepRunOptions options;
  options.kernels = &work.kernels, options.stop = &work.stop;
  do {
    const std::size_t all = result.runs_in(RunState::pending).size() + done;
    options.finished = [&](std::size_t) {
      work.progress(static_cast<double>(++done) / static_cast<double>(all));
    };
    if (do_pending_runs(sweep, result, options) > 0) throw std::bad_alloc();
  } while (add_round(sweep, result));
  return result;
}

SweepResult in_file(const Sweep& sweep, const TextAttributes& origin, const std::string& file,
                    const LongWork& work) {
  require_writable(file);
  const FileTurn turn(FileTurn::For::a_sweep);
  SweepSession session(sweep, Shard{}, origin, file);
  session.run(work.kernels, &work.stop, [&](std::size_t done, std::size_t all, std::size_t) {
    work.progress(static_cast<double>(done) / static_cast<double>(all));
  });
  return session.result();
}

py::dict run_sweep_of(const std::string& subject, const std::optional<std::string>& text,
                      const std::vector<std::string>& overrides, int threads, const std::string& output,
                      const py::object& report) {
  StoredSweep stored;
  do_long_work(report, threads, [&](const LongWork& work) {
    const Sweep sweep = text ? Sweep::from_json(*text, subject, overrides) : Sweep::load(subject, overrides);
    stored.attributes =
        provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", input_hashes(sweep.inputs()));
    stored.result = output.empty() ? in_memory(sweep, work) : in_file(sweep, stored.attributes, output, work);
  });
  return to_python(std::move(stored));
}

}  // namespace

py::dict to_python(StoredSweep stored) {
  SweepResult& result = stored.result;
  TextAttributes attributes = {{"schema", schema_name("sweep")}};
  attributes.insert(attributes.end(), stored.attributes.begin(), stored.attributes.end());
  attributes.emplace_back("digest", digest(result));
  if (!result.note_kinds.empty()) attributes.emplace_back("note_kinds", joined(result.note_kinds, ","));
  std::vector<py::ssize_t> shape;
  for (const Column& axis : result.axes) shape.push_back(static_cast<py::ssize_t>(axis.length()));
  shape.push_back(result.replicates);
  py::dict all;
  all["attributes"] = to_python(attributes);
  all["axes"] = to_python(std::move(result.axes));
  py::list measures;
  for (Column& measure : result.measures) measures.append(to_python(std::move(measure), shape));
  measures.append(to_python(state_column(result), shape));
  if (!result.round.empty())
    measures.append(to_python(
        Column{"round", "1", "round of refinement that added the run", std::move(result.round)}, shape));
  if (!result.notes.empty())
    measures.append(to_python(
        Column{
            "notes", "1", "notes on the run, one bit for each of note_kinds", std::move(result.notes), 1, {}},
        shape));
  all["measures"] = measures;
  all["error"] = py::cast(result.error);
  all["replicates"] = result.replicates;
  return all;
}

void bind_sweeps(py::module_& module) {
  module.def("sweep", &run_sweep_of, py::arg("subject"), py::arg("text"), py::arg("overrides"),
             py::arg("threads"), py::arg("output"), py::arg("report"),
             "Runs a sweep: axes, and measures over them.");
}

}  // namespace remote_touch
