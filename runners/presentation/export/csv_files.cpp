#include "runners/presentation/export/csv_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "runners/presentation/export/result_tables.h"

namespace remote_touch {

namespace {

constexpr std::size_t kRowsAtOnce = 4096;

template <class Number>
void add_number(std::string& line, Number number) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.begin(), text.end(), number);
  line.append(text.begin(), end);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string inside = text;
  for (std::size_t at = 0; (at = inside.find('"', at)) != std::string::npos; at += 2)
    inside.insert(at, 1, '"');
  return '"' + inside + '"';
}

struct Cell {
  std::string& line;
  const Column& column;
  std::size_t place;

  void operator()(const std::vector<double>& values) const {
    const double value = values[place];
    if (std::isnan(value))
      line += "nan";  // without the sign that to_chars would print
    else
      add_number(line, value);
  }
  void operator()(const std::vector<std::int32_t>& values) const {
    const auto name = static_cast<std::size_t>(values[place]);
    if (values[place] >= 0 && name < column.value_names.size())
      line += quoted(column.value_names[name]);
    else
      add_number(line, values[place]);
  }
  void operator()(const std::vector<std::uint64_t>& values) const { add_number(line, values[place]); }
  void operator()(const std::vector<std::string>& values) const { line += quoted(values[place]); }
};

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
        std::visit(Cell{lines, column, place}, column.values);
        lines += ',';
      }
    }
    lines.back() = '\n';
  }
  return lines;
}

void write_csv(const ExportJob& job) {
  write_csv(result_tables(job.result), job);
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
