// Computes the point nearest to a target that fulfils linear inequalities: (6.4) subject to (6.5), in the
// coordinates y = M^(1/2) a_g, in which the kinetic distance is the Euclidean one. The dual active set method
// of Goldfarb and Idnani (1983) starts at the target and repeatedly adds the row that is violated most. Rows
// whose multiplier would become negative are removed, and may be added again. The size is fixed: nothing is
// allocated after construction.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace remote_touch {

enum class ProgramStatus {
  optimal = 0,
  infeasible = 1,  // no point fulfils all rows
  stalled = 2      // the step limit was reached, and y violates rows; or the target or y is not finite
};

template <int N>
struct ProgramResult {
  ProgramStatus status = ProgramStatus::optimal;
  Eigen::Matrix<double, N, 1> y = Eigen::Matrix<double, N, 1>::Zero();
  int active_count = 0;       // number of active rows, at most N; they are linearly independent
  int active[N] = {};         // their indices, from 0 in the order of add()
  double multiplier[N] = {};  // 0 or more for each active row: y - target = sum of multiplier x row
  int iterations = 0;         // passes over all rows
};

// Minimises |y - target|^2 / 2 subject to row . y >= bound for every row.
//
// The length of a row does not matter. If the status is optimal, (bound - row . y) / |row| is below 1e-13
// times the largest coordinate of target and y, apart from the rounding of y itself. It may be up to 5e-13
// times that coordinate if rows contradict each other by no more than this. The distance of y from the active
// rows is below 1e-13 times that coordinate. Rows that differ by less than 1e-8 from a combination of active
// rows count as that combination.
template <int N>
class QuadraticProgram {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit QuadraticProgram(int capacity);

  void clear();
  int size() const { return count_; }
  int capacity() const { return capacity_; }
  // Returns false and does not add the row if it or its bound is not finite, or if capacity() is reached. A
  // row of zeros is accepted: it has no effect if its bound is 0 or less, and makes the program infeasible if
  // its bound is positive.
  bool add(const Vector& row, double bound);
  // The same for `count` rows at once, with the same bits: coordinate k of row i is column[k][i]. Returns
  // false and adds no row if one of them is zero, not finite, too large or too small, if size() is odd, or if
  // capacity() is not enough. pre: the columns and bounds are readable up to the next even number of rows.
  bool add_all(const double* const (&column)[N], const double* bounds, int count);
  // Returns stalled and y = 0 for a target that is not finite or has a coordinate above 1e150. If the status
  // is infeasible, y is the position at which the method found the contradiction, and the active rows are
  // those at that position.
  ProgramResult<N> nearest(const Vector& target) const;

 private:
  struct Violation {
    double distance;  // distance to the row's half space
    int row;
  };
  Violation max_violation(const double* y) const;

  int capacity_, stride_, count_ = 0;
  std::vector<double> rows_;    // unit rows, stored column by column; stride_ is the padded capacity
  std::vector<double> bounds_;  // divided by the row's length; minus infinity after the last
  std::vector<double> lengths_;
};

extern template class QuadraticProgram<6>;
extern template class QuadraticProgram<7>;

}  // namespace remote_touch
