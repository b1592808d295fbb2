// Columns of numbers: sorted into cells in linear time, aligned to cache lines, and their quantiles.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

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

// Columns of numbers that begin at a cache line, so that a vector of a whole line is read from one line.

inline constexpr std::size_t kLineBytes = 64;

template <class T>
struct WholeLines {
  using value_type = T;  // NOLINT(readability-identifier-naming): the name that the standard library has

  WholeLines() = default;
  template <class Other>
  explicit(false) WholeLines(const WholeLines<Other>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kLineBytes}));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete (memory, std::align_val_t{kLineBytes}); }
  template <class Other>
  bool operator==(const WholeLines<Other>&) const {
    return true;
  }
};

template <class T>
using LineVector = std::vector<T, WholeLines<T>>;

// Quantiles and medians that are values of the sample, without interpolation.

// Returns the quantile: the value with index floor(fraction * n), counted from 0, among the n sorted values.
// Changes the order of the values. pre: none is NaN.
inline double quantile_in_place(std::span<double> values, double fraction) {
  assert(!values.empty() && fraction >= 0 && fraction < 1);
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// The same for fraction 0.5. If the number of values is even, the result is the upper one of the two in the
// middle.
inline double median_in_place(std::span<double> values) {
  return quantile_in_place(values, 0.5);
}

}  // namespace remote_touch
