#include "runners/presentation/export_formats.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {
namespace {

constexpr const char* kStepDuration = "/timing/step_duration";

Table table_of_trace(const Hdf5Reader& result) {
  const StoredTrace trace(result);
  Table table{"trace", "one row for each tick"};
  for (const std::string& name : trace.column_names()) table.columns.push_back(trace.column(name));
  if (result.has(kStepDuration)) table.columns.push_back(result.column(kStepDuration));
  return table;
}

// Returns a column with the value of each run, from a column with a value for each position on an axis.
template <class PlaceOf>
Column over_runs(const Column& column, std::size_t runs, PlaceOf place_of) {
  Column all = column;
  std::visit(
      [&](auto& values) {
        const auto of_places = values;
        values.clear();
        for (std::size_t run = 0; run < runs; ++run) values.push_back(of_places[place_of(run)]);
      },
      all.values);
  return all;
}

// Returns the kinds of notes on each run, separated by "; ".
std::vector<std::string> notes_of(const SweepResult& result) {
  std::vector<std::string> texts;
  for (const std::uint64_t bits : result.notes) {
    std::string& text = texts.emplace_back();
    for (std::size_t kind = 0; kind < result.note_kinds.size(); ++kind)
      if ((bits >> kind & 1) != 0) text += (text.empty() ? "" : "; ") + result.note_kinds[kind];
  }
  return texts;
}

Table table_of_sweep(const Hdf5Reader& file) {
  const SweepResult result = read_stored_sweep(file).result;
  const std::size_t runs = result.run_count();
  Table table{"sweep", "one row for each run"};
  for (std::size_t axis = 0; axis < result.axes.size(); ++axis)
    table.columns.push_back(over_runs(result.axes[axis], runs, [&](std::size_t run) {
      return result.axis_indices(result.cell_of(run))[axis];
    }));
  if (result.replicates > 1) {
    std::vector<std::int32_t> numbers;
    for (std::size_t run = 0; run < runs; ++run) numbers.push_back(result.replicate_of(run));
    table.columns.push_back({"replicate", "1", "repetition with other noise", std::move(numbers), 1, {}});
  }
  table.columns.push_back(state_column(result));
  table.columns.insert(table.columns.end(), result.measures.begin(), result.measures.end());
  if (!result.round.empty())
    table.columns.push_back({"round", "1", "round of refinement, -1: none", result.round, 1, {}});
  if (!result.notes.empty())
    table.columns.push_back({"notes", "1", "kinds of the notes on the run", notes_of(result), 1, {}});
  table.columns.push_back({"error", "1", "why the run failed", result.error, 1, {}});
  return table;
}

std::vector<Table> tables_of_figure(const Hdf5Reader& result) {
  const StoredFigure figure(result);
  std::vector<Table> tables;
  for (const std::string& path : figure.column_names()) {
    const std::string name = path.substr(0, path.find('/'));
    if (tables.empty() || tables.back().name != name) tables.push_back({name, ""});
    tables.back().columns.push_back(figure.column(path));
  }
  if (tables.empty()) result.damaged("it has no tables");
  return tables;
}

void require_exportable(const Hdf5Reader& result, const Table& table) {
  constexpr int kMaxWidth = 4096;  // each of them gets a name
  if (table.columns.empty()) result.damaged("it names no columns");
  for (const Column& column : table.columns) {
    if (column.length() != table.columns.front().length())
      result.damaged(column.name + " is not as long as " + table.columns.front().name);
    if (column.width > kMaxWidth)
      result.damaged(column.name + " has rows of " + std::to_string(column.width) + " numbers");
  }
}

constexpr std::size_t kRowsAtOnce = 4096;

template <class Number>
void add_number(std::string& line, Number number) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.begin(), text.end(), number);
  line.append(text.begin(), end);
}

Table thinned(Table table, const ExportJob& job) {
  const std::size_t rows = table.columns.front().length();
  std::vector<std::int32_t> ticks;
  for (std::size_t i = 0; i < rows; ++i)
    if (job.keeps(i, rows)) ticks.push_back(static_cast<std::int32_t>(i));
  for (Column& column : table.columns)
    std::visit(
        [&, width = column.width]<class Value>(std::vector<Value>& values) {
          std::vector<Value> kept;
          for (const std::int32_t tick : ticks) {
            const auto row = values.begin() + static_cast<std::ptrdiff_t>(tick) * width;
            kept.insert(kept.end(), row, row + width);
          }
          values = std::move(kept);
        },
        column.values);
  const std::string meaning =
      "number of the tick, from 0; one in " + std::to_string(job.every) + " is kept, and the last one";
  table.columns.insert(table.columns.begin(), {"tick", "1", meaning, std::move(ticks), 1, {}});
  return table;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string inside = text;
  for (std::size_t at = 0; (at = inside.find('"', at)) != std::string::npos; at += 2)
    inside.insert(at, 1, '"');
  return '"' + inside + '"';
}

