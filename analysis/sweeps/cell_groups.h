// The cells of a sweep that have the same values on some of its axes.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

struct CellGroup {
  std::vector<std::size_t> indices;  // the index on each axis that the group has in common
  std::vector<std::size_t> cells;    // increasing
};

// Returns the groups over the axes with these numbers, the last of them running fastest. Without axes there
// is one group of all cells.
std::vector<CellGroup> cell_groups(const SweepResult& result, const std::vector<std::size_t>& axes);

// Returns the axis as a column of a table: its value at the given index in each row.
Column axis_at(const Column& axis, const std::vector<std::size_t>& places);
// Returns one such column for each of the axes: the values that the groups have in common.
std::vector<Column> axes_of(const SweepResult& result, const std::vector<std::size_t>& axes,
                            const std::vector<CellGroup>& groups);

// Returns the values of a column of counts: integers or, if one of them is above 2^31 - 1, doubles.
Values counts_in_column(const std::vector<std::int64_t>& counts);

}  // namespace remote_touch
