#include "analysis/theory/pop_through_law.h"

#include <Eigen/Dense>
#include <cmath>

namespace remote_touch {

PopThroughLaw fitted_law(const std::vector<LimitPoint>& points) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixX2d terms(rows, 2);
  Eigen::VectorXd changes(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LimitPoint& point = points[static_cast<std::size_t>(i)];
    terms.row(i) << point.noise, -point.spacing * point.noise;
    changes[i] = point.limit - PopThroughLaw::without_noise(point.spacing);
  }
  const Eigen::Vector2d law = terms.colPivHouseholderQr().solve(changes);
  return {law[0], law[1]};
}

double rms_residual(const PopThroughLaw& law, const std::vector<LimitPoint>& points) {
  double sum = 0;
  for (const LimitPoint& point : points) {
    const double residual = point.limit - law.limit(point.spacing, point.noise);
    sum += residual * residual;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace remote_touch
