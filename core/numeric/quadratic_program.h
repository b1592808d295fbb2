// The point nearest to a target among those that fulfil linear inequalities: (6.4) subject to (6.5) in the
// coordinates y = M^(1/2) a_g, where the kinetic distance is the Euclidean one. Dual active set method of
// Goldfarb and Idnani (1983): it starts at the target and adds the row violated most; rows whose multiplier
// would become negative then leave, and may come back. Of fixed size: nothing allocates after construction.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace remote_touch {

enum class ProgramStatus {
  optimal = 0,
  infeasible = 1,  // no point fulfils all rows
  stalled = 2      // gave up after a bounded number of steps, y violates rows; or the target is not finite
};

template <int N>
struct ProgramResult {
  ProgramStatus status = ProgramStatus::optimal;
  Eigen::Matrix<double, N, 1> y = Eigen::Matrix<double, N, 1>::Zero();
  int active_count = 0;       // number of active rows, which hold y: at most N, linearly independent
  int active[N] = {};         // their numbers, counted from 0 in the order of add()
  double multiplier[N] = {};  // 0 or more for each active row: y - target = sum of multiplier x row
  int iterations = 0;         // passes over all rows
};

// min |y - target|^2 / 2 subject to row . y >= bound for every row.
//
// The length of a row does not matter. On optimal, (bound - row . y) / |row| is below 1e-13 times the largest
// coordinate of target and y, apart from the rounding of y itself; so is y's distance from the active rows.
// Rows that differ by less than 1e-8 from a combination of others count as that combination.
template <int N>
class QuadraticProgram {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit QuadraticProgram(int capacity);

  void clear();
  int size() const { return count_; }
  int capacity() const { return capacity_; }
  // Returns false and leaves the row out if it or its bound is not finite, or capacity() is reached. A row of
  // zeros is kept: it has no effect if its bound is 0 or less, and makes the program infeasible if it is
  // above.
  bool add(const Vector& row, double bound);
  // The same for `count` rows at once, with the same bits: coordinate k of row i is column[k][i]. Returns
  // false and adds none if one of them is zero or not finite, too large or small, if size() is odd, or if
  // capacity() is not enough. pre: the columns and bounds are padded to pairs.
  bool add_all(const double* const (&column)[N], const double* bounds, int count);
  // Returns stalled and y = 0 for a target that is not finite, or beyond 1e150. On infeasible, y is the
  // position at which the method found the contradiction, and the rows that held it there are the active
  // ones.
  ProgramResult<N> nearest(const Vector& target) const;

 private:
  struct Violation {
    double distance;  // distance to the row's half space
    int row;
  };
  Violation max_violation(const double* y) const;

  int capacity_, stride_, count_ = 0;
  std::vector<double> rows_;    // unit rows, column after column, each of stride_ = padded capacity
  std::vector<double> bounds_;  // divided by the row's length; minus infinity after the last
  std::vector<double> lengths_;
};

extern template class QuadraticProgram<6>;
extern template class QuadraticProgram<7>;

}  // namespace remote_touch
