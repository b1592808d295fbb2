#include "core/beyond/tracked_surface/trend.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kTerms = 6, kPlane = 3;  // number of terms; the first kPlane are those of a plane

// Solves a x = b in place by Cholesky's method. Returns false if the matrix is not clearly positive definite.
bool solve(double a[kTerms][kTerms], double b[kTerms]) {
  constexpr double kMinFraction = 1e-4;  // smallest fraction of a diagonal element that may be left
  for (int i = 0; i < kTerms; ++i) {
    const double own = a[i][i];
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i != j)
        a[i][j] = sum / a[j][j];
      else if (sum > kMinFraction * own && own > 0)
        a[i][i] = std::sqrt(sum);
      else
        return false;
    }
  }
  for (int i = 0; i < kTerms; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = kTerms - 1; i >= 0; --i) {
    for (int k = i + 1; k < kTerms; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

// Returns the fraction of the curvature to keep (James and Stein's rule). The improvement of the fit by the
// curvature, in units of the noise's variance, is a chi square of 3 degrees of freedom if there is no
// curvature. No curvature is kept if the improvement is below kOfChance. a: the Cholesky factor.
double fraction_to_keep(const double a[kTerms][kTerms], const double c[kTerms], double sigma) {
  constexpr double kOfChance = 6;
  double improvement = 0;
  for (int j = kPlane; j < kTerms; ++j) {
    double term = 0;
    for (int i = j; i < kTerms; ++i) term += a[i][j] * c[i];
    improvement += term * term;
  }
  return std::max(0.0, 1 - kOfChance * sigma * sigma / std::max(improvement, 1e-12));
}

}  // namespace

Trend fit_trend(const PatchPoints& points, double sigma) {
  constexpr double kMinPoints = 30;
  // The factors are multiples of 2^-12 below 2^6, so sums of up to 2^17 of their products are exact.
  const QuadraticSums sums = points.sums_of_quadratic(kTrendRadius);
  Trend trend;
  if (sums.power[0] < kMinPoints) return trend;
  // Degrees of u and v in each term. Products of the same degree are stored one after the other, in falling
  // powers of u.
  constexpr int of_u[kTerms] = {0, 1, 0, 2, 1, 0}, of_v[kTerms] = {0, 0, 1, 0, 1, 2};
  double a[kTerms][kTerms], b[kTerms];
  for (int i = 0; i < kTerms; ++i) {
    b[i] = sums.with_h[i];
    for (int j = 0; j < kTerms; ++j) {
      const int v = of_v[i] + of_v[j], degree = of_u[i] + of_u[j] + v;
      a[i][j] = sums.power[degree * (degree + 1) / 2 + v];
    }
  }
  if (!solve(a, b)) return trend;
  const double keep = fraction_to_keep(a, b, sigma);
  for (int i = 0; i < kTerms; ++i) trend.c[i] = i < kPlane ? b[i] : keep * b[i];
  return trend;
}

}  // namespace remote_touch
