#include "analysis/trace/column.h"

#include <cmath>
#include <stdexcept>

namespace remote_touch {

const std::vector<double>& numbers(const Table& table, const std::string& column) {
  for (const Column& candidate : table.columns)
    if (candidate.name == column) return std::get<std::vector<double>>(candidate.values);
  throw std::out_of_range(table.name + " has no column " + column);
}

double max_of(std::span<const double> values) {
  double max = values.empty() ? std::nan("") : values[0];
  for (const double value : values)
    if (!(value <= max)) max = std::isnan(max) ? max : value;
  return max;
}

}  // namespace remote_touch
