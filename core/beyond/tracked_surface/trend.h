// The curvature of a whole patch. Planes in wide windows would flatten it.
#pragma once

#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// h = c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2.
struct Trend {
  double c[6] = {};

  double height(double u, double v) const {
    return c[0] + u * (c[1] + c[3] * u + c[4] * v) + v * (c[2] + c[5] * v);
  }
  double slope_u(double u, double v) const { return c[1] + 2 * c[3] * u + c[4] * v; }
  double slope_v(double u, double v) const { return c[2] + c[4] * u + 2 * c[5] * v; }
};

// Fits the trend by least squares to the members within kTrendRadius of the origin. The trend is zero if they
// are too few or lie too much to one side. sigma: standard deviation of the noise; the part of the curvature
// that noise explains is removed. The sums are exact, so the order of the points has no effect.
inline constexpr double kTrendRadius = 6;  // contact radii
Trend fit_trend(const PatchPoints& points, double sigma);

}  // namespace remote_touch
