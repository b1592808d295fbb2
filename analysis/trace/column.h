// Named columns of numbers or texts with units: the form in which results are stored and read.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace remote_touch {

// The four kinds of columns: numbers; counts and enumerations; hashes; texts.
using Values = std::variant<std::vector<double>, std::vector<std::int32_t>, std::vector<std::uint64_t>,
                            std::vector<std::string>>;

// Has length() * width values, row by row; a vector has width 3. value_names is empty unless the integers are
// the values of an enumeration: then it has their names, from 0 upwards.
struct Column {
  std::string name;
  std::string units;  // SI symbol, "1" for a pure number
  std::string long_name;
  Values values;
  int width = 1;
  std::vector<std::string> value_names = {};

  std::size_t length() const {
    return std::visit([this](const auto& v) { return v.size() / static_cast<std::size_t>(width); }, values);
  }
};

// Columns of equal length, one of which may be plotted against another.
struct Table {
  std::string name;  // a file-safe word
  std::string title;
  std::vector<Column> columns = {};

  // Adds a column of numbers, counts or texts.
  template <class Value = double>
  void add(std::string column, std::string units, std::string long_name, std::vector<Value> values) {
    columns.push_back({std::move(column), std::move(units), std::move(long_name), std::move(values)});
  }
};

std::vector<std::string> names_of(const std::vector<Column>& columns);

// Returns the names in one text. split_names() is the inverse for commas, which separate the names in
// attributes.
std::string joined(const std::vector<std::string>& names, const char* separator);
std::vector<std::string> split_names(const std::string& joined);

// Returns the column of numbers with this name. Throws std::out_of_range if the table has no such column, and
// std::bad_variant_access if the column is not of type double.
const std::vector<double>& numbers(const Table& table, const std::string& column);

// Allowed deviation of a number from the number of a baseline.

// The deviation |candidate - baseline| may be at most absolute + relative * |baseline|. If both are zero, the
// numbers must be equal.
struct Tolerance {
  double absolute = 0;
  double relative = 0;
  bool operator==(const Tolerance&) const = default;
};

// Tolerances by name; "*" applies to all names that are not listed. A name without either has the tolerance
// 0: its numbers must be equal.
using Tolerances = std::map<std::string, Tolerance>;
Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name);

// Returns true if the deviation is allowed. Numbers that are equal by == are allowed (so 0 and -0 are), and
// so is NaN for NaN. NaN or infinity against any other number is outside, whatever the tolerance.
bool within(const Tolerance& tolerance, double baseline, double candidate);

}  // namespace remote_touch
