// Plain solvers for the problems of QuadraticProgram, which share no code with it: the references of its
// tests and benchmarks.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"

namespace remote_touch::peers {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

template <int N>
struct Problem {
  std::vector<Vector<N>> rows;
  std::vector<double> bounds;
  Vector<N> target = Vector<N>::Zero();

  void add(const Vector<N>& row, double bound) { rows.push_back(row), bounds.push_back(bound); }
  int size() const { return static_cast<int>(rows.size()); }
  // Returns the violation of the most violated row, as a distance; minus infinity without rows.
  double violation(const Vector<N>& y) const {
    double worst = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows.size(); ++i)
      worst = std::max(worst, (bounds[i] - rows[i].dot(y)) / rows[i].norm());
    return worst;
  }
  QuadraticProgram<N> program() const {
    QuadraticProgram<N> made(size());
    for (std::size_t i = 0; i < rows.size(); ++i) made.add(rows[i], bounds[i]);
    return made;
  }
};

// Nearest point of a cone, and what happened to the cone's generators.
struct ConePoint {
  Eigen::VectorXd nearest;
  Eigen::VectorXd weight;  // weight of each generator, 0 or more
  int dropped = 0;         // number of times that a generator left
  int returned = 0;        // number of times that one came back
};

// Returns the point of a cone nearest to x (Wilhelmsen 1976). It adds the generator that points most towards
// x, moves to the nearest point of the span of the added ones, and drops those whose weight falls to 0 on the
// way. may_return: a dropped generator may be added again. If it may not, as in published code, the answer
// can be wrong.
inline ConePoint nearest_of_cone(const Eigen::MatrixXd& generators, const Eigen::VectorXd& x,
                                 bool may_return = true) {
  const Eigen::Index count = generators.cols();
  ConePoint cone{Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd::Zero(count)};
  std::vector<char> in(static_cast<std::size_t>(count)), was_dropped(in);
  for (int step = 0; step < 50 + 10 * count; ++step) {
    const Eigen::VectorXd towards = generators.transpose() * (x - cone.nearest);
    Eigen::Index entering = -1;
    double max = 1e-12 * x.norm();
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto k = static_cast<std::size_t>(j);
      if (in[k] || (was_dropped[k] && !may_return) || towards[j] <= max * generators.col(j).norm()) continue;
      max = towards[j] / generators.col(j).norm(), entering = j;
    }
    if (entering < 0) return cone;
    in[static_cast<std::size_t>(entering)] = 1;
    cone.returned += was_dropped[static_cast<std::size_t>(entering)];
    for (;;) {
      std::vector<Eigen::Index> basis;
      for (Eigen::Index j = 0; j < count; ++j)
        if (in[static_cast<std::size_t>(j)]) basis.push_back(j);
      Eigen::VectorXd wanted = Eigen::VectorXd::Zero(count);
      const Eigen::MatrixXd spanning = generators(Eigen::all, basis);
      wanted(basis) = spanning.colPivHouseholderQr().solve(x);
      double fraction = 1;
      for (const Eigen::Index j : basis)
        if (wanted[j] <= 0) fraction = std::min(fraction, cone.weight[j] / (cone.weight[j] - wanted[j]));
      cone.weight += fraction * (wanted - cone.weight);
      if (fraction == 1) break;
      for (const Eigen::Index j : basis) {
        if (cone.weight[j] > 1e-14) continue;
        cone.weight[j] = 0, ++cone.dropped;
        in[static_cast<std::size_t>(j)] = 0, was_dropped[static_cast<std::size_t>(j)] = 1;
      }
    }
    cone.nearest = generators * cone.weight;
  }
  return cone;
}

// Least distance programming (Lawson and Hanson 1974): y - target follows from the point nearest to (0, 1) of
// the cone of the columns (row, bound - row . target). If that point is (0, 1) itself, no y fulfils all rows,
// and its weights are Farkas' proof. gap: distance of the point from (0, 1), in 0 .. 1.
template <int N>
struct LeastDistance {
  double gap;
  Vector<N> y;
};
template <int N>
LeastDistance<N> min_distance(const Problem<N>& problem) {
  Eigen::MatrixXd generators(N + 1, problem.size());
  for (int i = 0; i < problem.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    generators.col(i) << problem.rows[k], problem.bounds[k] - problem.rows[k].dot(problem.target);
    generators.col(i) /= problem.rows[k].norm();
  }
  const Eigen::VectorXd one = Eigen::VectorXd::Unit(N + 1, N);
  const Eigen::VectorXd rest = nearest_of_cone(generators, one).nearest - one;
  return {rest.norm(), problem.target - rest.head(N) / rest[N]};
}

}  // namespace remote_touch::peers
