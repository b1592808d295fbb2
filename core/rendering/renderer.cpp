#include "core/rendering/renderer.h"

#include <Eigen/Eigenvalues>
#include <utility>

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

bool FrameOrder::is_newer(const Frame& frame) const {
  return index_ < 0 || frame.captured_s > captured_s_;
}

bool FrameOrder::accept_if_newer(const Frame& frame) {
  if (!is_newer(frame)) {
    dropped_ = true;
    return false;
  }
  index_ = frame.index, captured_s_ = frame.captured_s;
  return true;
}

Vec3 SurfaceVelocity::on_frame(double captured_s, const Vec3& normal) {
  const double since = has_frame_ ? captured_s - captured_s_ : 0;
  const double carried = velocity_m_per_s_ * std::min(since, max_interval_s_);
  interval_s_ = awaits_step_ ? interval_s_ + since : since;
  frame_correction_m_ = awaits_step_ ? frame_correction_m_ + carried : carried;
  captured_s_ = captured_s;
  has_frame_ = true;
  normal_ = normal;
  awaits_step_ = interval_s_ > 0;
  set_horizon();
  return carried * normal_;  // (4.3)
}

// Updates the estimate. If (4.3) was not bounded, this is (4.13), v_hat + n.s / interval. If it was bounded,
// the motion of the surface is the distance that the proxy was carried plus the step. The growth of a region
// is subtracted from the motion in both cases.
void SurfaceVelocity::on_step(const Vec3& step) {
  if (!awaits_step_) return;
  awaits_step_ = false;
  const double moved_m = frame_correction_m_ + normal_.dot(step) - std::exchange(growth_m_, 0);
  velocity_m_per_s_ = std::max(0.0, moved_m / interval_s_);  // (4.13)
}

void SurfaceVelocity::set_horizon() {
  horizon_s_ = std::max(max_interval_s_, usual_interval_.without_pause(interval_s_));
  usual_interval_.add(interval_s_);
}

void SurfaceVelocity::on_measured(double captured_s, double velocity_m_per_s, const Vec3& normal) {
  interval_s_ = has_frame_ ? captured_s - captured_s_ : 0;
  captured_s_ = captured_s;
  has_frame_ = true;
  awaits_step_ = false;
  velocity_m_per_s_ = velocity_m_per_s;
  normal_ = normal;
  set_horizon();
}

}  // namespace remote_touch
