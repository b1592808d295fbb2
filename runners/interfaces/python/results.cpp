// Reads stored results, compares two of them, and describes everything that has a name.
#include <pybind11/stl.h>

#include <cstdio>
#include <cstdlib>

#include "analysis/comparison/compared_columns.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/comparison_report.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/descriptions/descriptions.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/sweep_arrays.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

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
  StoredSweep sweep;
  StoredTally tally;
  {
    const py::gil_scoped_release without_lock;
    const FileTurn turn;
    const Hdf5Reader reader(file);
    kind = is_tally(reader) ? "tally" : kind_of(reader);
    attributes = present_attributes(reader.attributes());
    if (kind == "sweep") sweep = read_stored_sweep(reader);
    if (kind == "tally") tally = read_tally(reader);
    if (kind == "trace") columns = all_columns(StoredTrace(reader));
    if (kind == "figure") columns = all_columns(StoredFigure(reader));
  }
  if (kind == "hashes") throw InputError(file, "is a file of hashes: expected a trace, a sweep or a figure");
  if (kind == "tally") return to_python(tally);
  if (kind != "sweep") return as_dict(kind.c_str(), std::move(columns), attributes);
  return to_python(std::move(sweep));
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
  return py::make_tuple(static_cast<int>(comparison.outcome),
                        printed([&](std::FILE* out) { print_comparison(comparison, out); }),
                        comparison_json(comparison));
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

std::string printed(const std::function<void(std::FILE*)>& print) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* out = ::open_memstream(&text, &size);
  if (out == nullptr) throw std::bad_alloc();
  try {
    print(out);
  } catch (...) {
    std::fclose(out), std::free(text);
    throw;
  }
  std::fclose(out);
  const std::string all(text, size);
  std::free(text);
  return all;
}

void bind_results(py::module_& module) {
  module.def("open", &open_result, py::arg("file"), "Reads a trace, a sweep or a figure.");
  module.def("compare_files", &compare_files, py::arg("baseline"), py::arg("candidate"),
             py::arg("tolerances"), py::arg("paired"), "Exit code, text and JSON of a comparison.");
  module.def("compare_columns", &compare_traces_given, py::arg("baseline"), py::arg("baseline_attributes"),
             py::arg("candidate"), py::arg("candidate_attributes"), py::arg("tolerances"),
             "The same of two traces in memory.");
  module.def(
      "describe",
      [](const std::string& name) { return printed([&](std::FILE* out) { describe(name, out); }); },
      py::arg("name"), "All that has the name, as text.");
  module.def("list", &list_names, "Names and summaries by kind.");
  module.def("version", &version, "Returns the version of the program.");
}

}  // namespace remote_touch
