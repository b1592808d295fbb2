#include "runners/experiment/hand/force_trace_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/number_columns.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

constexpr double kMaxCoordinateInFile_m = 100;

const std::vector<ColumnQuantity>& quantities() {
  using Unit = ColumnQuantity::Unit;
  static const std::vector<ColumnQuantity> all = {{{"time", "t"}, Unit::time}, {{"x", "px"}, Unit::length},
                                                  {{"y", "py"}, Unit::length}, {{"z", "pz"}, Unit::length},
                                                  {{"fx"}, Unit::force},       {{"fy"}, Unit::force},
                                                  {{"fz"}, Unit::force}};
  return all;
}

NumberColumns columns_named(const std::string& where, const std::vector<std::string_view>& names) {
  NumberColumns columns(where, {names.begin(), names.end()}, quantities());
  for (std::size_t i = 0; i < quantities().size(); ++i)
    if (!columns.has(i))
      refuse(where, "no column ", std::string(quantities()[i].names.front()),
             ": expected time, x, y, z, fx, fy and fz, each with its unit (_s, _ms, _m, _mm, _N) or without");
  return columns;
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t\v\f\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::vector<std::string_view> fields_of_line(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

ForceTraceRow row_of(const std::string& where, const std::vector<std::string_view>& fields,
                     const NumberColumns& columns) {
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = columns.value(where, fields, i);
    if (!std::isfinite(values[i])) columns.refuse_number(where, fields, i);
  }
  return {values[0], {values[1], values[2], values[3]}, {values[4], values[5], values[6]}};
}

class TraceReader {
 public:
  TraceReader(const std::filesystem::path& file, const std::string& traj_columns)
      : file_(file), is_csv_(has_ending(file, ".csv")) {
    if (!is_csv_) columns_ = columns_named("trajectory.columns", words_of_line(traj_columns));
    has_columns_ = !is_csv_;
  }

  void add(std::size_t number, std::string_view line) {
    const std::string where = file_.string() + ":" + std::to_string(number);
    const std::vector<std::string_view> fields = is_csv_ ? fields_of_line(line) : words_of_line(line);
    if (!has_columns_) {
      columns_ = columns_named(where, fields);
      has_columns_ = true;
      return;
    }
    check_count(where, fields.size());
    const ForceTraceRow row = row_of(where, fields, columns_);
    if (!trace_.rows.empty() && !(row.time_s > trace_.rows.back().time_s))
      refuse(where, "time ", row.time_s, " s: expected above that of the row before, ",
             trace_.rows.back().time_s, " s");
    if (row.contact_m.cwiseAbs().maxCoeff() > kMaxCoordinateInFile_m)
      refuse(where,
             "a position more than 100 m from the origin: expected metres, or columns x_mm, y_mm, z_mm");
    trace_.rows.push_back(row);
  }

  ForceTrace take() {
    if (trace_.rows.size() < 2)
      refuse(file_.string(), "has ", trace_.rows.size(), " row(s): expected 2 or more");
    trace_.unused = columns_.unused();
    trace_.states_length = columns_.states_unit(1);
    for (std::size_t i = columns_.count(); i < most_fields_; ++i)
      trace_.unused.push_back("column " + std::to_string(i + 1));
    return std::move(trace_);
  }

 private:
  void check_count(const std::string& where, std::size_t fields) {
    const std::size_t expected = columns_.count();
    if (fields < expected || (is_csv_ && fields > expected))
      refuse(where, fields, " values: expected ", expected, is_csv_ ? "" : " or more");
    most_fields_ = std::max(most_fields_, fields);
  }

  const std::filesystem::path file_;
  const bool is_csv_;
  bool has_columns_ = false;
  NumberColumns columns_;
  ForceTrace trace_;
  std::size_t most_fields_ = 0;
};

}  // namespace

ForceTrace read_force_trace(const std::filesystem::path& file, const std::string& traj_columns) {
  if (!has_ending(file, ".csv") && !has_ending(file, ".traj"))
    refuse(file.string(), "expected a file that ends in .csv or .traj");
  const std::string text = read_input_text(file, "expected rows of time, position and force");
  TraceReader reader(file, traj_columns);
  for_each_line(without_byte_order_mark(text), [&](std::size_t number, std::string_view untrimmed) {
    const std::string_view line = trimmed(untrimmed);
    if (!line.empty() && line[0] != '#' && line[0] != '%') reader.add(number, line);
  });
  return reader.take();
}

}  // namespace remote_touch
