#include "core/tracked_sheet/trend.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kTerms = 6, kPlane = 3;  // of the quadratic; the first of them are its plane

// Cholesky; false where the matrix is not safely positive. Solves in place.
bool solve(double a[kTerms][kTerms], double b[kTerms]) {
  constexpr double kLeastShare = 1e-4;  // of a diagonal element that may be left
  for (int i = 0; i < kTerms; ++i) {
    const double own = a[i][i];
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i != j)
        a[i][j] = sum / a[j][j];
      else if (sum > kLeastShare * own && own > 0)
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

// By how much the curvature betters the fit, in units of the noise's variance, is a chi square of 3 degrees
// of freedom where there is none: then nothing of it is kept (James and Stein's rule). a: the factor.
double share_to_keep(const double a[kTerms][kTerms], const double c[kTerms], double sigma) {
  constexpr double kOfChance = 6;
  double betters = 0;
  for (int j = kPlane; j < kTerms; ++j) {
    double term = 0;
    for (int i = j; i < kTerms; ++i) term += a[i][j] * c[i];
    betters += term * term;
  }
  return std::max(0.0, 1 - kOfChance * sigma * sigma / std::max(betters, 1e-12));
}

}  // namespace

Trend fit_trend(const PatchPoints& points, double sigma) {
  constexpr double kFewest = 30;
  // Powers u^a v^b with a + b <= 4, and h times those with a + b <= 2.
  // Factors are multiples of 2^-12 below 2^6, so sums of up to 2^17 of their products are exact.
  double power[5][5] = {}, with_h[3][3] = {};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PatchPlace& p = points.place[i];
    if (!points.member[i] || p.u * p.u + p.v * p.v > kTrendRadius * kTrendRadius) continue;
    const double uu = PatchFrame::rounded(p.u * p.u), uv = PatchFrame::rounded(p.u * p.v),
                 vv = PatchFrame::rounded(p.v * p.v);
    power[0][0] += 1, power[1][0] += p.u, power[0][1] += p.v;
    power[2][0] += uu, power[1][1] += uv, power[0][2] += vv;
    power[3][0] += uu * p.u, power[2][1] += uu * p.v, power[1][2] += vv * p.u, power[0][3] += vv * p.v;
    power[4][0] += uu * uu, power[3][1] += uu * uv, power[2][2] += uu * vv, power[1][3] += uv * vv,
        power[0][4] += vv * vv;
    with_h[0][0] += p.h, with_h[1][0] += p.u * p.h, with_h[0][1] += p.v * p.h;
    with_h[2][0] += uu * p.h, with_h[1][1] += uv * p.h, with_h[0][2] += vv * p.h;
  }
  Trend trend;
  if (power[0][0] < kFewest) return trend;
  constexpr int of_u[kTerms] = {0, 1, 0, 2, 1, 0}, of_v[kTerms] = {0, 0, 1, 0, 1, 2};
  double a[kTerms][kTerms], b[kTerms];
  for (int i = 0; i < kTerms; ++i) {
    b[i] = with_h[of_u[i]][of_v[i]];
    for (int j = 0; j < kTerms; ++j) a[i][j] = power[of_u[i] + of_u[j]][of_v[i] + of_v[j]];
  }
  if (!solve(a, b)) return trend;
  const double keep = share_to_keep(a, b, sigma);
  for (int i = 0; i < kTerms; ++i) trend.c[i] = i < kPlane ? b[i] : keep * b[i];
  return trend;
}

}  // namespace remote_touch
