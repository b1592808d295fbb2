// The variations of a run that the relations use. Each changes the scene and the expected outputs, and
// returns false if it does not apply to the scene or the renderer.
#pragma once

#include "runners/evaluation/verification/variation.h"

namespace remote_touch::vary {

bool repeat(Variation& run);  // changes nothing
bool other_instructions(Variation& run);

// The points.
bool search_all_points(Variation& run);
bool use_other_grid(Variation& run);
bool shuffle(Variation& run);
bool add_missing(Variation& run);
bool add_far(Variation& run);
bool add_radius_column(Variation& run);           // column of zeros
bool add_empty_stiffness_column(Variation& run);  // column of NaN: a point has the renderer's stiffness
bool add_stiffness_column(Variation& run);

// Space, time and force.
bool mirror_axis(Variation& run, int axis);
template <int kAxis>
bool mirror(Variation& run) {
  return mirror_axis(run, kAxis);
}
bool move(Variation& run);
// Change of size at equal stiffness: forces grow with lengths, so values in N/m and Ns/m do not change. The
// factor is a fraction.
template <int kNumerator, int kDenominator = 1>
bool resize(Variation& run) {
  constexpr double kFactor = static_cast<double>(kNumerator) / kDenominator;
  change_units(run, {kFactor, 1, kFactor});
  return true;
}
bool speed_up(Variation& run);
bool change_renderer_only(Variation& run);
bool soften_renderer(Variation& run);
bool soften_points(Variation& run);
bool start_later(Variation& run);

// The stream.
bool send_twice(Variation& run);
bool send_late(Variation& run);
bool double_rate(Variation& run);
bool double_rate_at_rest(Variation& run);

}  // namespace remote_touch::vary
