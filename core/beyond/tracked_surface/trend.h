// The curvature of a whole patch, which planes in wide windows would flatten.
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

// Least squares through the members within kTrendRadius of the origin; zero where they are too few or lie too
// much to one side. sigma: of the noise; curvature that noise explains is ignored. Sums are exact, so the
// order of the points has no effect.
inline constexpr double kTrendRadius = 6;  // contact radii
Trend fit_trend(const PatchPoints& points, double sigma);

}  // namespace remote_touch
