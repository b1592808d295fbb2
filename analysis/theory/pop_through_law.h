// A law for the acceleration at which half of the lifts of 4.3.2 pop through. It extends (4.14), the limit
// without noise, r_1 f_c^2, to the spacing of the points and to noise. It is of this project, and empirical
// in the noise.
#pragma once

#include <cmath>
#include <vector>

namespace remote_touch {

// All members are pure numbers: spacing and noise in contact radii r_c, accelerations in r_c f_c^2.
struct LimitPoint {
  double spacing = 0;  // distance of the points in a square grid
  double noise = 0;    // standard deviation of each coordinate of a point
  double limit = 0;    // acceleration at which half of the lifts pop through
};

// limit = (1 - s^2 / 2)^(1/2) + (gain - loss s) sigma, for a spacing s and noise sigma. The first term is the
// height at which the proxy rests in the middle of four points (first_touch.h); without noise (4.14) holds
// with this height in place of r_1. gain and loss are fitted.
struct PopThroughLaw {
  double gain = 0, loss = 0;

  static double without_noise(double spacing) { return std::sqrt(1 - spacing * spacing / 2); }
  double limit(double spacing, double noise) const {
    return without_noise(spacing) + (gain - loss * spacing) * noise;
  }
  // The spacing at which noise does not change the limit.
  double neutral_spacing() const { return gain / loss; }
};

// Returns the law with the least sum of squared residuals. pre: at least two points with noise, of different
// spacings.
PopThroughLaw fitted_law(const std::vector<LimitPoint>& points);

// Root mean square of the measured limits minus those of the law. pre: there is a point.
double rms_residual(const PopThroughLaw& law, const std::vector<LimitPoint>& points);

}  // namespace remote_touch
