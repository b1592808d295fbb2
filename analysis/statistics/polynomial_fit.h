// Least squares with chosen powers, and its confidence interval.
#pragma once

#include <utility>
#include <vector>

namespace remote_touch {

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

}  // namespace remote_touch
