#include "core/dissertation/proxy/virtual_coupling.h"

namespace remote_touch {

Vec3 VirtualCoupling::force(const Vec3& u, double since_frame_s, const Vec3& velocity,
                            double stiffness_N_per_m, double ticks) {
  // The surface continues along v_hat between updates, and the proxy would continue with it. The term is
  // subtracted, because u = HIP - P.
  Vec3 u_hat = u;
  if (p_.velocity_force == VelocityForce::minus) u_hat -= since_frame_s * velocity;
  if (p_.velocity_force == VelocityForce::plus) u_hat += since_frame_s * velocity;

  const double length = u_hat.norm();
  const double rate = has_previous_ ? haptic_rate_hz_ * (length - previous_length_) / ticks : 0;
  previous_length_ = length;
  has_previous_ = true;
  if (!(length > p_.contact_radius_m())) return Vec3::Zero();
  const double spring = stiffness_N_per_m * (length - p_.contact_radius_m());
  const double damper = p_.damping_Ns_per_m * rate;
  const double pull = p_.damping_sign == DampingSign::plus ? spring + damper : spring - damper;
  return u_hat * (-pull / length);
}

}  // namespace remote_touch
