#include "core/rendering/surface_velocity.h"

#include <utility>

namespace remote_touch {

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
