// The penalty method (direct rendering), 2.1.1 of the dissertation, the oldest of the methods with which the
// proxy is compared. It has no proxy: the HIP is the centre of a ball of radius r_c, and a spring pushes it
// out in proportion to the depth of the nearest point in the ball,
//
//   F = k_s (r_c - r_n) n,    r_n = |HIP - x| - r_f of the nearest region (5.5),
//
// along the unit normal n (4.1) of the points within r_3 of the HIP, with the weights of (4.2), r_1 = r_c.
// Damping subtracts k_d times the HIP's velocity along n; the force never pulls.
//
// Known limits, which the comparison should show: n reverses when the HIP passes the points, so that the
// force then pushes to the far side (pop-through). The force is at most k_s r_c. The pattern of the points
// can be felt. dF/dx is k_s only along n, because n itself turns fast when the HIP is near the points.
//
// Outputs: the proxy is the HIP; contact_count is the number of points within r_c; the state is contact if
// r_n < r_c.
#pragma once

#include <string>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

struct PenaltyParameters {
  double contact_radius_m = 0.005;
  double r3_m = 0.01;
  double stiffness_N_per_m = 600;
  double damping_Ns_per_m = 0;
};

Parameters parameters(PenaltyParameters& p);
std::string validate(const PenaltyParameters& p);
inline RenderedContact rendered_contact(const PenaltyParameters& p) {
  return {p.contact_radius_m, p.stiffness_N_per_m};
}

class PenaltyRenderer final : public RivalOf<PenaltyParameters> {
 public:
  // haptic_rate_hz: the rate at which step() is called.
  PenaltyRenderer(const PenaltyParameters& parameters, double haptic_rate_hz, const Kernels& kernels);

 private:
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { has_previous_ = false; }

  double haptic_rate_hz_;
  Vec3 previous_hip_W_ = Vec3::Zero();
  double previous_time_s_ = 0;
  bool has_previous_ = false;
};

}  // namespace remote_touch
