#include "core/surface_velocity.h"

#include <algorithm>

namespace remote_touch {

Vec3 SurfaceVelocity::on_frame(double captured_s, const Vec3& normal) {
  interval_s_ = has_frame_ ? std::min(captured_s - captured_s_, longest_interval_s_) : 0;
  captured_s_ = captured_s;
  has_frame_ = true;
  normal_ = normal;
  awaits_step_ = interval_s_ > 0;
  return (velocity_m_per_s_ * interval_s_) * normal_;
}

void SurfaceVelocity::on_step(const Vec3& step) {
  if (!awaits_step_) return;
  awaits_step_ = false;
  velocity_m_per_s_ = std::max(0.0, velocity_m_per_s_ + normal_.dot(step) / interval_s_);
}

}  // namespace remote_touch
