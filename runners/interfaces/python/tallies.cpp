// A sweep that keeps a tally, as arrays over its axes.
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <limits>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/python/sweep_arrays.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

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

}  // namespace

py::dict to_python(const StoredTally& stored) {
  constexpr std::uint64_t kMaxCells = 10'000'000;
  const SweepTally& tally = stored.tally;
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
  TextAttributes attributes = {{"schema", schema_name("tally")}};
  attributes.insert(attributes.end(), stored.attributes.begin(), stored.attributes.end());
  attributes.emplace_back("digest", digest(tally));
  py::dict all;
  all["kind"] = "tally";
  all["axes"] = to_python(std::vector<Column>(tally.axes));
  all["columns"] = arrays;
  all["attributes"] = to_python(attributes);
  all["warning"] = distrust_of(stored.attributes);
  return all;
}

}  // namespace remote_touch
