#include "analysis/sweeps/cell_groups.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

std::vector<CellGroup> cell_groups(const SweepResult& result, const std::vector<std::size_t>& axes) {
  std::size_t count = 1;
  for (const std::size_t axis : axes) count *= result.axes[axis].length();
  std::vector<CellGroup> groups(count);
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const std::vector<std::size_t> places = result.axis_indices(cell);
    std::size_t number = 0;
    for (const std::size_t axis : axes) number = number * result.axes[axis].length() + places[axis];
    CellGroup& group = groups[number];
    if (group.cells.empty())
      for (const std::size_t axis : axes) group.indices.push_back(places[axis]);
    group.cells.push_back(cell);
  }
  return groups;
}

Column axis_at(const Column& axis, const std::vector<std::size_t>& places) {
  Column column = axis;
  std::visit(
      [&](auto& values) {
        auto all = std::move(values);
        values.clear();
        for (const std::size_t place : places) values.push_back(all[place]);
      },
      column.values);
  return column;
}

std::vector<Column> axes_of(const SweepResult& result, const std::vector<std::size_t>& axes,
                            const std::vector<CellGroup>& groups) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    std::vector<std::size_t> places;
    for (const CellGroup& group : groups) places.push_back(group.indices[i]);
    columns.push_back(axis_at(result.axes[axes[i]], places));
  }
  return columns;
}

Values counts_in_column(const std::vector<std::int64_t>& counts) {
  const auto fits = [](std::int64_t count) { return count <= std::numeric_limits<std::int32_t>::max(); };
  if (std::all_of(counts.begin(), counts.end(), fits))
    return std::vector<std::int32_t>(counts.begin(), counts.end());
  return std::vector<double>(counts.begin(), counts.end());
}

}  // namespace remote_touch
