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

struct SweepRequest {
  std::string subject;
  std::optional<std::string> text;  // JSON
  std::vector<std::string> overrides;
  std::string output;  // empty: in memory
};

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

void run(const SweepRequest& request, const LongWork& work, StoredSweep& stored) {
  const Sweep sweep = request.text ? Sweep::from_json(*request.text, request.subject, request.overrides)
                                   : Sweep::load(request.subject, request.overrides);
  const TextAttributes origin = provenance(
      sweep.to_json(), Recipe{"sweep", request.subject, request.overrides}, "", input_hashes(sweep.inputs()));
  stored.result =
      request.output.empty() ? in_memory(sweep, work) : in_file(sweep, origin, request.output, work);
  stored.attributes = origin;
}

py::dict run_sweep_of(const std::string& subject, const std::optional<std::string>& text,
                      const std::vector<std::string>& overrides, int threads, const std::string& output,
                      const py::object& report) {
  const SweepRequest request{subject, text, overrides, output};
  StoredSweep stored;
  do_long_work(report, threads, [&](const LongWork& work) { run(request, work, stored); });
  return to_python(std::move(stored));
}

}  // namespace

py::dict to_python(StoredSweep stored) {
  SweepResult& result = stored.result;
  TextAttributes attributes = {{"schema", schema_name("sweep")}};
  attributes.insert(attributes.end(), stored.attributes.begin(), stored.attributes.end());
  attributes.emplace_back("digest", digest(result));
  if (!result.note_kinds.empty()) attributes.emplace_back("note_kinds", joined_names(result.note_kinds));
  std::vector<py::ssize_t> shape;
  for (const Column& axis : result.axes) shape.push_back(static_cast<py::ssize_t>(axis.length()));
  shape.push_back(result.replicates);
  py::dict all;
  all["attributes"] = to_python(attributes);
  all["axes"] = to_python(std::move(result.axes));
  py::list measures;
  for (Column& measure : result.measures) measures.append(to_python(std::move(measure), shape));
  std::vector<std::int32_t> states;
  for (const RunState state : result.state) states.push_back(static_cast<std::int32_t>(state));
  measures.append(to_python(Column{"state",
                                   "1",
                                   "state of the run",
                                   std::move(states),
                                   1,
                                   {"not_sampled", "pending", "done", "failed", "elsewhere"}},
                            shape));
  if (!result.round.empty())
    measures.append(to_python(
        Column{"round", "1", "round of refinement that added the run", std::move(result.round), 1, {}},
        shape));
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
