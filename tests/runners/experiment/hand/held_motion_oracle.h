// An oracle for the motion of a mass under a held force: matrix exponentials in long double. It shares no
// code and no formula with HeldForceStep.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace remote_touch::oracle {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the oracle must be finer than a double");

// State: x, x', the path p, p', and the force per mass. The motion is linear in the state.
using State = Eigen::Matrix<Real, 5, 1>;
using Matrix = Eigen::Matrix<Real, 5, 5>;

struct System {
  double mass = 1, stiffness = 0, path_damping = 0, ground_damping = 0;
};

inline Matrix generator(const System& s) {
  const Real m = s.mass;
  Matrix a = Matrix::Zero();
  a(0, 1) = a(2, 3) = 1;
  a(1, 0) = -s.stiffness / m, a(1, 2) = s.stiffness / m;
  a(1, 1) = -(static_cast<Real>(s.path_damping) + s.ground_damping) / m, a(1, 3) = s.path_damping / m;
  a(1, 4) = 1;
  return a;
}

// Returns E = exp(A t) - 1, which keeps the digits of slow motions beside fast ones. Doubling: exp(2 A t) - 1
// = 2 E + E^2.
inline Matrix exponential_less_one(const Matrix& generator, Real t) {
  Matrix a = generator * t;
  int doublings = 0;
  while (a.cwiseAbs().maxCoeff() > 1 / Real(64)) a /= 2, ++doublings;
  Matrix e = Matrix::Zero(), term = Matrix::Identity();
  for (int n = 1; n <= 16; ++n) {
    term = (term * a / n).eval();
    e += term;
  }
  for (; doublings > 0; --doublings) e = (2 * e + e * e).eval();
  return e;
}

inline State change(const System& system, const State& start, Real t) {
  return exponential_less_one(generator(system), t) * start;
}

inline State after(const System& system, const State& start, Real t) {
  return start + change(system, start, t);
}

// Returns the integral of (q . state)^2 from 0 to t. It begins with Gauss-Legendre quadrature over a time in
// which the state hardly changes, and then doubles the time: G(2 t) = G(t) + exp(A t)^T G(t) exp(A t).
inline Real square_integral(const System& system, const State& start, const State& q, Real t) {
  const Matrix a = generator(system);
  int doublings = 0;
  Real short_time = t;
  while ((a * short_time).cwiseAbs().maxCoeff() > 1 / Real(64)) short_time /= 2, ++doublings;
  const Real node[] = {0.1834346424956498049L, 0.5255324099163289858L, 0.7966664774136267396L,
                       0.9602898564975362317L};
  const Real weight[] = {0.3626837833783619830L, 0.3137066458778872873L, 0.2223810344533744705L,
                         0.1012285362903762592L};
  Matrix sum = Matrix::Zero();
  for (int i = 0; i < 4; ++i)
    for (const int side : {-1, 1}) {
      const Real at = short_time * (1 + side * node[i]) / 2;
      const State row = q + exponential_less_one(a, at).transpose() * q;
      sum += weight[i] * short_time / 2 * row * row.transpose();
    }
  for (Real now = short_time; doublings > 0; --doublings, now *= 2) {
    const Matrix all = exponential_less_one(a, now) + Matrix::Identity();
    sum = (sum + all.transpose() * sum * all).eval();
  }
  return start.dot(sum * start);
}

// Returns the largest absolute eigenvalue of a square matrix, by repeated squaring.
template <class Square>
double spectral_radius(Square a) {
  double log_norm = 0;
  double power = 1;
  for (int i = 0; i < 60; ++i) {
    const double norm = a.norm();
    if (norm == 0) return 0;
    log_norm += std::log(norm) / power;
    a = (a / norm * (a / norm)).eval();
    power *= 2;
  }
  return std::exp(log_norm);
}

}  // namespace remote_touch::oracle
