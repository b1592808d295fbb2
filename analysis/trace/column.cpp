#include "analysis/trace/column.h"

#include <stdexcept>

namespace remote_touch {

const std::vector<double>& numbers(const Table& table, const std::string& column) {
  for (const Column& candidate : table.columns)
    if (candidate.name == column) return std::get<std::vector<double>>(candidate.values);
  throw std::out_of_range(table.name + " has no column " + column);
}

}  // namespace remote_touch
