#include "analysis/measures/curve_fits.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "analysis/measures/interval_estimates.h"

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

std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double mean, weight;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean < pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& joined = pools.back();
      const double weight = joined.weight + last.weight;
      joined = {(joined.mean * joined.weight + last.mean * last.weight) / weight, weight,
                joined.count + last.count};
    }
  }
  std::vector<double> falling;
  for (const Pool& pool : pools) falling.insert(falling.end(), pool.count, pool.mean);
  return falling;
}

double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level) {
  constexpr double kEqual = 1e-12;  // a pooled share may miss the level by a rounding
  std::size_t above = 0, not_below = 0;
  for (const double value : falling) {
    above += value > level + kEqual ? 1 : 0;
    not_below += value >= level - kEqual ? 1 : 0;
  }
  if (not_below > above) return 0.5 * (x[above] + x[not_below - 1]);
  if (above == 0) return x.front();
  if (above == x.size()) return x.back();
  const double from = falling[above - 1], to = falling[above];
  return x[above - 1] + (x[above] - x[above - 1]) * (from - level) / (from - to);
}

Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNaN, kNaN};
  double with_cosine = 0, with_sine = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle_rad = 2 * std::numbers::pi * hz * time_s[i];
    with_cosine += values[i] * std::cos(angle_rad);
    with_sine += values[i] * std::sin(angle_rad);
  }
  const double half_count = 0.5 * static_cast<double>(values.size());
  return {std::hypot(with_cosine, with_sine) / half_count, std::atan2(-with_sine, with_cosine)};
}

double lag_s(const Sinusoid& first, const Sinusoid& second, double hz) {
  const double turn_rad = 2 * std::numbers::pi;
  return std::remainder(first.phase_rad - second.phase_rad, turn_rad) / (turn_rad * hz);
}

}  // namespace remote_touch
