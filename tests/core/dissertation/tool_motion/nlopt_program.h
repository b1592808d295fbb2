// Solves the same problem with the SLSQP of NLopt.
#pragma once

#include <nlopt.h>

#include "tests/core/dissertation/tool_motion/program_peers.h"

namespace remote_touch::peers {

template <int N>
Vector<N> nlopt_nearest(const Problem<N>& problem, double tolerance = 1e-10) {
  using Map = Eigen::Map<const Vector<N>>;
  const auto distance = [](unsigned, const double* y, double* gradient, void* data) {
    const Vector<N> moved = Map(y) - static_cast<const Problem<N>*>(data)->target;
    if (gradient) Eigen::Map<Vector<N>>{gradient} = moved;
    return 0.5 * moved.squaredNorm();
  };
  const auto rows = [](unsigned count, double* result, unsigned, const double* y, double* gradient,
                       void* data) {
    const auto& p = *static_cast<const Problem<N>*>(data);
    for (std::size_t i = 0; i < count; ++i) {
      result[i] = p.bounds[i] - p.rows[i].dot(Map(y));
      if (gradient) Eigen::Map<Vector<N>>{gradient + N* i} = -p.rows[i];
    }
  };
  Problem<N> copy = problem;
  const nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, N);
  nlopt_set_min_objective(solver, distance, &copy);
  const std::vector<double> slack(problem.rows.size(), 0.0);
  if (problem.size() > 0)
    nlopt_add_inequality_mconstraint(solver, static_cast<unsigned>(problem.size()), rows, &copy,
                                     slack.data());
  nlopt_set_xtol_rel(solver, tolerance);
  nlopt_set_maxeval(solver, 200);
  Vector<N> y = problem.target;
  double min = 0;
  nlopt_optimize(solver, y.data(), &min);
  nlopt_destroy(solver);
  return y;
}

}  // namespace remote_touch::peers
