// Columns of numbers or texts with units, tables of them, the deviations that are allowed, and hashes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/points/point_cloud.h"

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

// Allowed deviation of a number from the number of a baseline. The deviation |candidate - baseline| may be at
// most absolute + relative * |baseline|. If both are zero, the numbers must be equal.
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

// Cheap 64-bit hashes of the points of a frame, and of a run up to each tick. They show whether two frames or
// runs are equal, or at which tick two runs first differ; the chance of an error is 1 in 1.8e19. Only the
// SHA-256 of the file detects deliberate changes.

// One step of a chain: multiplication by the odd constant of the golden ratio, high bits folded onto low
// ones. The result is equal on every machine, and in every language with 64-bit integers that wrap around.
constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

inline constexpr const char* kRunningHash = "tick_hash";  // the trace column that holds it

// Hash of the number of points and of every coordinate, fixture radius, stiffness and normal of the cloud. It
// does not depend on the order of the points, which each search chooses.
std::uint64_t points_hash(const PointCloud& cloud);

// Returns the running hash of columns of equal length. Row i holds hash_i = mixed(hash_(i-1), r_i), where r_i
// is the chain over the words of row i of every column in turn. Both chains begin with 0. The word of a
// double is its bits, with -0 as 0 and every NaN as 0x7ff8000000000000, so that equal rows have equal hashes.
// The word of an integer is the sign-extended integer. Texts are ignored.
// The hashes of two runs are equal up to the first tick at which anything differs, and different from there
// on. Bisection therefore finds that tick from about log2(ticks) hashes of each run.
std::vector<std::uint64_t> running_hash(const std::vector<Column>& columns);

}  // namespace remote_touch
