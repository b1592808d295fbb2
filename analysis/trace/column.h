// Named columns of numbers or texts with units: the form in which results are stored and read.
#pragma once

#include <cstdint>
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

}  // namespace remote_touch
