// Force rendering, 4.2.6: a spring and damper between the HIP and the contact point of the proxy.
#pragma once

#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/geometry/vector.h"

namespace remote_touch {

class VirtualCoupling {
 public:
  // haptic_rate_hz is f_h of (4.16).
  VirtualCoupling(const ProxyParameters& parameters, double haptic_rate_hz)
      : p_(parameters), haptic_rate_hz_(haptic_rate_hz) {}

  // Returns the force on the hand by (4.15) and (4.16), N. It points towards the proxy, unless the damper
  // reverses it. It is zero while |u_hat| of (4.15) is at most r_c. u = HIP - P; since_frame_s = t - t_j;
  // velocity = v_hat as a vector; ticks = number of ticks since the last call, more than 1 after missed
  // ticks. The rate in the damper's term is the change of |u_hat| since the last call divided by the time of
  // these ticks.
  Vec3 force(const Vec3& u, double since_frame_s, const Vec3& velocity, double stiffness_N_per_m,
             double ticks = 1);
  // Ends a contact: the next force has a rate of zero, because there is no previous length to compare with.
  void release() { has_previous_ = false; }
  // Sets r1 and r2 of Table 4.2, whose mean is r_c.
  void set_radii(double r1_m, double r2_m) { p_.r1_m = r1_m, p_.r2_m = r2_m; }

 private:
  ProxyParameters p_;
  double haptic_rate_hz_;
  double previous_length_ = 0;
  bool has_previous_ = false;
};

}  // namespace remote_touch
