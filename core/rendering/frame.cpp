#include "core/rendering/frame.h"

#include <Eigen/Eigenvalues>

namespace remote_touch {

namespace {

// Returns true if the point contributes to the target. A point that was not measured does not, whatever
// weight the rule gives it.
bool counts(const PointCloud& cloud, const std::vector<double>& weights, std::size_t i) {
  return weights[i] > 0 && cloud.is_measured(i);
}

// Returns the weighted scatter matrix about the mean, not divided by the sum of the weights.
Eigen::Matrix3d scatter(const PointCloud& cloud, const std::vector<double>& weights, const Vec3& mean_W) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!counts(cloud, weights, i)) continue;
    const Vec3 d = cloud.point(i) - mean_W;
    sum += weights[i] * (d * d.transpose());
  }
  return sum;
}

Vec3 normal_of(const Eigen::Matrix3d& scatter, const Vec3& to_sensor_W) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);  // smallest first
  const double across = axes.eigenvalues()[0], shorter = axes.eigenvalues()[1],
               longer = axes.eigenvalues()[2];
  constexpr double kFlat = GuidanceTarget::kFlat, kLine = GuidanceTarget::kLine;
  // If the points lie in a line, rounding alone would choose the plane.
  if (!(shorter > kLine * kLine * longer) || across > kFlat * kFlat * shorter) return Vec3::Zero();
  const Vec3 normal = axes.eigenvectors().col(0).normalized();
  return normal.dot(to_sensor_W) < 0 ? Vec3(-normal) : normal;
}

}  // namespace

GuidanceTarget guidance_target(const PointCloud& cloud, const std::vector<double>& weights) {
  GuidanceTarget target;
  Vec3 sum_W = Vec3::Zero();
  double weight = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!counts(cloud, weights, i)) continue;
    ++target.points;
    sum_W += weights[i] * cloud.point(i);
    weight += weights[i];
  }
  if (!target.is_visible()) return target;
  target.mean_W = sum_W / weight;
  const Vec3 sensor_W = cloud.image ? Vec3(cloud.image->X_WC.translation()) : Vec3(Vec3::Zero());
  if (target.points >= 3)
    target.normal_W = normal_of(scatter(cloud, weights, target.mean_W), sensor_W - target.mean_W);
  return target;
}

}  // namespace remote_touch
