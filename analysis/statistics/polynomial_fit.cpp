#include "analysis/statistics/polynomial_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/statistics/proportion.h"

namespace remote_touch {

namespace {
double power(double x, int exponent) {
  double product = 1;
  for (int i = 0; i < exponent; ++i) product *= x;
  return product;
}

Eigen::VectorXd terms(double x, const std::vector<int>& powers) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(powers.size()));
  for (std::size_t k = 0; k < powers.size(); ++k) row[static_cast<Eigen::Index>(k)] = power(x, powers[k]);
  return row;
}
}  // namespace

double polynomial(const std::vector<double>& coefficients, const std::vector<int>& powers, double x) {
  double sum = 0;
  for (std::size_t k = 0; k < powers.size(); ++k) sum += coefficients[k] * power(x, powers[k]);
  return sum;
}

double PolynomialFit::at(double x) const {
  return polynomial(coefficients, powers, x);
}

double PolynomialFit::half_width(double x) const {
  const auto size = static_cast<Eigen::Index>(powers.size());
  const Eigen::Map<const Eigen::MatrixXd> spread(covariance.data(), size, size);
  const Eigen::VectorXd row = terms(x, powers);
  return kTwoSided95 * std::sqrt(std::max(0.0, row.dot(spread * row)));
}

// The fit is computed in units of the largest x, because powers of small numbers differ by many orders.
PolynomialFit fit_polynomial(const std::vector<double>& x, const std::vector<double>& y,
                             std::vector<int> powers) {
  const auto rows = static_cast<Eigen::Index>(x.size()), columns = static_cast<Eigen::Index>(powers.size());
  double scale = 0;
  for (const double value : x) scale = std::max(scale, std::abs(value));
  Eigen::MatrixXd design(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    design.row(i) = terms(x[static_cast<std::size_t>(i)] / scale, powers);
  const Eigen::Map<const Eigen::VectorXd> observed(y.data(), rows);
  const Eigen::VectorXd scaled = design.colPivHouseholderQr().solve(observed);
  const Eigen::VectorXd residual = observed - design * scaled;

  const Eigen::MatrixXd inverse = (design.transpose() * design).inverse();
  const Eigen::MatrixXd scatter =
      design.transpose() * residual.array().square().matrix().asDiagonal() * design;
  const double correction = static_cast<double>(rows) / static_cast<double>(rows - columns);
  Eigen::MatrixXd spread = correction * inverse * scatter * inverse;
  PolynomialFit fit;
  for (Eigen::Index k = 0; k < columns; ++k) {
    const double unit = 1 / power(scale, powers[static_cast<std::size_t>(k)]);
    fit.coefficients.push_back(scaled[k] * unit);
    spread.row(k) *= unit, spread.col(k) *= unit;
  }
  fit.covariance.assign(spread.data(), spread.data() + spread.size());
  fit.residual_rms = std::sqrt(residual.squaredNorm() / static_cast<double>(rows));
  fit.powers = std::move(powers);
  return fit;
}

}  // namespace remote_touch