void add_cell(std::string& line, const Column& column, std::size_t place) {
  const auto add = [&]<class Value>(const std::vector<Value>& values) {
    const Value& value = values[place];
    if constexpr (std::is_same_v<Value, std::string>)
      line += quoted(value);
    else if (std::is_same_v<Value, std::int32_t> &&
             static_cast<std::size_t>(value) < column.value_names.size())
      line += quoted(column.value_names[static_cast<std::size_t>(value)]);  // a negative one is too large
    else if (value != value)
      line += "nan";  // without the sign that to_chars would print
    else
      add_number(line, value);
  };
  std::visit(add, column.values);
}

std::filesystem::path beside(const std::filesystem::path& output, const std::string& name) {
  return output.parent_path() / (output.stem().string() + "_" + name + output.extension().string());
}

std::string lines_of_columns(const Table& table) {
  std::string lines;
  for (const Column& column : table.columns)
    for (const std::string& name : component_names(column))
      lines += quoted(table.name) + ',' + quoted(name) + ',' + quoted(column.units) + ',' +
               quoted(column.long_name) + '\n';
  return lines;
}

}  // namespace

std::string exported_kind(const Hdf5Reader& result) {
  const std::string schema = attribute(result.attributes(), "schema");
  for (const char* kind : {"trace", "sweep", "figure"})
    if (schema.starts_with(std::string("remote-touch-") + kind + "/")) return kind;
  const std::string tally = tally_refusal(result.attributes());
  std::string what = !tally.empty()   ? tally
                     : schema.empty() ? "has no attribute schema"
                                      : "is of schema " + schema;
  throw InputError(result.file(), what + ": expected a trace, a sweep, or a figure of this program");
}

std::vector<Table> result_tables(const Hdf5Reader& result) {
  const std::string kind = exported_kind(result);
  std::vector<Table> tables = kind == "trace"   ? std::vector{table_of_trace(result)}
                              : kind == "sweep" ? std::vector{table_of_sweep(result)}
                                                : tables_of_figure(result);
  for (const Table& table : tables) require_exportable(result, table);
  return tables;
}

std::vector<Table> result_tables(const ExportJob& job) {
  std::vector<Table> tables = result_tables(job.result);
  if (job.every > 1)
    for (Table& table : tables) table = thinned(std::move(table), job);
  return tables;
}

TextAttributes exported_attributes(const Hdf5Reader& result, const std::vector<Table>& tables) {
  TextAttributes all = result.attributes();
  for (auto& [name, value] : all) {
    if (name != "axes") continue;  // of a sweep: its first columns
    std::vector<std::string> names = names_of(tables.front().columns);
    names.resize(std::min(split_names(value).size(), names.size()));
    value = joined(names, ",");
  }
  return all;
}

std::vector<std::string> component_names(const Column& column) {
  if (column.width == 1) return {column.name};
  const std::string known = column.width == 3 ? "xyz" : column.width == 4 ? "wxyz" : "";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < static_cast<std::size_t>(column.width); ++i)
    names.push_back(column.name + "_" + (known.empty() ? std::to_string(i) : std::string(1, known[i])));
  return names;
}

std::string csv_header(const Table& table) {
  std::string line;
  for (const Column& column : table.columns)
    for (const std::string& name : component_names(column)) line += (line.empty() ? "" : ",") + quoted(name);
  return line + '\n';
}

std::string csv_rows(const Table& table, std::size_t first, std::size_t end) {
  std::string lines;
  for (std::size_t row = first; row < end; ++row) {
    for (const Column& column : table.columns) {
      const auto width = static_cast<std::size_t>(column.width);
      for (std::size_t place = row * width; place < (row + 1) * width; ++place) {
        add_cell(lines, column, place);
        lines += ',';
      }
    }
    lines.back() = '\n';
  }
  return lines;
}

void write_csv(const ExportJob& job) {
  write_csv(result_tables(job), job);
}

void write_csv(const std::vector<Table>& tables, const ExportJob& job) {
  for (const Table& table : tables) {
    const std::string header = csv_header(table);
    job.begin(tables.size() == 1 ? job.output : beside(job.output, table.name), header);
    job.files.append(header);
    const std::size_t rows = table.columns.front().length();
    for (std::size_t first = 0; first < rows; first += kRowsAtOnce) {
      job.go_on();
      job.files.append(csv_rows(table, first, std::min(rows, first + kRowsAtOnce)));
    }
  }
  const std::string header = "table,column,unit,meaning\n";
  job.begin(beside(job.output, "columns"), header);
  job.files.append(header);
  for (const Table& table : tables) job.files.append(lines_of_columns(table));
}

}  // namespace remote_touch
