// Counting sort of items into cells: linear time, and items of one cell keep their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace remote_touch {

// cell_of(i) returns the cell of item i and is called twice for each item; place(i, to) puts item i at
// position `to`. Afterwards the items of cell c are at the positions start[c] to start[c + 1] - 1. start and
// next (a work buffer) have one element more than there are cells.
template <class CellOf, class Place>
void sort_by_cell(std::size_t items, std::span<std::uint32_t> start, std::span<std::uint32_t> next,
                  const CellOf& cell_of, const Place& place) {
  std::fill(start.begin(), start.end(), 0u);
  for (std::size_t i = 0; i < items; ++i) ++start[cell_of(i) + 1];
  for (std::size_t cell = 0; cell + 1 < start.size(); ++cell) start[cell + 1] += start[cell];
  std::copy(start.begin(), start.end(), next.begin());
  for (std::size_t i = 0; i < items; ++i) place(i, next[cell_of(i)]++);
}

}  // namespace remote_touch
