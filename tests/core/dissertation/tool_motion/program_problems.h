// Problems for QuadraticProgram, drawn at random, and the proof that an answer is right.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/core/dissertation/tool_motion/program_peers.h"

namespace remote_touch::programs {

using peers::Problem;
template <int N>
using Vector = peers::Vector<N>;
using Random = std::mt19937_64;

inline double normal(Random& random) {
  return std::normal_distribution<double>()(random);
}
inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline int count_of(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}
template <int N>
Vector<N> vector(Random& random) {
  return Vector<N>::NullaryExpr([&] { return normal(random); });
}

enum class Kind {
  fulfillable,    // random rows around a point that fulfils them
  any,            // random bounds: many have no answer
  vertex,         // all rows through one point
  duplicates,     // rows that come again, longer or shorter
  equalities,     // antiparallel pairs that leave a plane
  contradiction,  // antiparallel pairs that leave nothing
  wedge,          // walls that meet at small angles
  patch,          // contacts (n, r x n) of a tool with a flat or slightly curved surface
  farkas          // one row against a combination of others
};
inline constexpr Kind kKinds[] = {Kind::fulfillable, Kind::any,        Kind::vertex,
                                  Kind::duplicates,  Kind::equalities, Kind::contradiction,
                                  Kind::wedge,       Kind::patch,      Kind::farkas};

template <int N>
Vector<N> contact(Random& random, double curved) {
  const Eigen::Vector3d n = Eigen::Vector3d(curved * normal(random), 1, curved * normal(random)).normalized();
  const Eigen::Vector3d r(between(random, -1, 1), 0.2, between(random, -1, 1));
  Vector<N> row = Vector<N>::Zero();
  row.template head<3>() = n;
  row.template segment<3>(3) = r.cross(n);
  return row;
}

// Returns a random problem of about unit size whose rows have lengths from 1/1000 to 1000.
template <int N>
Problem<N> problem(Kind kind, int count, Random& random) {
  Problem<N> p;
  const Vector<N> middle = 0.5 * vector<N>(random);
  p.target = vector<N>(random);
  const double curved = count_of(random, 0, 1) * 0.05, angle = std::pow(10, between(random, -3, -1));
  const Vector<N> wall = vector<N>(random).normalized();
  while (p.size() < count) {
    Vector<N> row = vector<N>(random);
    double slack = 0;
    switch (kind) {
      case Kind::fulfillable:
      case Kind::duplicates:
        slack = std::abs(normal(random));
        break;
      case Kind::any:
        slack = 1 + normal(random);
        break;
      case Kind::wedge:
        row = (p.size() % 2 == 0 ? 1 : -1) * wall + angle * row;
        slack = 0.1 * angle * std::abs(normal(random));
        break;
      case Kind::patch:
        row = contact<N>(random, curved);
        slack = 0.1 * std::abs(normal(random));
        break;
      default:
        break;
    }
    p.add(row, row.dot(middle) - slack);
    if (kind == Kind::duplicates)
      p.add(row, p.bounds.back()), p.add(3 * row, 3 * p.bounds[p.bounds.size() - 2]);
    if (kind == Kind::equalities && p.size() < N) p.add(-row, -p.bounds.back());
    if (kind == Kind::contradiction && p.size() == 1) p.add(-row, 1e-3 * row.norm() - p.bounds.back());
  }
  if (kind == Kind::farkas) {
    Vector<N> against = Vector<N>::Zero();
    double bound = 1e-3;
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(count, N)); ++i) {
      const double weight = between(random, 0.1, 1);
      against -= weight * p.rows[i], bound -= weight * p.bounds[i];
    }
    p.add(against, bound);
  }
  for (std::size_t i = 0; i < p.rows.size(); ++i) {
    const double length = std::pow(10, between(random, -3, 3));
    p.rows[i] *= length, p.bounds[i] *= length;
  }
  return p;
}

// Checks the conditions of Karush, Kuhn and Tucker, which are necessary and sufficient for the nearest point.
template <int N>
void expect_proof(const Problem<N>& p, const ProgramResult<N>& result) {
  EXPECT_LT(p.violation(result.y), 1e-12);
  ASSERT_LE(result.active_count, N);
  Vector<N> pull = p.target - result.y;
  double max = 1;
  for (int j = 0; j < result.active_count; ++j) {
    const auto i = static_cast<std::size_t>(result.active[j]);
    ASSERT_LT(i, p.rows.size());
    EXPECT_GE(result.multiplier[j], 0);
    EXPECT_LT(std::abs(p.bounds[i] - p.rows[i].dot(result.y)) / p.rows[i].norm(), 1e-12);
    pull += result.multiplier[j] * p.rows[i];
    max = std::max(max, result.multiplier[j] * p.rows[i].norm());
  }
  EXPECT_LT(pull.norm(), 1e-12 * max);
}

}  // namespace remote_touch::programs
