// The equations of 4.2 and 5.3 that a proxy P needs of every point x near it, one statement each. The kernels
// of core/kernels/proxy_kernels.h compute them for many points at a time and are tested against this form.
// Number: double or long double. Positions and radii are in m, directions have unit length.
#pragma once

#include <cmath>
#include <optional>

#include "core/points/vector.h"

namespace remote_touch::equations {

template <class Number>
using Vec = Eigen::Matrix<Number, 3, 1>;

// The distance r_n of P to the region of radius r_f around a point, (5.5); r_f is 0 for a bare point.
template <class Number>
Number distance(const Vec<Number>& P, const Vec<Number>& x, Number r_f) {
  return (P - x).norm() - r_f;  // (5.5)
}

// The modified Wendland function psi, (4.2).
template <class Number>
Number weight(Number r, Number r1, Number r3) {
  const Number t = (r - r1) / (r3 - r1);
  return r <= r1 ? 1 : r >= r3 ? 0 : (1 - t) * (1 - t) * (1 - t) * (1 - t) * (4 * t + 1);  // (4.2)
}

// The term of a point in the normal (4.1), with r_n in place of the distance, (5.5). A point at P has no
// direction: its term is zero.
template <class Number>
Vec<Number> normal_term(const Vec<Number>& P, const Vec<Number>& x, Number r_f, Number r1, Number r3) {
  const Number length = (P - x).norm();
  if (!(length > 0)) return Vec<Number>::Zero();
  return (P - x) / length * weight(distance(P, x, r_f), r1, r3);  // (4.1)
}

// The roots d of r_c + r_f = |x - P - d direction|, (4.9), (4.10), (5.9), (5.11).
template <class Number>
struct Roots {
  Number near, far;
};
// Returns nothing if no d reaches the region. The roots lie about the foot of x on the line, because the
// usual formula of a quadratic equation loses half of the digits.
template <class Number>
std::optional<Roots<Number>> roots(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction,
                                   Number radius) {
  const Number foot = (x - P).dot(direction);
  const Number rest = radius * radius - (x - P - foot * direction).squaredNorm();
  if (!(rest >= 0)) return {};
  return Roots<Number>{foot - std::sqrt(rest), foot + std::sqrt(rest)};
}

// Returns how far a free proxy may go before it meets the region: the root of (4.9) ahead of it.
template <class Number>
std::optional<Number> first_hit(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction,
                                Number radius) {
  const auto d = roots(P, x, direction, radius);
  return d && d->near > 0 ? std::optional<Number>(d->near) : std::nullopt;  // (4.9), (5.9)
}

// Returns how far an entrenched proxy has to go until the region, whose inner radius is r1 + r_f, holds it
// at its surface: the larger root of (4.10). 0 if the region does not entrench it.
template <class Number>
Number exit_distance(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction, Number radius,
                     Number inner) {
  const auto d = roots(P, x, direction, radius);
  return d && (P - x).norm() < inner ? d->far : 0;  // (4.10), (5.11)
}

}  // namespace remote_touch::equations
