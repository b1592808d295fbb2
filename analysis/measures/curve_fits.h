// Curves and waves that are fitted to noisy values.
#pragma once

#include <utility>
#include <vector>

namespace remote_touch {

// Least squares with chosen powers, and its confidence interval.

// Returns the sum of c_k x^power_k. It multiplies instead of calling pow(), whose last bit depends on the C
// library. pre: powers >= 0.
double polynomial(const std::vector<double>& coefficients, const std::vector<int>& powers, double x);

struct PolynomialFit {
  std::vector<int> powers;
  std::vector<double> coefficients;
  std::vector<double> covariance;  // covariance matrix of the coefficients, row by row
  double residual_rms = 0;

  double at(double x) const;
  // Half the width of the 95 % confidence interval of the fitted curve at x.
  double half_width(double x) const;
};

// Fits sum of c_k x^power_k to independent observations. The covariance allows observations of different
// variance (White 1980, HC1). pre: more observations than powers, and enough different x.
PolynomialFit fit_polynomial(const std::vector<double>& x, const std::vector<double>& y,
                             std::vector<int> powers);

// A decreasing curve from noisy values.

// Returns the decreasing values nearest to the given ones by weighted least squares (pool adjacent
// violators). Equal neighbours count as decreasing.
std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights);

// Returns the x at which a decreasing curve over increasing x crosses the level, by linear interpolation: the
// first x if the curve starts below the level, the last x if it ends above. Where the curve equals the level
// over several x (within 1e-12 of it), this is the middle between the first and the last of them: another
// choice would be wrong for the mirrored curve.
double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level);

// The part of a signal that has a given frequency.

struct Sinusoid {
  double amplitude = 0;
  double phase_rad = 0;  // phi in amplitude * cos(2 pi f t + phi), from -pi to pi
};

// Returns the sinusoid of frequency hz that is nearest to the values by least squares, beside their mean:
// the Fourier coefficient at that frequency. NaN if there are no values. Pre: as many times as values, which
// are evenly spaced and cover whole periods.
Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz);

// Returns by how much the second sinusoid lags behind the first, from -1 / (2 hz) to 1 / (2 hz).
double lag_s(const Sinusoid& first, const Sinusoid& second, double hz);

}  // namespace remote_touch
