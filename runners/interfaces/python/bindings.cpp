#include "runners/interfaces/python/bindings.h"

#include <pybind11/stl.h>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/presentation/descriptions.h"

namespace remote_touch {

// Reads stored results, compares two of them, and describes everything that has a name.

namespace py = pybind11;

namespace {

std::vector<Column> all_columns(const ColumnSource& source) {
  std::vector<Column> list;
  for (const std::string& name : source.column_names()) {
    list.push_back(source.column(name));
    list.back().name = name;  // the name in a figure includes its table
  }
  return list;
}

py::dict as_dict(const char* kind, std::vector<Column> columns, const TextAttributes& attributes) {
  py::dict all;
  all["kind"] = kind;
  all["columns"] = to_python(std::move(columns));
  all["attributes"] = to_python(attributes);
  return all;
}

py::dict open_result(const std::string& file) {
  std::string kind;
  std::vector<Column> columns;
  TextAttributes attributes;
  std::optional<KeptSweep> sweep;
  {
    const py::gil_scoped_release without_lock;
    const FileTurn turn;
    const Hdf5Reader reader(file);
    kind = is_tally(reader) ? "tally" : kind_of(reader);
    attributes = reader.attributes();
    if (kind == "sweep" || kind == "tally") sweep = read_kept_sweep(file, Extent::whole);
    if (kind == "trace") columns = all_columns(StoredTrace(reader));
    if (kind == "figure") columns = all_columns(StoredFigure(reader));
  }
  if (kind == "hashes") throw InputError(file, "is a file of hashes: expected a trace, a sweep or a figure");
  if (sweep) return to_python(std::move(*sweep));
  return as_dict(kind.c_str(), std::move(columns), attributes);
}

Tolerances tolerances_of(const py::dict& given) {
  Tolerances all;
  for (const auto& [name, pair] : given) {
    const auto [absolute, relative] = pair.cast<std::pair<double, double>>();
    all[name.cast<std::string>()] = {absolute, relative};
  }
  return all;
}

// Returns the exit code of the outcome, the text that the command prints, and its report as JSON.
py::tuple as_tuple(const ResultComparison& comparison) {
  const Report report = report_of(comparison);
  return py::make_tuple(static_cast<int>(comparison.outcome), report.text(), report.json());
}

py::tuple compare_files(const std::string& baseline, const std::string& candidate, const py::dict& tolerances,
                        bool paired) {
  ComparisonRules rules;
  rules.tolerances = tolerances_of(tolerances), rules.paired = paired;
  ResultComparison comparison;
  {
    const py::gil_scoped_release without_lock;
    const FileTurn turn;
    comparison = compare_results(baseline, candidate, rules);
  }
  return as_tuple(comparison);
}

// Compares two traces in memory, each given as a list of columns and a list of attributes.
py::tuple compare_traces_given(const py::list& baseline, const TextAttributes& baseline_attributes,
                               const py::list& candidate, const TextAttributes& candidate_attributes,
                               const py::dict& tolerances) {
  const auto in_memory = [](const py::list& list) {
    std::vector<Column> columns;
    for (const py::handle& column : list) columns.push_back(column_of(column));
    return ColumnsInMemory(std::move(columns));
  };
  ComparisonRules rules;
  rules.tolerances = tolerances_of(tolerances);
  ResultComparison comparison = compare_trace(in_memory(baseline), baseline_attributes, in_memory(candidate),
                                              candidate_attributes, rules);
  comparison.baseline = "the first data set", comparison.candidate = "the second data set";
  return as_tuple(comparison);
}

py::dict list_names() {
  py::dict all;
  for (const NamedKind& kind : named_kinds()) {
    py::dict rows;
    for (const NamedKind::Row& row : kind.rows) rows[py::str(row.name)] = row.summary;
    all[py::str(kind.kind)] = rows;
  }
  return all;
}

}  // namespace

void bind_results(py::module_& module) {
  module.def("open", &open_result, py::arg("file"), "Reads a trace, a sweep or a figure.");
  module.def("compare_files", &compare_files, py::arg("baseline"), py::arg("candidate"),
             py::arg("tolerances"), py::arg("paired"), "Exit code, text and JSON of a comparison.");
  module.def("compare_columns", &compare_traces_given, py::arg("baseline"), py::arg("baseline_attributes"),
             py::arg("candidate"), py::arg("candidate_attributes"), py::arg("tolerances"),
             "The same of two traces in memory.");
  module.def("describe", &described, py::arg("name"), "All that has the name, as text.");
  module.def("list", &list_names, "Names and summaries by kind.");
  module.def("version", &version, "Returns the version of the program.");
}

namespace {

// A sweep that keeps a tally, as arrays over its axes.

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <class Number, class Of>
Column over_cells(const SweepTally& tally, Column column, Number without_runs, const Of& of) {
  std::vector<Number> values(tally.cell_count(), without_runs);
  for (std::size_t i = 0; i < tally.cells.size(); ++i) values[tally.cells[i]] = of(tally.tallies[i]);
  column.values = std::move(values);
  return column;
}

void add_counts(const SweepTally& tally, std::vector<Column>& columns) {
  using Count = std::uint64_t;
  columns.push_back(over_cells<Count>(tally, {"runs", "1", "number of runs that were made", {}}, 0,
                                      [](const CellTally& cell) { return static_cast<Count>(cell.runs()); }));
  columns.push_back(over_cells<Count>(tally, {"failed", "1", "number of runs that failed", {}}, 0,
                                      [](const CellTally& cell) { return static_cast<Count>(cell.failed); }));
}

void add_measure(const SweepTally& tally, std::size_t measure, std::vector<Column>& columns) {
  const Column& about = tally.measures[measure];
  columns.push_back(over_cells<std::uint64_t>(
      tally, {about.name + "_values", "1", "number of finite values of " + about.name, {}}, 0,
      [&](const CellTally& cell) { return static_cast<std::uint64_t>(cell.measures[measure].values); }));
  struct Statistic {
    const char* name;
    double (*of)(const MeasureTally&);
  };
  const std::array<Statistic, 4> statistics{
      Statistic{"mean", [](const MeasureTally& of) { return of.mean(); }},
      Statistic{"standard_deviation", [](const MeasureTally& of) { return of.standard_deviation(); }},
      Statistic{"least", [](const MeasureTally& of) { return of.values > 0 ? of.least : kUnknown; }},
      Statistic{"greatest", [](const MeasureTally& of) { return of.values > 0 ? of.greatest : kUnknown; }}};
  for (const Statistic& statistic : statistics)
    columns.push_back(over_cells<double>(
        tally, {about.name + "_" + statistic.name, about.units, about.long_name, {}}, kUnknown,
        [&](const CellTally& cell) { return statistic.of(cell.measures[measure]); }));
}

py::dict as_dict(SweepTally& tally) {
  constexpr std::uint64_t kMaxCells = 10'000'000;
  if (tally.cell_count() > kMaxCells)
    throw InputError("the tally", "has " + std::to_string(tally.cell_count()) + " cells: expected at most " +
                                      std::to_string(kMaxCells) + " as arrays");
  std::vector<Column> columns;
  add_counts(tally, columns);
  for (std::size_t i = 0; i < tally.measures.size(); ++i) add_measure(tally, i, columns);
  std::vector<py::ssize_t> shape;
  for (const Column& axis : tally.axes) shape.push_back(static_cast<py::ssize_t>(axis.length()));
  py::list arrays;
  for (Column& column : columns) arrays.append(to_python(std::move(column), shape));
  py::dict all;
  all["kind"] = "tally";
  all["columns"] = arrays;
  return all;
}

py::dict as_dict(SweepResult& result) {
  std::vector<py::ssize_t> shape;
  for (const Column& axis : result.axes) shape.push_back(static_cast<py::ssize_t>(axis.length()));
  shape.push_back(result.replicates);
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
  py::dict all;
  all["kind"] = "sweep";
  all["measures"] = measures;
  all["error"] = py::cast(result.error);
  all["replicates"] = result.replicates;
  return all;
}

}  // namespace

py::dict to_python(KeptSweep stored) {
  const bool has_runs = std::holds_alternative<SweepResult>(stored.kept);
  TextAttributes attributes = {{"schema", schema_name(has_runs ? "sweep" : "tally")}};
  attributes.insert(attributes.end(), stored.attributes.begin(), stored.attributes.end());
  attributes.emplace_back("digest", std::visit([](const auto& kept) { return digest(kept); }, stored.kept));
  if (const auto& kinds = stored.grid().note_kinds; has_runs && !kinds.empty())
    attributes.emplace_back("note_kinds", joined(kinds, ","));
  py::dict all = std::visit([](auto& kept) { return as_dict(kept); }, stored.kept);
  all["axes"] = to_python(std::vector<Column>(stored.grid().axes));
  all["attributes"] = to_python(attributes);
  all["warning"] = stored.warning;
  return all;
}

namespace {

// Scorecards: methods compared on many scenes.

using Texts = std::vector<std::string>;

struct FailedRuns {
  std::size_t count = 0;
  std::string first;  // "SCENE.METHOD: the error"
};

FailedRuns failed_runs(const std::vector<BenchmarkSweep>& sweeps) {
  FailedRuns failed;
  for (const BenchmarkSweep& each : sweeps) {
    const SweepResult result = read_sweep(each.file).result;
    const std::vector<std::size_t> runs = result.runs_in(RunState::failed);
    if (failed.count == 0 && !runs.empty()) failed.first = each.name + ": " + result.error[runs.front()];
    failed.count += runs.size();
  }
  return failed;
}

// Writes scorecard.h5 and scorecard.json into the folder.
FailedRuns make_scorecard(const Texts& methods, const Texts& scenes, int seeds,
                          const std::filesystem::path& folder, const LongWork& work) {
  const BenchmarkPlan plan = plan_of(chosen_benchmark(methods, scenes, seeds, folder.string()));
  const std::vector<BenchmarkSweep> sweeps = plan.sweeps();
  const FileTurn turn(FileTurn::For::a_sweep);
  require_same_benchmark(sweeps);
  require_all_of(folder / kScorecardFile, plan);
  make_scorecard_folder(folder.string());
  do_sweeps(sweeps, work.kernels, &work.stop, [&](std::size_t done, std::size_t all, double fraction) {
    work.progress((static_cast<double>(done) + fraction) / static_cast<double>(all + 1));
  });
  const ScorecardReport report = evaluate(plan, work.kernels, &work.stop, [](std::size_t, std::size_t) {});
  write_scorecard(folder, plan, report, scorecard_command(methods, scenes, seeds));
  return failed_runs(sweeps);
}

py::tuple scorecard(const Texts& methods, const Texts& scenes, int seeds, int threads,
                    const std::string& folder, const py::object& report) {
  FailedRuns failed;
  do_long_work(report, threads,
               [&](const LongWork& work) { failed = make_scorecard(methods, scenes, seeds, folder, work); });
  return py::make_tuple(failed.count, failed.first);
}

}  // namespace

void bind_scorecards(py::module_& module) {
  module.def("scorecard", &scorecard, py::arg("methods"), py::arg("scenes"), py::arg("seeds"),
             py::arg("threads"), py::arg("folder"), py::arg("report"),
             "Makes a scorecard in a folder; how many runs failed, and how the first one did.");
}

}  // namespace remote_touch
