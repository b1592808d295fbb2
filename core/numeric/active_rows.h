// The active rows, which are the rows that the solution of a quadratic program fulfils with equality, and
// their changes: the inner part of the method of Goldfarb and Idnani (1983). This file is for
// quadratic_program.cpp only.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numeric/packed.h"

namespace remote_touch {

// The rounding error of row . y, for a row of unit length and coordinates of y up to 1.
inline constexpr double kRounding = 1e-14;
// A row counts as a linear combination of other rows if the squared length of its component normal to them is
// at most this value.
inline constexpr double kParallelSquared = 1e-16;

// The active rows as the columns of a matrix q R: q is orthonormal, and R is stored as its inverse. The
// columns beyond count are zero, so that all products run over N columns and need no branches.
template <int N>
struct ActiveRows {
  int count = 0;
  int number[N] = {};
  double multiplier[N] = {};
  Square<N> q, inverse;

  // Moves y until it fulfils a row, and makes that row active. The other active rows stay fulfilled with
  // equality, with multipliers of 0 or more. An active row whose multiplier reaches 0 on the way is removed.
  // Returns false if no such y exists.
  bool activate(int row, const Packed<N>& unit_row, double bound, Packed<N>& y) {
    double its_multiplier = 0;
    for (;;) {
      Packed<N> inside = q.transposed_times(unit_row), outside = unit_row;
      outside.add(-1, q.times(inside));
      if (outside.dot(outside) < 0.5) {  // large cancellation; a second pass is enough (Daniel et al. 1976)
        const Packed<N> more = q.transposed_times(outside);
        inside.add(1, more), outside.add(-1, q.times(more));
      }
      const Packed<N> coefficient = inverse.times(inside);  // coefficients of the active rows in unit_row
      const double squared = outside.dot(outside);
      const bool is_free = squared > kParallelSquared;
      double step = is_free ? std::max(0.0, bound - unit_row.dot(y)) / squared
                            : std::numeric_limits<double>::infinity();
      int leaving = -1;
      for (int j = 0; j < count; ++j)
        if (coefficient[j] > kRounding && multiplier[j] < step * coefficient[j])
          step = multiplier[j] / coefficient[j], leaving = j;
      if (!(step < std::numeric_limits<double>::infinity())) return false;
      if (is_free) y.add(step, outside);
      for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, multiplier[j] - step * coefficient[j]);
      its_multiplier += step;
      if (leaving < 0) {
        append(row, its_multiplier, outside, coefficient, 1 / std::sqrt(squared));
        return true;
      }
      remove(leaving);
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

  // Removes the active row at `index`. A reflection turns the basis so that its last direction is the
  // one that only this row needs. That direction is dropped, and the last active row moves to the free index.
  void remove(int index) {
    --count;
    Packed<N> v;
    for (int j = 0; j < N; ++j) v.set(j, inverse.column[j][index]);
    const double length = std::sqrt(v.dot(v)), last = v[count];
    v.set(count, last + std::copysign(length, last));
    const double factor = 1 / (length * (length + std::abs(last)));
    q.reflect(v, factor), inverse.reflect(v, factor);
    q.column[count] = inverse.column[count] = {};
    number[index] = number[count], multiplier[index] = multiplier[count];
    for (int j = 0; j < N; ++j) {
      inverse.column[j].set(index, inverse.column[j][count]);
      inverse.column[j].set(count, 0);
    }
  }

  // Corrects y for its distances to the active rows, which are rounding errors of the steps, and computes the
  // multipliers that belong to the corrected y.
  void settle(const Packed<N>& distance, const Packed<N>& target, Packed<N>& y) {
    y.add(1, q.times(inverse.transposed_times(distance)));
    Packed<N> moved = y;
    moved.add(-1, target);
    const Packed<N> exact = inverse.times(q.transposed_times(moved));
    for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, exact[j]);
  }
};

}  // namespace remote_touch
