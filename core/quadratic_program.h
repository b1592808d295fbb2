// The point nearest to a target among those that fulfil linear inequalities: (6.4) subject to (6.5) in the
// coordinates y = M^(1/2) a_g, where the kinetic distance is the Euclidean one. Dual active set method of
// Goldfarb and Idnani (1983). Of fixed size: nothing allocates after construction.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace remote_touch {

enum class ProgramStatus {
  optimal = 0,
  infeasible = 1,  // no point fulfils all rows
  stalled = 2      // gave up after a bounded number of steps; y violates rows
};

template <int N>
struct ProgramResult {
  ProgramStatus status = ProgramStatus::optimal;
  Eigen::Matrix<double, N, 1> y = Eigen::Matrix<double, N, 1>::Zero();
  int active_count = 0;       // rows that hold y, at most N
  int active[N] = {};         // their numbers, in the order of add()
  double multiplier[N] = {};  // of each, 0 or more: y - target = sum of multiplier x row
  int iterations = 0;
};

// min |y - target|^2 / 2 subject to row . y >= bound for every row.
template <int N>
class QuadraticProgram {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit QuadraticProgram(int capacity);

  void clear() { count_ = 0; }
  int size() const { return count_; }
  int capacity() const { return capacity_; }
  // Returns false and leaves the row out where it or its bound is not finite, or there is no room.
  bool add(const Vector& row, double bound);
  // A target that is not finite is answered with stalled and y = 0. On infeasible, y is where the method
  // found the contradiction.
  ProgramResult<N> nearest(const Vector& target) const;

 private:
  int capacity_, count_ = 0;
  std::vector<double> rows_;  // column after column, each of padded capacity
  std::vector<double> bounds_;
};

extern template class QuadraticProgram<6>;
extern template class QuadraticProgram<7>;

}  // namespace remote_touch
