#include "core/rivals/thinnest_axis.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

// The number of sweeps. Each sweep squares the rest of the off-diagonal elements, so four or five are enough.
constexpr int kSweeps = 8;
// An element smaller than this fraction of the trace counts as zero.
constexpr double kNothing = 1e-20;

// Rotates in the plane of the axes p and q so that a(p, q) vanishes (Golub and Van Loan, 8.5.2). Returns
// false if a(p, q) is zero already.
bool rotate(Eigen::Matrix3d& a, Eigen::Matrix3d& axes, int p, int q, double nothing) {
  if (std::abs(a(p, q)) <= nothing) return false;
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double pr = a(p, r), qr = a(q, r);
  a(p, p) -= t * a(p, q), a(q, q) += t * a(p, q);
  a(p, q) = a(q, p) = 0;
  a(p, r) = a(r, p) = c * pr - s * qr;
  a(q, r) = a(r, q) = s * pr + c * qr;
  for (int i = 0; i < 3; ++i) {
    const double vp = axes(i, p), vq = axes(i, q);
    axes(i, p) = c * vp - s * vq, axes(i, q) = s * vp + c * vq;
  }
  return true;
}

}  // namespace

ThinnestAxis thinnest_axis(const Eigen::Matrix3d& symmetric) {
  Eigen::Matrix3d a = symmetric, axes = Eigen::Matrix3d::Identity();
  const double nothing = kNothing * std::abs(a.trace());
  bool turned = true;
  for (int sweep = 0; turned && sweep < kSweeps; ++sweep) {
    turned = rotate(a, axes, 0, 1, nothing);
    turned |= rotate(a, axes, 0, 2, nothing);
    turned |= rotate(a, axes, 1, 2, nothing);
  }
  int min = 0;
  for (int i = 1; i < 3; ++i)
    if (a(i, i) < a(min, min)) min = i;
  const double others[] = {a((min + 1) % 3, (min + 1) % 3), a((min + 2) % 3, (min + 2) % 3)};
  return {axes.col(min), a(min, min), std::min(others[0], others[1])};
}

}  // namespace remote_touch
