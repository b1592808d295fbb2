// Runs a sweep, in memory or into a file, and analyses it.
#include <pybind11/stl.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/sweep_arrays.h"
#include "runners/sweep/answer_display.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_answer.h"
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

StoredTally tally_in_file(const Sweep& sweep, const TextAttributes& origin, const std::string& file,
                          const LongWork& work) {
  if (file.empty())
    throw InputError(sweep.title(), "keeps a tally: expected an output, which the runs are added to");
  require_writable(file);
  const FileTurn turn(FileTurn::For::a_sweep);
  TallySession session(sweep, Shard{}, origin, file);
  session.run(work.kernels, &work.stop, [&](std::size_t done, std::size_t all, std::size_t) {
    work.progress(static_cast<double>(done) / static_cast<double>(all));
  });
  return {session.tally(), session.attributes()};
}

py::dict run_sweep_of(const std::string& subject, const std::optional<std::string>& text,
                      const std::vector<std::string>& overrides, int threads, const std::string& output,
                      const py::object& report) {
  StoredSweep stored;
  std::optional<StoredTally> tally;
  do_long_work(report, threads, [&](const LongWork& work) {
    const Sweep sweep = text ? Sweep::from_json(*text, subject, overrides) : Sweep::load(subject, overrides);
    stored.attributes =
        provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", input_hashes(sweep.inputs()));
    if (sweep.keep() != Keep::runs)
      tally = tally_in_file(sweep, stored.attributes, output, work);
    else
      stored.result =
          output.empty() ? in_memory(sweep, work) : in_file(sweep, stored.attributes, output, work);
  });
  return tally ? to_python(*tally) : to_python(std::move(stored));
}

// parts: axes and measures as lists of columns, the states of the runs, the number of replicates, and the
// notes on the runs, which may be missing.
SweepResult result_of(const py::tuple& parts) {
  SweepResult result;
  for (const py::handle& axis : parts[0]) result.axes.push_back(column_of(axis));
  for (const py::handle& measure : parts[1]) result.measures.push_back(column_of(measure));
  for (const auto state : parts[2].cast<std::vector<std::int32_t>>())
    result.state.push_back(static_cast<RunState>(state));
  result.replicates = parts[3].cast<int>();
  result.notes = parts[4].cast<std::vector<std::uint64_t>>();
  bool fits = result.state.size() == result.run_count() &&
              (result.notes.empty() || result.notes.size() == result.run_count());
  for (const Column& measure : result.measures)
    fits &=
        measure.length() == result.run_count() && std::holds_alternative<std::vector<double>>(measure.values);
  if (!fits) throw InputError("the data set", "expected what rt.sweep returned");
  return result;
}

// warning: set to one line if some runs are known to be wrong or are left out.
Figure answer_of(const std::string& file, const SweepQuestion& question, std::string& warning) {
  const FileTurn turn;
  const Hdf5Reader reader(file);
  if (is_tally(reader)) {
    const StoredTally stored = read_tally(reader);
    warning = distrust_of(stored.attributes);
    return sweep_answer(stored.tally, attribute(stored.attributes, "config"), question);
  }
  const StoredSweep stored = read_stored_sweep(reader);
  warning = damage_text(stored);
  return sweep_answer(stored.result, attribute(stored.attributes, "config"), question);
}

// file: of a sweep, or empty for one in memory, which has parts and a configuration.
py::dict analyse(const std::string& file, const py::tuple& parts, const std::string& config,
                 const SweepQuestion& question) {
  Figure answer;
  std::string warning;
  if (file.empty()) {
    const SweepResult result = result_of(parts);
    const py::gil_scoped_release without_lock;
    answer = sweep_answer(result, config, question);
  } else {
    const py::gil_scoped_release without_lock;
    answer = answer_of(file, question, warning);
  }
  std::vector<Column> columns;
  for (const Table& table : answer.tables) {
    if (is_of_curve(answer, table)) continue;
    for (Column column : table.columns) {
      column.name = table.name + "/" + column.name;
      columns.push_back(std::move(column));
    }
  }
  py::dict all;
  all["columns"] = to_python(std::move(columns));
  all["attributes"] = to_python(TextAttributes{{"title", answer.title}, {"caption", answer.caption}});
  all["warning"] = warning;
  return all;
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
  all["kind"] = "sweep";
  all["warning"] = damage_text(stored);
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
  using Names = std::vector<std::string>;
  module.def(
      "analyse",
      [](const std::string& file, const py::tuple& parts, const std::string& config, const std::string& limit,
         const std::string& along, double above, double level, const Names& mean, const Names& by,
         const Names& difference, const std::string& between, const std::string& direction) {
        return analyse(file, parts, config,
                       {limit, along, above, level, mean, by, difference, between, direction});
      },
      py::arg("file"), py::arg("parts"), py::arg("config"), py::arg("limit"), py::arg("along"),
      py::arg("above"), py::arg("level"), py::arg("mean"), py::arg("by"), py::arg("difference"),
      py::arg("between"), py::arg("direction"), "Limits, means and differences of a sweep, as tables.");
}

}  // namespace remote_touch
