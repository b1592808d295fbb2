#include "runners/experiment/hand/force_trace_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

constexpr double kMaxCoordinateInFile_m = 100;
constexpr const char* kBlanks = " \t\v\f\r";

struct Unit {
  const char* suffix;
  double in_si;
};
struct Quantity {
  const char *name, *other_name;
  std::array<Unit, 2> units;
};
constexpr std::array<Unit, 2> kTime = {{{"s", 1}, {"ms", 1e-3}}};
constexpr std::array<Unit, 2> kLength = {{{"m", 1}, {"mm", 1e-3}}};
constexpr std::array<Unit, 2> kForce = {{{"n", 1}, {"n", 1}}};
constexpr std::array<Quantity, 7> kQuantities = {{{"time", "t", kTime},
                                                  {"x", "px", kLength},
                                                  {"y", "py", kLength},
                                                  {"z", "pz", kLength},
                                                  {"fx", "fx", kForce},
                                                  {"fy", "fy", kForce},
                                                  {"fz", "fz", kForce}}};

// The column of each quantity, and the value of its unit in SI units.
struct Columns {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::array<std::size_t, kQuantities.size()> index{};
  std::array<double, kQuantities.size()> unit{};
  std::vector<std::string> names;  // names of all columns, as the file has them
  std::vector<std::string> unused;
};

std::string in_small_letters(std::string_view name) {
  std::string small(name);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

struct NamedQuantity {
  std::size_t index;  // index in kQuantities
  double unit;        // size of its unit in SI units
};
// Returns nothing if the name, in small letters, is not that of a quantity with one of its units or without a
// unit.
std::optional<NamedQuantity> quantity_named(const std::string& name) {
  for (std::size_t i = 0; i < kQuantities.size(); ++i)
    for (const char* base : {kQuantities[i].name, kQuantities[i].other_name}) {
      if (name == base) return NamedQuantity{i, 1};
      for (const Unit& unit : kQuantities[i].units)
        if (name == std::string(base) + "_" + unit.suffix) return NamedQuantity{i, unit.in_si};
    }
  return std::nullopt;
}

void add_column(const std::string& where, std::string_view name, Columns& columns) {
  columns.names.emplace_back(name);
  const std::optional<NamedQuantity> found = quantity_named(in_small_letters(name));
  if (!found) {
    columns.unused.emplace_back(name);
    return;
  }
  if (columns.index[found->index] != Columns::kNone)
    refuse(where, "column ", std::string(name), ": expected one column of ", kQuantities[found->index].name);
  columns.index[found->index] = columns.names.size() - 1;
  columns.unit[found->index] = found->unit;
}

Columns columns_named(const std::string& where, const std::vector<std::string_view>& names) {
  Columns columns;
  columns.index.fill(Columns::kNone);
  for (const std::string_view name : names) add_column(where, name, columns);
  for (std::size_t i = 0; i < kQuantities.size(); ++i)
    if (columns.index[i] == Columns::kNone)
      refuse(where, "no column ", kQuantities[i].name,
             ": expected time, x, y, z, fx, fy and fz, each with its unit (_s, _ms, _m, _mm, _N) or without");
  return columns;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::vector<std::string_view> words_of_line(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t end = 0;;) {
    const std::size_t begin = line.find_first_not_of(kBlanks, end);
    if (begin == std::string_view::npos) return words;
    end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
  }
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

// std::from_chars does not accept a plus sign.
double number_of(const std::string& where, std::string_view text, const std::string& column) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const std::string_view digits = has_plus ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse(where, "'", std::string(text.substr(0, 32)), "' in column ", column, ": expected a number");
  return value;
}

ForceTraceRow row_of(const std::string& where, const std::vector<std::string_view>& fields,
                     const Columns& columns) {
  std::array<double, kQuantities.size()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t column = columns.index[i];
    values[i] = columns.unit[i] * number_of(where, fields[column], columns.names[column]);
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
    trace_.unused = columns_.unused;
    for (std::size_t i = columns_.names.size(); i < most_fields_; ++i)
      trace_.unused.push_back("column " + std::to_string(i + 1));
    return std::move(trace_);
  }

 private:
  void check_count(const std::string& where, std::size_t fields) {
    const std::size_t expected = columns_.names.size();
    if (fields < expected || (is_csv_ && fields > expected))
      refuse(where, fields, " values: expected ", expected, is_csv_ ? "" : " or more");
    most_fields_ = std::max(most_fields_, fields);
  }

  const std::filesystem::path file_;
  const bool is_csv_;
  bool has_columns_ = false;
  Columns columns_;
  ForceTrace trace_;
  std::size_t most_fields_ = 0;
};

}  // namespace

ForceTrace read_force_trace(const std::filesystem::path& file, const std::string& traj_columns) {
  if (!has_ending(file, ".csv") && !has_ending(file, ".traj"))
    refuse(file.string(), "expected a file that ends in .csv or .traj");
  const std::string text = read_input_text(file, "expected rows of time, position and force");
  TraceReader reader(file, traj_columns);
  std::string_view rest = without_byte_order_mark(text);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.empty() && line[0] != '#' && line[0] != '%') reader.add(number, line);
  }
  return reader.take();
}

}  // namespace remote_touch
