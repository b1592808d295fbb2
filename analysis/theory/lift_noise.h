// The effect of noise on the quantities of 4.4, measured over lifts without acceleration.
#pragma once

#include <vector>

#include "analysis/theory/lift_updates.h"
#include "analysis/theory/pop_through_bound.h"

namespace remote_touch {

// Updates up to this frame are not used, because the velocity estimate starts at 0 when the cloud meets the
// proxy.
struct SettledFrom {
  int frame = 0;
};

// Computes means and scatter over the updates of all lifts of one noise strength before which the proxy was
// still above the plane. The means are NaN without such an update, the scatter and the gain with fewer than
// two.
NoiseEffect noise_effect(const std::vector<std::vector<LiftUpdate>>& lifts, SettledFrom settled, double r1_m,
                         double frame_rate_hz);

// Means of one lift: one observation, independent of other lifts. NaN if no update counts.
struct LiftMeans {
  double thickness_m, normal_error;
};
LiftMeans lift_means(const std::vector<LiftUpdate>& lift, SettledFrom settled);

}  // namespace remote_touch
