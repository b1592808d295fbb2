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
bool mirror_x(Variation& run);
bool mirror_y(Variation& run);
bool mirror_z(Variation& run);
bool move(Variation& run);
bool enlarge(Variation& run);  // factor 2
bool shrink(Variation& run);   // factor 1/4
bool halve(Variation& run);
bool enlarge_unevenly(Variation& run);  // factor 3
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
