// The active rows, which hold the solution of a quadratic program, and their changes: the inner part of the
// method of Goldfarb and Idnani (1983). Used by quadratic_program.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numeric/packed.h"

namespace remote_touch {

// Rows have unit length. Rounding error of row . y for coordinates of y up to 1:
inline constexpr double kRounding = 1e-14;
// A row is a combination of others if the square of its part outside of them is below:
inline constexpr double kParallelSquared = 1e-16;

// The rows that hold y, as the columns of q R: q is orthonormal, and R is kept as its inverse. Columns beyond
// count are zero, so that products run over all N and have no branches.
template <int N>
struct ActiveRows {
  int count = 0;
  int number[N] = {};
  double multiplier[N] = {};
  Square<N> q, inverse;

  // Moves y until it fulfils a row, with the rows that hold y tight and their multipliers at 0 or above: a
  // row whose multiplier reaches 0 on the way is removed. Returns false if no such y exists.
  bool take_in(int row, const Packed<N>& unit_row, double bound, Packed<N>& y) {
    double its_multiplier = 0;
    for (;;) {
      Packed<N> inside = q.transposed_times(unit_row), outside = unit_row;
      outside.add(-1, q.times(inside));
      if (outside.dot(outside) < 0.5) {  // much has cancelled; twice is enough (Daniel et al. 1976)
        const Packed<N> more = q.transposed_times(outside);
        inside.add(1, more), outside.add(-1, q.times(more));
      }
      const Packed<N> coefficient = inverse.times(inside);  // in unit_row, of each row that holds y
      const double squared = outside.dot(outside);
      const bool is_free = squared > kParallelSquared;
      double step = is_free ? std::max(0.0, bound - unit_row.dot(y)) / squared
                            : std::numeric_limits<double>::infinity();
      int leaves = -1;
      for (int j = 0; j < count; ++j)
        if (coefficient[j] > kRounding && multiplier[j] < step * coefficient[j])
          step = multiplier[j] / coefficient[j], leaves = j;
      if (!(step < std::numeric_limits<double>::infinity())) return false;
      if (is_free) y.add(step, outside);
      for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, multiplier[j] - step * coefficient[j]);
      its_multiplier += step;
      if (leaves < 0) {
        append(row, its_multiplier, outside, coefficient, 1 / std::sqrt(squared));
        return true;
      }
      remove(leaves);
    }
  }

  void append(int row, double its_multiplier, const Packed<N>& outside, const Packed<N>& coefficient,
              double scale) {
    number[count] = row, multiplier[count] = its_multiplier;
    q.column[count].add(scale, outside);
    inverse.column[count].add(-scale, coefficient);
    inverse.column[count].set(count, scale);
    ++count;
  }

  // A reflection turns the basis until its last direction is the one that this row alone needs.
  void remove(int gone) {
    --count;
    Packed<N> v;
    for (int j = 0; j < N; ++j) v.set(j, inverse.column[j][gone]);
    const double length = std::sqrt(v.dot(v)), last = v[count];
    v.set(count, last + std::copysign(length, last));
    const double factor = 1 / (length * (length + std::abs(last)));
    q.reflect(v, factor), inverse.reflect(v, factor);
    q.column[count] = inverse.column[count] = {};
    number[gone] = number[count], multiplier[gone] = multiplier[count];
    for (int j = 0; j < N; ++j) {
      inverse.column[j].set(gone, inverse.column[j][count]);
      inverse.column[j].set(count, 0);
    }
  }

  // Removes the distances of y to the rows that hold it, which are rounding of the steps, and computes the
  // multipliers that belong to y.
  void settle(const Packed<N>& distance, const Packed<N>& target, Packed<N>& y) {
    y.add(1, q.times(inverse.transposed_times(distance)));
    Packed<N> moved = y;
    moved.add(-1, target);
    const Packed<N> exact = inverse.times(q.transposed_times(moved));
    for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, exact[j]);
  }
};

}  // namespace remote_touch
