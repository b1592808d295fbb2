// The quantities of 4.4 at each update of a cloud that moves along a known normal.
#pragma once

#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

struct Trace;

// Update j, when frame j replaces frame j - 1. Metres, seconds; heights are along the true normal n.
struct LiftUpdate {
  int frame = 0;                  // j
  double velocity_m_per_s = 0;    // v_j: how far the plane moved, times f_c
  double estimate_m_per_s = 0;    // v_hat_j, with which (4.3) moves the proxy
  double thickness_m = 0;         // h_{j-1} = (P - plane).n - r_1 at the end of frame j - 1
  double normal_error = 0;        // e_n = 1 - n.n_hat_{k-1}, (4.22)
  double frame_correction_m = 0;  // v_hat_j n.n_hat_{k-1} / f_c: how far (4.3) moved the proxy along n
  bool above_before = false;      // the proxy's centre was above the plane at the end of frame j - 1
  bool above_after = false;       // and at the end of frame j

  // r_1 + h_{j-1} + frame_correction - v_j / f_c, the margin of (4.17) and (4.18): below 0 the criterion
  // predicts a pop-through. It is the height of the corrected proxy over the new plane.
  double margin_m(double r1_m, double frame_rate_hz) const {
    return r1_m + thickness_m + frame_correction_m - velocity_m_per_s / frame_rate_hz;
  }
};

// Returns every update in the trace after the first frame. pre: signed_distance is that to the newest frame's
// plane.
std::vector<LiftUpdate> lift_updates(const Trace& trace, const Vec3& normal, double r1_m,
                                     double frame_rate_hz);

}  // namespace remote_touch
